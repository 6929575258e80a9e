#include <gtest/gtest.h>

#include <random>

#include "firmware/half_space/host/host_program.h"
#include "tests/firmware/half_space/program_on_machine.h"
#include "tests/firmware/half_space/random_hulls.h"

namespace dendro::half_space {
namespace {

using namespace testing_scenes;

constexpr unsigned kSeed = 11;

ProgramImage microcode(const std::string& pack) {
  return testing_programs::assembled("firmware/half_space/rds3000/half_space.gia", pack);
}

/// The image memory after the microcode has run, word by word against the integer model.
void expect_exact(const Prepared& prepared, const ProgramImage& image, const std::string& what) {
  MachineOptions options;
  options.tick_limit = 2'000'000'000;
  rds3000::FunctionEngine machine(rds3000::Spec{}, options);
  run(machine, prepared, image);
  const FixedPointPicture wanted = run_fixed_point(prepared.program);
  const PlaneProgram& program = prepared.program;
  for (int y = 0; y < program.height; ++y)
    for (int x = 0; x < program.width; ++x) {
      const std::uint32_t address = static_cast<std::uint32_t>(x) << 1 | static_cast<std::uint32_t>(y) << 11;
      ASSERT_EQ(machine.read(address, bps32::kFnLores), wanted.pixels[static_cast<std::size_t>(y) * program.width + x])
          << what << " at " << x << "," << y;
    }
}

scene::Scene random_hull(std::mt19937& random, int side) {
  scene::Scene scene = empty_scene(side);
  scene.objects = {random_object(random, {0.5, 1.2, 12, 200})};
  return scene;
}

TEST(Microcode, EveryPixelWordOfFigure4IsThatOfTheIntegerModelStraightAndPacked) {
  for (const char* pack : {"none", "full"})
    expect_exact(prepare(with(icosahedron(), "starting_box", std::string("full"))), microcode(pack), pack);
}

TEST(Microcode, EveryPixelWordOfATreesHullIsThatOfTheIntegerModel) {
  expect_exact(prepare(pine(48)), microcode("full"), "pine");
}

TEST(Microcode, BoxingChangesNoPixel) {
  const Prepared free = prepare(with(pine(32, 200), "boxing", false));
  const Prepared boxed = prepare(pine(32, 200));
  ASSERT_TRUE(boxed.program.boxing);
  ASSERT_FALSE(free.program.boxing);
  expect_exact(free, microcode("none"), "not boxed");
  expect_exact(boxed, microcode("none"), "boxed");
}

TEST(Microcode, RandomHullsWithSteepAndEdgeOnPlanesAreExactAtEveryRegisterWidth) {
  std::mt19937 random(kSeed);
  const ProgramImage straight = microcode("none"), packed = microcode("full");
  std::size_t wide = 0, edge_on = 0;
  for (int i = 0; i < 40; ++i) {
    const auto bits = static_cast<std::int64_t>(6 + random() % 7);
    scene::Scene scene = with(random_hull(random, 40 + static_cast<int>(random() % 60)), "depth_bits", bits);
    if (i % 4 == 0) scene = with(scene, "starting_box", std::string("full"));
    const Prepared prepared = prepare(scene);
    wide += prepared.program.wide_records();
    edge_on += prepared.program.edge_on.size();
    const std::string what = "seed " + std::to_string(kSeed) + " hull " + std::to_string(i);
    expect_exact(prepared, i % 2 ? straight : packed, what);
  }
  EXPECT_GT(wide, 10u) << "the cases should include steep planes";
  EXPECT_GT(edge_on, 100u);
}

TEST(Microcode, AWrappingAccumulatorIsSeenToFailOnASteepPlane) {
  std::mt19937 random(kSeed);
  int different = 0;
  for (int i = 0; i < 10; ++i) {
    const scene::Scene scene = random_hull(random, 90);
    const FixedPointPicture wide = run_fixed_point(prepare(scene).program);
    const Prepared wrapping = prepare(with(scene, "steep", std::string("wrap")));
    expect_exact(wrapping, microcode("full"), "wrap");
    different += run_fixed_point(wrapping.program).pixels != wide.pixels;
  }
  EXPECT_GT(different, 0);
}

}  // namespace
}  // namespace dendro::half_space
