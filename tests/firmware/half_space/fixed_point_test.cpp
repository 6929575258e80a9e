#include "firmware/half_space/reference/fixed_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/firmware/half_space/scenes.h"

namespace dendro::half_space {
namespace {

using namespace testing_scenes;

constexpr unsigned kSeed = 4;

/// An icosahedron in a random position, seen at 12 bits unless `bits` says otherwise.
scene::Scene turned_icosahedron(std::mt19937& random, int side = 512) {
  std::uniform_real_distribution<double> angle(0, 360);
  scene::Scene scene = icosahedron(side);
  scene.objects[0].rotate = {angle(random), angle(random), angle(random)};
  return scene;
}

TEST(FixedPoint, HasNoWrongPixelAwayFromEdgesAndDepthWithinOneUnit) {
  std::mt19937 random(kSeed);
  std::vector<scene::Scene> scenes{icosahedron(), pine(32),
                                   with(pine(32), "starting_box", std::string("full")), pine(48)};
  for (int i = 0; i < 5; ++i) scenes.push_back(turned_icosahedron(random));
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const ErrorReport report = error_of(prepare(scenes[i]));
    EXPECT_EQ(extra(report, "wrong_pixels_far"), 0) << "seed " << kSeed << " scene " << i;
    EXPECT_LE(report.max_depth_error, 0.5 + 1024.0 / 131072) << "half a unit and the drift of N-A2";
    EXPECT_GT(report.covered_pixels, 60000);
    EXPECT_LT(report.wrong_pixels, report.covered_pixels / 100);
  }
}

TEST(FixedPoint, TheOrderOfPlanesInsideAPassDoesNotMatterToTheDepths) {
  PlaneProgram program = prepare(pine(48, 256)).program;
  const FixedPointPicture picture = run_fixed_point(program);
  std::mt19937 random(kSeed);
  for (int round = 0; round < 5; ++round) {
    for (auto* records : {&program.back, &program.edge_on, &program.front})
      std::shuffle(records->begin(), records->end(), random);
    const FixedPointPicture shuffled = run_fixed_point(program);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
      ASSERT_EQ(shuffled.pixels[i] & kFieldMask, picture.pixels[i] & kFieldMask)
          << "seed " << kSeed << " pixel " << i;
      ASSERT_EQ(shuffled.pixels[i] == kBackgroundWord, picture.pixels[i] == kBackgroundWord);
    }
  }
}

TEST(FixedPoint, CoincidentDuplicatesOfPlanesChangeNothing) {
  PlaneProgram program = prepare(icosahedron(256)).program;
  const FixedPointPicture once = run_fixed_point(program);
  for (auto* records : {&program.back, &program.edge_on, &program.front}) {
    const std::vector<PlaneRecord> copy = *records;
    records->insert(records->end(), copy.begin(), copy.end());
  }
  EXPECT_EQ(run_fixed_point(program).pixels, once.pixels);
}

TEST(FixedPoint, AMirroredHullGivesTheMirroredPicture) {
  scene::Scene scene = pine(32);
  scene = with(scene, "starting_box", std::string("full"));
  const Prepared prepared = prepare(scene);
  const FixedPointPicture picture = run_fixed_point(prepared.program);
  PlaneProgram mirrored = prepared.program;
  for (auto* records : {&mirrored.back, &mirrored.edge_on, &mirrored.front})
    for (PlaneRecord& record : *records) record.start += 511 * record.step_x, record.step_x = -record.step_x;
  const FixedPointPicture other = run_fixed_point(mirrored);
  for (int y = 0; y < 512; ++y)
    for (int x = 0; x < 512; ++x)
      ASSERT_EQ(picture.pixels[512 * y + x], other.pixels[512 * y + 511 - x]) << x << "," << y;
}

TEST(FixedPoint, AForegroundPixelNamesTheLowestFrontPlaneAtItsDepth) {
  const PlaneProgram program = prepare(icosahedron(256)).program;
  const FixedPointPicture picture = run_fixed_point(program);
  int covered = 0;
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x) {
      const std::uint32_t word = picture.pixels[256 * y + x];
      const bool inside =
          x >= program.box.x0 && x <= program.box.x1 && y >= program.box.y0 && y <= program.box.y1;
      if (!inside || word == kBackgroundWord) continue;
      ++covered;
      int lowest = 0;
      for (const PlaneRecord& plane : program.front) {
        const std::int64_t z =
            plane.start + (x - program.box.x0) * plane.step_x + (y - program.box.y0) * plane.step_y;
        if (lowest == 0 && (z >> 16) == (word & kFieldMask)) lowest = plane.face;
      }
      ASSERT_EQ(word >> kFaceLow, static_cast<std::uint32_t>(lowest)) << x << "," << y;
      ASSERT_GT(lowest, 0);
    }
  EXPECT_GT(covered, 20000);
}

TEST(FixedPoint, AFrontPlaneBeforeTheScreenDoesNotColourTheBackground) {
  // Front depth clamps to 0 on the left half, where an edge-on plane empties everything.
  PlaneProgram program;
  program.width = program.height = 16;
  program.box = {0, 0, 15, 15};
  program.back = {{PlaneKind::kBack, false, 0, 500 << 16, 0, 0}};
  program.edge_on = {{PlaneKind::kEdgeOn, false, 0, 8 << 16, -(1 << 16), 0}};
  program.front = {{PlaneKind::kFront, false, 1, -(10 << 16), 0, 0},
                   {PlaneKind::kFront, false, 2, 4095 << 16, -(1 << 28), 0}};
  program.front.pop_back();
  const FixedPointPicture picture = run_fixed_point(program);
  for (int x = 0; x < 16; ++x) EXPECT_EQ(picture.pixels[x], x < 8 ? kBackgroundWord : 1u << kFaceLow) << x;
}

TEST(FixedPoint, PixelsOutsideTheFirstBoxAreNotTouched) {
  PlaneProgram program = prepare(icosahedron(128)).program;
  const FixedPointPicture picture = run_fixed_point(program, 0xABCDEF);
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x) {
      const bool inside =
          x >= program.box.x0 && x <= program.box.x1 && y >= program.box.y0 && y <= program.box.y1;
      ASSERT_EQ(picture.pixels[128 * y + x] == 0xABCDEF, !inside) << x << "," << y;
    }
}

TEST(FixedPoint, LostPixelsHalveWithEveryBitOfDepth) {  // N-A4
  std::vector<double> lost;
  for (const int bits : {6, 8, 10, 12}) {
    std::mt19937 random(kSeed);
    double missing = 0, covered = 0;
    for (int round = 0; round < 24; ++round) {
      const Prepared prepared = prepare(with(turned_icosahedron(random), "depth_bits", std::int64_t{bits}));
      const ReferencePicture reference = reference_of(prepared);
      const SimulatedPicture fixed = as_simulated(run_fixed_point(prepared.program));
      for (std::size_t i = 0; i < reference.face.size(); ++i) {
        covered += reference.face[i] != 0;
        missing += reference.face[i] != 0 && fixed.face[i] == 0;
      }
    }
    lost.push_back(missing / covered);
  }
  for (std::size_t i = 1; i < lost.size(); ++i) {
    EXPECT_GT(lost[i - 1] / lost[i], 3.0) << i;
    EXPECT_LT(lost[i - 1] / lost[i], 5.0) << i;
  }
}

}  // namespace
}  // namespace dendro::half_space
