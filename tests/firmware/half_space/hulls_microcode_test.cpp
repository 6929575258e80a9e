#include <gtest/gtest.h>

#include <random>

#include "firmware/half_space/host/hulls_layout.h"
#include "firmware/half_space/host/hulls_program.h"
#include "firmware/half_space/reference/hulls_fixed_point.h"
#include "firmware/half_space/reference/hulls_reference.h"
#include "tests/firmware/half_space/program_on_machine.h"
#include "tests/firmware/half_space/random_hulls.h"

namespace dendro::half_space {
namespace {

using namespace testing_scenes;

constexpr unsigned kSeed = 5;

lib::ProgramImage microcode(const std::string& pack) {
  return testing_programs::assembled("firmware/half_space/rds3000/hulls.gia", pack);
}

std::vector<std::uint32_t> pixels_of(const PreparedHulls& prepared, const lib::ProgramImage& image) {
  MachineOptions options;
  options.tick_limit = 2'000'000'000;
  rds3000::FunctionEngine machine(rds3000::Spec{}, options);
  run(machine, prepared, image);
  std::vector<std::uint32_t> pixels;
  for (std::uint32_t y = 0; y < static_cast<std::uint32_t>(prepared.height); ++y)
    for (std::uint32_t x = 0; x < static_cast<std::uint32_t>(prepared.width); ++x)
      pixels.push_back(machine.read(x << 1 | y << 11, bps32::kFnLores));
  return pixels;
}

/// The image memory after the microcode has run, word by word against the integer model.
void expect_exact(const PreparedHulls& prepared, const lib::ProgramImage& image, const std::string& what) {
  const std::vector<std::uint32_t> pixels = pixels_of(prepared, image);
  const FixedPointPicture wanted = run_hulls_fixed_point(prepared);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    ASSERT_EQ(pixels[i], wanted.pixels[i])
        << what << " at " << i % prepared.width << "," << i / prepared.width << std::hex << " " << pixels[i];
}

TEST(HullsMicrocode, EveryPixelWordOfRandomIntersectingHullsIsThatOfTheIntegerModelStraightAndPacked) {
  std::mt19937 random(kSeed);
  const lib::ProgramImage straight = microcode("none"), packed = microcode("full");
  std::size_t wide = 0, edge_on = 0, seen = 0;
  for (int i = 0; i < 30; ++i) {
    scene::Scene scene = with(random_hulls(random, 40 + static_cast<int>(random() % 60), 2 + i % 4),
                              "depth_bits", static_cast<std::int64_t>(6 + random() % 3));
    if (i % 5 == 0) scene = with(scene, "starting_box", std::string("full"));
    if (i % 3 == 0) scene = with(scene, "boxing", false);
    const PreparedHulls prepared = prepare_hulls(scene);
    for (const Hull& hull : prepared.hulls)
      wide += hull.program.wide_records(), edge_on += hull.program.edge_on.size();
    const std::string what = "seed " + std::to_string(kSeed) + " scene " + std::to_string(i);
    expect_exact(prepared, straight, what + " none");
    expect_exact(prepared, packed, what + " full");
    for (const std::uint32_t word : run_hulls_fixed_point(prepared).pixels)
      seen += (word >> kNearestLow) < static_cast<std::uint32_t>(prepared.maxdepth);
  }
  EXPECT_GT(wide, 10u) << "the cases should include steep planes";
  EXPECT_GT(edge_on, 100u);
  EXPECT_GT(seen, 20'000u);
}

TEST(HullsMicrocode, UnboundedTreesAreExactAndLeaveTheNearestAlone) {
  scene::Scene scene = grove(3, 96);
  scene.objects[0].tree_parameters["start"] = open_start();
  scene.objects[0].tree_parameters.erase("radius");
  const PreparedHulls prepared = prepare_hulls(scene);
  EXPECT_FALSE(prepared.hulls[0].bounded);
  expect_exact(prepared, microcode("none"), "two start normals");
}

TEST(HullsMicrocode, BoxingAndTheOrderOfHullsChangeNoNearestDepth) {
  std::mt19937 random(kSeed + 1);
  const lib::ProgramImage image = microcode("none");
  for (int i = 0; i < 4; ++i) {
    const scene::Scene scene = random_hulls(random, 70, 4);
    scene::Scene turned = with(scene, "boxing", false);
    std::reverse(turned.objects.begin(), turned.objects.end());
    const std::vector<std::uint32_t> a = pixels_of(prepare_hulls(scene), image),
                                     b = pixels_of(prepare_hulls(turned), image);
    for (std::size_t p = 0; p < a.size(); ++p) ASSERT_EQ(a[p] >> kNearestLow, b[p] >> kNearestLow) << p;
  }
}

TEST(HullsMicrocode, TheMergeIsTheMinimumOfTheHullsDrawnAlone) {
  std::mt19937 random(kSeed + 2);
  const lib::ProgramImage image = microcode("full");
  // One depth range for all, so that a hull alone has the depths that it has among the others.
  const scene::Scene scene =
      with(random_hulls(random, 80, 3), "depth_range", scene::OptionValue::Array{{3.0, {}}, {7.0, {}}});
  const std::vector<std::uint32_t> together = pixels_of(prepare_hulls(scene), image);
  std::vector<std::uint32_t> least(together.size(), 255);
  int nearer = 0;
  for (const scene::Object& object : scene.objects) {
    scene::Scene alone = scene;
    alone.objects = {object};
    const std::vector<std::uint32_t> pixels = pixels_of(prepare_hulls(alone), image);
    for (std::size_t p = 0; p < pixels.size(); ++p) {
      nearer += least[p] < 255 && pixels[p] >> kNearestLow < least[p];
      least[p] = std::min(least[p], pixels[p] >> kNearestLow);
    }
  }
  EXPECT_GT(nearer, 100) << "the hulls should overlap, later ones in front of earlier ones";
  for (std::size_t p = 0; p < together.size(); ++p) ASSERT_EQ(together[p] >> kNearestLow, least[p]) << p;
}

}  // namespace
}  // namespace dendro::half_space
