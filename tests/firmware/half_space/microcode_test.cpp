#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>

#include "firmware/half_space/host/host_program.h"
#include "firmware/tools/assembler.h"
#include "models/machines/rds3000/function.h"
#include "models/parts/bps32/bps32_isa.h"
#include "tests/firmware/half_space/scenes.h"

namespace dendro::half_space {
namespace {

using namespace testing_scenes;

constexpr unsigned kSeed = 11;

ProgramImage microcode(const std::string& pack) {
  std::ifstream in(MICROCODE);
  const std::string source{std::istreambuf_iterator<char>(in), {}};
  tools::AssembleOptions options;
  options.pack = pack;
  const tools::Ucode ucode = tools::assemble(source, MICROCODE, options).ucode;
  ProgramImage image;
  image.words = ucode.words;
  image.entry = ucode.entry;
  for (const auto& [name, area] : ucode.scratch) image.scratch[name] = {area.address, area.size};
  image.initial_scratch = ucode.scratch_data;
  return image;
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

/// A random closed hull around the origin: an axis box, some of its planes edge-on, cut by random planes.
scene::Scene random_hull(std::mt19937& random, int side) {
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> offset(0.5, 1.2);
  scene::Scene scene = empty_scene(side);
  scene::Object object;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) {
      scene::PlaneEntry plane;
      plane.normal = {0, 0, 0};
      plane.normal[axis] = sign;
      plane.offset = offset(random);
      object.planes.push_back(plane);
    }
  const int more = static_cast<int>(random() % 12);
  for (int i = 0; i < more; ++i) {
    scene::PlaneEntry plane;
    // Every third one nearly edge-on, so that it is steep.
    plane.normal = {gauss(random), gauss(random), i % 3 == 0 ? gauss(random) / 200 : gauss(random)};
    const double length = std::sqrt(plane.normal[0] * plane.normal[0] + plane.normal[1] * plane.normal[1] +
                                    plane.normal[2] * plane.normal[2]);
    plane.offset = offset(random) * length;
    object.planes.push_back(plane);
  }
  object.source_where = {"test.toml", 10};
  scene.objects = {object};
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
