#include "firmware/half_space/host/prepare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <set>

#include "sim/base/error.h"
#include "tests/firmware/half_space/scenes.h"

namespace dendro::half_space {
namespace {

using namespace testing_scenes;
using scene::OptionValue;

std::string refusal(const scene::Scene& scene) {
  try {
    prepare(scene);
  } catch (const UserError& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    return text;
  }
  ADD_FAILURE() << "accepted";
  return {};
}

#define EXPECT_REFUSED(scene, part) EXPECT_NE(refusal(scene).find(part), std::string::npos) << refusal(scene)

scene::Scene planes_scene(std::vector<scene::PlaneEntry> planes) {
  scene::Scene scene = icosahedron();
  scene.objects[0].solid.clear();
  scene.objects[0].planes = std::move(planes);
  return scene;
}

const std::vector<scene::PlaneEntry> kCube{{{1, 0, 0}, 1},  {{-1, 0, 0}, 1}, {{0, 1, 0}, 1},
                                           {{0, -1, 0}, 1}, {{0, 0, 1}, 1},  {{0, 0, -1}, 1}};

TEST(Prepare, TheIcosahedronOnATwoFoldAxisHasSixteenScannedAndFourEdgeOnPlanes) {
  const Prepared prepared = prepare(icosahedron());
  EXPECT_EQ(prepared.program.back.size(), 8u);
  EXPECT_EQ(prepared.program.front.size(), 8u);
  EXPECT_EQ(prepared.program.edge_on.size(), 4u);
  EXPECT_EQ(prepared.program.wide_records(), 0u);
}

TEST(Prepare, FrontFacesAreNumberedFromOneInOrder) {
  const Prepared prepared = prepare(pine(32));
  int next = 1;
  for (const PlaneRecord& record : prepared.program.front) EXPECT_EQ(record.face, next++);
  EXPECT_EQ(prepared.program.shades.size(), prepared.program.front.size() + 1);
}

TEST(Prepare, RecordsGoBackEdgeOnFront) {
  const PlaneProgram program = prepare(icosahedron()).program;
  const std::vector<std::uint32_t> words = program.record_words();
  ASSERT_EQ(words.size(), 80u);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(words[4 * i + 3] & 3u, i < 8 ? 1u : i < 12 ? 2u : 0u) << i;
}

TEST(Prepare, DepthOfTheSceneAndItsMarginFillTheRegister) {
  for (const int bits : {6, 8, 12}) {
    const Prepared prepared = prepare(with(icosahedron(), "depth_bits", std::int64_t{bits}));
    const int maxdepth = (1 << bits) - 1;
    EXPECT_EQ(prepared.program.maxdepth, maxdepth);
    double nearest = INFINITY;
    const ReferencePicture picture = reference_of(prepared);
    for (std::size_t i = 0; i < picture.face.size(); ++i)
      if (picture.face[i] != 0) nearest = std::min(nearest, picture.depth[i]);
    // The nearest edge is 5 % of the depth extent from the register's start: 0.05 / 1.1 of the register.
    EXPECT_NEAR(nearest, maxdepth * 0.05 / 1.1, maxdepth * 0.002);
  }
}

TEST(Prepare, TheFirstBoxHoldsEveryCoveredPixelAndFullIsTheScreen) {
  const Prepared around = prepare(pine(32));
  const Prepared full = prepare(with(pine(32), "starting_box", std::string("full")));
  EXPECT_EQ(full.program.box.width(), 512);
  EXPECT_EQ(full.program.box.height(), 512);
  const Box& box = around.program.box;
  EXPECT_LT(box.width() * box.height(), 512 * 512 * 6 / 10);
  const ReferencePicture picture = reference_of(around);
  const FixedPointPicture fixed = run_fixed_point(full.program);
  for (int y = 0; y < 512; ++y)
    for (int x = 0; x < 512; ++x) {
      const bool covered =
          picture.face[picture.at(x, y)] != 0 || fixed.pixels[picture.at(x, y)] != kBackgroundWord;
      const bool in_box = x >= box.x0 && x <= box.x1 && y >= box.y0 && y <= box.y1;
      ASSERT_TRUE(!covered || in_box) << x << "," << y;
    }
}

TEST(Prepare, ABoxIsClippedToTheScreen) {
  scene::Scene scene = icosahedron(64);
  scene.camera.height = 0.5;
  const Box box = prepare(scene).program.box;
  EXPECT_EQ(box.x0, 0);
  EXPECT_EQ(box.y0, 0);
  EXPECT_EQ(box.x1, 63);
  EXPECT_EQ(box.y1, 63);
}

TEST(Prepare, ScalingTheWorldByAPowerOfTwoChangesNothing) {
  scene::Scene scaled = icosahedron();
  scaled.objects[0].rotate = {10, 20, 30};
  const std::vector<std::uint32_t> words = prepare(scaled).program.record_words();
  scaled.objects[0].scale = 4;
  scaled.camera.height *= 4;
  for (double& p : scaled.camera.position) p *= 4;
  EXPECT_EQ(prepare(scaled).program.record_words(), words);
}

TEST(Prepare, ShadesFollowTheNormalTheLightAndTheColour) {
  scene::Scene scene = planes_scene(kCube);
  scene::Light light;
  light.direction = {0, 0, -3};  // straight from the viewer
  light.ambient = 0.25;
  scene.lights = {light};
  scene = with(scene, "colour", OptionValue::Array{{1.0, {}}, {0.5, {}}, {std::int64_t{0}, {}}});
  scene = with(scene, "background", OptionValue::Array{{0.0, {}}, {0.0, {}}, {0.2, {}}});
  EXPECT_EQ(prepare(scene).program.shades, (std::vector<Rgb>{{0, 0, 51}, {255, 128, 0}}));
  scene.lights[0].direction = {0, 0, 1};  // from behind
  EXPECT_EQ(prepare(scene).program.shades[1], (Rgb{64, 32, 0}));
}

TEST(Prepare, WithoutALightItComesFromTheUpperLeftAtTheViewersSide) {
  scene::Scene scene = planes_scene(kCube);
  EXPECT_EQ(prepare(scene).program.shades[1], (Rgb{195, 195, 195})) << "0.3 + 0.7 · 2/3";
}

TEST(Prepare, EveryPlaneAddsToTheHostsArithmetic) {
  const std::uint64_t few = prepare(pine(16)).setup_flops, many = prepare(pine(32)).setup_flops;
  EXPECT_GT(few, 16 * 40u);
  EXPECT_GT(many, few + 16 * 40u);
}

TEST(Prepare, ImagesTheFrameBufferCannotHoldAreRefused) {
  EXPECT_REFUSED(icosahedron(513), "test.toml:3: image.width: 513 is outside the allowed 1..512");
  EXPECT_REFUSED(icosahedron(0), "image.width");
}

TEST(Prepare, NeedsExactlyOneObjectAndAtMostOneLight) {
  scene::Scene scene = empty_scene();
  EXPECT_REFUSED(scene, "exactly one object, not 0");
  scene = icosahedron();
  scene.objects.push_back(scene.objects[0]);
  EXPECT_REFUSED(scene, "exactly one object, not 2");
  scene = icosahedron();
  scene.lights.resize(2);
  EXPECT_REFUSED(scene, "at most one light");
}

TEST(Prepare, UnboundedPlanesAreAnErrorUnlessTheyMayBeBackground) {
  scene::Scene scene = planes_scene({kCube.begin(), kCube.begin() + 5});
  EXPECT_REFUSED(scene, "test.toml:10: object.planes: the intersection of the 5 planes is unbounded");
  scene = with(scene, "unbounded", std::string("background"));
  EXPECT_REFUSED(scene, "half_space.depth_range: is needed");
  scene = with(scene, "depth_range", OptionValue::Array{{std::int64_t{3}, {}}, {std::int64_t{8}, {}}});
  const Prepared prepared = prepare(scene);
  EXPECT_EQ(prepared.program.box.width(), 512);
  const FixedPointPicture picture = run_fixed_point(prepared.program);
  for (const std::uint32_t word : picture.pixels)
    ASSERT_EQ(word, kBackgroundWord) << "no back plane anywhere";
}

TEST(Prepare, PlanesWithoutCommonInteriorAreRefused) {
  std::vector<scene::PlaneEntry> planes = kCube;
  planes[0].offset = -2;
  EXPECT_REFUSED(planes_scene(planes), "no point lies inside all 6 planes");
}

TEST(Prepare, ImpossiblePlaneListsAreRefused) {
  EXPECT_REFUSED(planes_scene({}), "no planes");
  std::vector<scene::PlaneEntry> planes = kCube;
  planes[2].normal = {0, 0, 0};
  EXPECT_REFUSED(planes_scene(planes), "plane 3");
  planes[2].normal = {0, NAN, 0};
  EXPECT_REFUSED(planes_scene(planes), "plane 3");
  planes.assign(2049, kCube[0]);
  EXPECT_REFUSED(planes_scene(planes), "2049 planes are more than the scratchpad's 2048");
}

TEST(Prepare, ImpossiblePlaneCountsOfAMeshAreRefused) {
  EXPECT_REFUSED(pine(0), "test.toml:21: half_space.planes: 0 is outside the allowed 4..2048");
  EXPECT_REFUSED(pine(3), "half_space.planes");
  EXPECT_REFUSED(pine(2049), "half_space.planes");
  EXPECT_REFUSED(pine(500), "the hull has only 83 facets");
}

TEST(Prepare, MoreThan255FrontFacesAreRefused) {
  const scene::Scene scene = with(pine(600), "plane_source", std::string("support"));
  EXPECT_REFUSED(scene, "front faces are more than the 255");
}

TEST(Prepare, GivenDirectionsMakeSupportPlanes) {
  OptionValue::Array rows;
  for (const scene::PlaneEntry& entry : kCube) {
    OptionValue row{OptionValue::Array(3), {}};
    for (int i = 0; i < 3; ++i) std::get<OptionValue::Array>(row.value)[i].value = entry.normal[i];
    rows.push_back(row);
  }
  scene::Scene scene = with(pine(6), "directions", rows);
  EXPECT_REFUSED(scene, "goes with plane_source = \"support\" only");
  scene = with(scene, "plane_source", std::string("support"));
  EXPECT_EQ(prepare(scene).world.size(), 6u);
  EXPECT_REFUSED(with(scene, "planes", std::int64_t{7}), "7 planes are wanted but 6 directions are given");
  rows.pop_back();
  scene = with(with(scene, "directions", rows), "planes", std::int64_t{5});
  EXPECT_REFUSED(scene, "unbounded");
}

TEST(Prepare, WhatTheAlgorithmDoesNotDoIsRefused) {
  scene::Scene scene = icosahedron();
  scene.camera.projection = scene::Camera::Projection::kPerspective;
  EXPECT_REFUSED(scene, "camera.projection");
  scene = icosahedron();
  scene.objects[0].solid.clear();
  scene.objects[0].tree = "pine";
  EXPECT_REFUSED(scene, "object.tree");
  scene = icosahedron();
  scene.objects[0].solid = "sphere";
  EXPECT_REFUSED(scene, "must be one of tetrahedron, cube");
  scene = icosahedron();
  scene.objects[0].at = {10, 0, 0};
  EXPECT_REFUSED(scene, "outside the picture");
}

TEST(Prepare, WrongOptionsAreRefused) {
  EXPECT_REFUSED(with(icosahedron(), "planes", std::int64_t{20}), "goes with an object that is a mesh only");
  EXPECT_REFUSED(with(icosahedron(), "depth_bits", std::int64_t{13}), "6..12");
  EXPECT_REFUSED(with(icosahedron(), "steep", std::string("guess")), "wide, saturate, wrap");
  EXPECT_REFUSED(with(icosahedron(), "stepe", std::string("wide")), "did you mean steep?");
}

TEST(Prepare, AMeshWithoutAPlaneCountIsMergedSoThatTheReferenceHasNoWrongPixelFarFromAnEdge) {
  scene::Scene scene = pine(32);
  scene.options = scene::Options("half_space", {"test.toml", 20});
  const Prepared prepared = prepare(scene);
  EXPECT_EQ(prepared.screen.size(), 32u);
  EXPECT_EQ(extra(error_of(prepared), "wrong_pixels_far"), 0);
}

}  // namespace
}  // namespace dendro::half_space
