#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "firmware/half_space/host/hulls_layout.h"
#include "firmware/half_space/job.h"
#include "firmware/half_space/reference/hulls_fixed_point.h"
#include "firmware/half_space/reference/texture_model.h"
#include "firmware/half_space/reference/tree_reference.h"
#include "sim/base/error.h"
#include "tests/firmware/half_space/tree_scenes.h"

namespace dendro::half_space {
namespace {

using namespace testing_scenes;

constexpr unsigned kSeed = 57;

std::string refusal(const scene::Scene& scene, unsigned pixel_bits = 24) {
  try {
    is_complete_tree(scene);
    prepare_tree(scene, pixel_bits);
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

#define EXPECT_REFUSED(scene, text) EXPECT_NE(refusal(scene).find(text), std::string::npos) << refusal(scene)

scene::Scene one_tree(const std::string& trunk = "cylinder") {
  std::mt19937 random(kSeed);
  return random_tree(random, trunk, 80, 0);
}

TEST(TreeReference, TheIntegerModelIsInsideTheEnclosureWithRoughnessAndTrunks) {
  std::mt19937 random(kSeed);
  const char* const kTrunks[] = {"cylinder", "painter", "cone"};
  std::int64_t trunk = 0, covered = 0;
  for (int i = 0; i < 30; ++i) {
    scene::Scene scene = random_tree(random, kTrunks[i % 3], 90, i % 4);
    if (i % 2 == 0) scene = with(scene, "roughness", 0.02 * i);
    const PreparedTree tree = prepare_tree(scene, 24);
    const HullsReference reference = render_tree_reference(tree, {});
    const std::vector<std::uint8_t> nearest = nearest_of(run_tree_fixed_point(tree));
    const ErrorReport report =
        compare(tree, reference, {}, nearest, shown(nearest, tree.hulls.shades).data());
    SCOPED_TRACE("seed " + std::to_string(kSeed) + " scene " + std::to_string(i));
    EXPECT_EQ(extra(report, "outside_enclosure"), 0);
    EXPECT_LE(report.max_depth_error, 0.52);
    EXPECT_LT(report.wrong_pixels, report.covered_pixels / 10 + 20);
    trunk += static_cast<std::int64_t>(extra(report, "trunk_pixels")), covered += report.covered_pixels;
  }
  EXPECT_GT(trunk, 1000);
  EXPECT_GT(covered, 40'000);
}

TEST(TreeReference, ATrunkThatIsMissingOrInFrontOfItsCrownIsSeen) {
  const PreparedTree tree = prepare_tree(one_tree(), 24);
  const HullsReference reference = render_tree_reference(tree, {});
  const std::vector<std::uint8_t> right = nearest_of(run_tree_fixed_point(tree));
  std::vector<std::uint8_t> missing = right, before = right;
  std::int64_t marks = 0;
  for (std::size_t i = 0; i < right.size(); ++i) {
    if (right[i] == kTrunkMark) missing[i] = 255, ++marks;
    if (reference.hull[i] == 0 && i % 7 == 0) before[i] = kTrunkMark;
  }
  ASSERT_GT(marks, 100);
  const auto outside = [&](const std::vector<std::uint8_t>& nearest) {
    return extra(compare(tree, reference, {}, nearest, shown(nearest, tree.hulls.shades).data()),
                 "outside_enclosure");
  };
  EXPECT_EQ(outside(right), 0);
  EXPECT_GT(outside(missing), 0.8 * static_cast<double>(marks));
  EXPECT_GT(outside(before), 100);
}

TEST(TreeReference, ATrunkIsHiddenBehindItsCrownAndSeenBelowIt) {
  const PreparedTree tree = prepare_tree(one_tree("cone"), 24);
  ASSERT_EQ(tree.hulls.trunks.size(), 1u);
  const FixedPointPicture with = run_tree_fixed_point(tree);
  PreparedTree bare = tree;
  bare.hulls.trunks.clear();
  const FixedPointPicture without = run_tree_fixed_point(bare);
  int below = 0, instead = 0;
  for (std::size_t i = 0; i < with.pixels.size(); ++i) {
    const std::uint32_t a = with.pixels[i] >> kNearestLow, b = without.pixels[i] >> kNearestLow;
    if (a == b) continue;
    ++(b == 255 ? below : instead);
    EXPECT_EQ(a, kTrunkMark);
  }
  EXPECT_GT(below, 60);
  EXPECT_EQ(instead, 0) << "its top lies inside the crown";
}

TEST(TreeReference, TexturesFollowTheRealPointAndTheColourIsTheCubeS) {
  const PreparedTree tree = prepare_tree(with(one_tree(), "texture", std::string("fbm")), 24);
  const CubeBytes cube = make_texture(tree.texture);
  const HullsReference reference = render_tree_reference(tree, cube);
  int crown = 0, bark = 0;
  for (int y = 0; y < reference.height; ++y)
    for (int x = 0; x < reference.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * reference.width + x;
      const Rgb got = {reference.rgb[3 * i], reference.rgb[3 * i + 1], reference.rgb[3 * i + 2]};
      if (reference.hull[i] == HullsReference::kTrunkHull) {
        EXPECT_EQ(got, (Rgb{80, 40, 15}));
        ++bark;
      } else if (reference.hull[i] >= 0) {
        // Straight back into the world, without the map that the microcode is given.
        const double metres = (reference.depth[i] - tree.hulls.depth.shift) / tree.hulls.depth.scale;
        const glm::dvec3 world =
            glm::inverse(tree.hulls.view.linear) * (glm::dvec3(x, y, metres) - tree.hulls.view.shift);
        const glm::dvec3 texel =
            world * std::ldexp(tree.colour.texels_per_metre, -static_cast<int>(tree.colour.level));
        const auto side = 1 << tree.colouring.level.bits;
        const auto wrap = [&](double v) { return ((static_cast<int>(std::floor(v)) % side) + side) % side; };
        const std::size_t at =
            static_cast<std::size_t>((wrap(texel.z) * side + wrap(texel.y)) * side + wrap(texel.x));
        const auto& level = cube[tree.colour.level];
        crown += got == Rgb{level[4 * at], level[4 * at + 1], level[4 * at + 2]};
      }
    }
  EXPECT_GT(bark, 50);
  int covered = 0;
  for (const int hull : reference.hull) covered += hull >= 0;
  EXPECT_GE(crown, covered - 2) << "but for a point that lies on a texel's border";
}

TEST(PrepareTree, TheCubeTakesTheFourthByteOnlyWhereAPixelWordHasOne) {
  const scene::Scene scene = with(one_tree(), "texture", std::string("fbm"));
  EXPECT_FALSE(prepare_tree(scene, 24).layout.wide);
  EXPECT_TRUE(prepare_tree(scene, 32).layout.wide);
  EXPECT_FALSE(prepare_tree(scene, 48).layout.wide) << "two words of 24 bits";
  EXPECT_NE(refusal(with(scene, "layout", std::string("wide")), 48).find("half_space.layout"), std::string::npos);
}

TEST(PrepareTree, OnlyTextureRoughnessAndTrunksMakeACompleteTree) {
  EXPECT_FALSE(is_complete_tree(icosahedron()));
  EXPECT_FALSE(is_complete_tree(with(icosahedron(), "roughness", 0.0)));
  EXPECT_TRUE(is_complete_tree(with(icosahedron(), "roughness", 0.1)));
  EXPECT_TRUE(is_complete_tree(with(icosahedron(), "texture", std::string("fbm"))));
  EXPECT_TRUE(is_complete_tree(one_tree()));
}

TEST(PrepareTree, NoCrownComesAsNearAsTheMarkOfTrunksNotEvenAnOpenOne) {
  scene::Scene scene = grove(3, 96);
  scene.objects[0].tree_parameters["start"] = open_start();
  scene.objects[0].tree_parameters.erase("radius");
  scene = with(scene, "roughness", 0.3);
  const PreparedTree tree = prepare_tree(scene, 24);
  ASSERT_FALSE(tree.hulls.hulls[0].bounded);
  const FixedPointPicture picture = run_tree_fixed_point(tree);
  for (const std::uint32_t word : picture.pixels) ASSERT_NE(word >> kNearestLow, kTrunkMark);
  const std::vector<std::uint8_t> nearest = nearest_of(picture);
  const ErrorReport report =
      compare(tree, render_tree_reference(tree, {}), {}, nearest, shown(nearest, tree.hulls.shades).data());
  EXPECT_EQ(extra(report, "outside_enclosure"), 0);
  EXPECT_GT(extra(report, "unbounded_share"), 0.0) << "what is open shows background and is reported";
}

TEST(PrepareTree, TrunksAreOrderedFrontToBackAndEveryCopyHasOne) {
  scene::Scene scene = grove(12, 96);
  scene.objects[0] = with_trunk(scene.objects[0], {{"trunk", std::string("cylinder")}});
  const PreparedTree tree = prepare_tree(scene, 24);
  ASSERT_EQ(tree.hulls.trunks.size(), 12u);
  for (std::size_t i = 1; i < 12; ++i) EXPECT_LE(tree.hulls.trunks[i - 1].depth, tree.hulls.trunks[i].depth);
  for (const Trunk& trunk : tree.hulls.trunks) EXPECT_EQ(trunk.hull.screen.size(), 8u);
}

TEST(PrepareTree, FartherTrunksShrinkWithADistance) {
  scene::Scene scene = grove(12, 96);
  scene.objects[0] = with_trunk(scene.objects[0], {{"trunk", std::string("painter")}});
  const auto lines = [](const scene::Scene& s) {
    int sum = 0;
    for (const Trunk& trunk : prepare_tree(s, 24).hulls.trunks) sum += trunk.trapezium.box.height();
    return sum;
  };
  const int parallel = lines(scene), near = lines(with(scene, "trunk_distance", 2.0)),
            far = lines(with(scene, "trunk_distance", 50.0));
  EXPECT_LT(near, far);
  EXPECT_LT(far, parallel);
}

TEST(PrepareTree, AMeshsGroupsGiveCrownAndTrunk) {
  scene::Scene scene = empty_scene(200);
  scene::Object object;
  object.mesh = std::string(MESHES) + "/arbaro_quaking_aspen.obj.gz";
  object.source_where = {"test.toml", 10};
  object.groups = {{"crown", "leaves*"}, {"trunk", "trunk*"}};
  scene.objects = {with_trunk(object, {{"trunk", std::string("cone")}})};
  scene.camera.height = 16.5;
  scene.camera.position = {6, 12, 40};
  scene.camera.target = {0, 7.45, 0};
  scene = with(scene, "planes", std::int64_t{32});
  const PreparedTree tree = prepare_tree(scene, 24);
  ASSERT_EQ(tree.hulls.trunks.size(), 1u);
  EXPECT_EQ(tree.hulls.trunks[0].hull.screen.size(), 7u);
  const int crown_bottom = tree.hulls.hulls[0].program.box.y1,
            trunk_bottom = tree.hulls.trunks[0].hull.program.box.y1;
  EXPECT_GT(trunk_bottom, crown_bottom + 20) << "the leaves end above the ground";
  scene.objects[0].groups["crown"] = "needles*";
  EXPECT_REFUSED(scene, "no group is named like crown = \"needles*\"; there are");
  scene.objects[0].groups = {{"roots", "trunk*"}};
  EXPECT_REFUSED(scene, "\"roots\" is not known; must be crown or trunk");
}

TEST(PrepareTree, WhatACompleteTreeCannotHaveIsRefused) {
  const scene::OptionValue::Array range{{3.0, {}}, {8.0, {}}};
  EXPECT_REFUSED(with(one_tree(), "depth_bits", std::int64_t{7}),
                 "test.toml:22: half_space.depth_bits: a complete tree takes 8");
  EXPECT_REFUSED(with(one_tree(), "depth_range", range), "half_space.depth_range: goes without trunks");
  EXPECT_REFUSED(with(one_tree(), "registers", std::int64_t{2}),
                 "half_space.registers: texture, roughness and trunks");
  EXPECT_REFUSED(with(one_tree(), "depth_margin", 0.0), "half_space.depth_margin");
  EXPECT_REFUSED(with(with(icosahedron(64), "roughness", 0.1), "trunk_distance", 2.0),
                 "no object has a trunk");
  EXPECT_REFUSED(with(icosahedron(300), "texture", std::string("fbm")), "image.height: 300 lines do not fit");
  EXPECT_REFUSED(with(with(icosahedron(64), "texture", std::string("fbm")), "cube_bits", std::int64_t{6}),
                 "half_space.cube_bits");
  EXPECT_REFUSED(with(with(icosahedron(64), "texture", std::string("fbm")), "layout", std::string("wide")),
                 "half_space.layout");
  scene::Scene open = one_tree();
  open.objects[0].planes.resize(5);
  EXPECT_REFUSED(with(open, "unbounded", std::string("background")), "a trunk needs a crown that is bounded");
}

TEST(PrepareTree, SplittingThatLeavesNoPlaneIsRefused) {
  scene::Scene scene = with(tree(6, 64), "roughness", 0.1);
  auto& parameters = scene.objects[0].tree_parameters;
  const scene::OptionValue upwards{scene::OptionValue::Array{{0.01, {}}, {1.0, {}}, {0.01, {}}}, {}};
  parameters["start"] = {scene::OptionValue::Array{upwards}, {"test.toml", 11}};
  parameters["mu_b"] = {0.3, {"test.toml", 15}};
  parameters["keep_parent"] = {false, {"test.toml", 12}};
  parameters["mu_alpha"] = {75.0, {"test.toml", 13}};
  parameters["sigma_alpha"] = {20.0, {"test.toml", 14}};
  int refused = 0;
  for (scene.seed = 1; scene.seed <= 20; ++scene.seed)
    refused += refusal(scene).find("object.tree: splitting leaves no plane") != std::string::npos;
  EXPECT_GT(refused, 5);
}

}  // namespace
}  // namespace dendro::half_space
