#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "firmware/half_space/host/plane_program.h"

namespace dendro::half_space {
namespace {

constexpr Box kScreen{0, 0, 511, 511};

ScreenPlane plane(double a, double b, double c, double d, int face = 0) {
  return {a, b, c, d, c > 0 ? PlaneKind::kBack : c < 0 ? PlaneKind::kFront : PlaneKind::kEdgeOn, face};
}

PlaneRecord wide_record(const ScreenPlane& p, const Box& box = kScreen) {
  return make_record(p, box, SteepPolicy::kWide, 2047.5);
}

TEST(PlaneRecord, HoldsDepthAtTheFirstPixelOfTheBoxAndItsSteps) {
  // z = 100 + 2 x - 0.5 y
  const PlaneRecord record = wide_record(plane(2, -0.5, -1, 100, 3), {10, 20, 400, 300});
  EXPECT_EQ(record.kind, PlaneKind::kFront);
  EXPECT_FALSE(record.wide);
  EXPECT_EQ(record.start, (100 + 20 - 10) * 65536);
  EXPECT_EQ(record.step_x, 2 * 65536);
  EXPECT_EQ(record.step_y, -65536 / 2);
  EXPECT_EQ(record.words(), (std::vector<std::uint32_t>{110u << 16, 2u << 16, 0xFFFF8000u, 3u << 8}));
}

TEST(PlaneRecord, WordThreeSaysKindWidthAndFace) {
  EXPECT_EQ(wide_record(plane(0, 0, 1, -7)).words()[3], 1u);
  EXPECT_EQ(wide_record(plane(1, 0, 0, -7)).words()[3], 2u);
  EXPECT_EQ(wide_record(plane(0, 0, -1, 7, 255)).words()[3], 255u << 8);
}

TEST(PlaneRecord, RoundsToTheNearestFraction) {
  const double lsb = 1.0 / 65536;
  const PlaneRecord record = wide_record(plane(-10.6 * lsb, 10.4 * lsb, 1, 0.6 * lsb));
  EXPECT_EQ(record.step_x, 11);
  EXPECT_EQ(record.step_y, -10);
  EXPECT_EQ(record.start, -1);
}

TEST(PlaneRecord, ASteepPlaneIsWideAndItsEightWordsHoldAll64Bits) {
  const PlaneRecord record = wide_record(plane(-1000, 1, 1, 300000.25));
  ASSERT_TRUE(record.wide);
  EXPECT_EQ(record.start, static_cast<std::int64_t>(-300000.25 * 65536));
  EXPECT_EQ(record.step_x, 1000 * 65536);
  const std::vector<std::uint32_t> words = record.words();
  ASSERT_EQ(words.size(), 8u);
  const auto join = [&](int i) {
    return static_cast<std::int64_t>(std::uint64_t{words[i + 4]} << 32 | words[i]);
  };
  EXPECT_EQ(join(0), record.start);
  EXPECT_EQ(join(1), record.step_x);
  EXPECT_EQ(join(2), record.step_y);
  EXPECT_EQ(words[3], 1u | 4u) << "where a plain record has it, so that its reader knows the width in time";
}

TEST(PlaneRecord, IsSteepExactlyWhenADepthInTheBoxLeaves32767) {
  // z = x · s from 0 at x0: largest s · 511.
  EXPECT_FALSE(wide_record(plane(-32766.9 / 511, 0, 1, 0)).wide);
  EXPECT_TRUE(wide_record(plane(-32767.1 / 511, 0, 1, 0)).wide);
  EXPECT_TRUE(wide_record(plane(32767.1 / 511, 0, 1, 0)).wide);
  EXPECT_FALSE(wide_record(plane(-32767.1 / 511, 0, 1, 0), {0, 0, 255, 511}).wide) << "a smaller box";
  EXPECT_FALSE(wide_record(plane(-60, 60, 1, 0)).wide) << "60 · 511 in each direction, opposite corners";
  EXPECT_TRUE(wide_record(plane(-60, -60, 1, 0)).wide) << "60 · 1022 in the far corner";
}

TEST(PlaneRecord, OtherSteepPoliciesKeepFourWords) {
  const ScreenPlane steep = plane(-1000, 1, 1, 300000);
  const PlaneRecord wrap = make_record(steep, kScreen, SteepPolicy::kWrap, 0);
  EXPECT_EQ(wrap.words().size(), 4u);
  EXPECT_EQ(wrap.words()[0], static_cast<std::uint32_t>(std::int64_t{-300000} * 65536));
  const PlaneRecord saturated = make_record(steep, kScreen, SteepPolicy::kSaturate, 0);
  EXPECT_EQ(saturated.words()[0], 0x80000000u);
}

TEST(PlaneRecord, AnEdgeOnPlaneIsScaledToALargestStepOfOne) {
  const PlaneRecord record = wide_record(plane(3, -6, 0, -600));
  EXPECT_EQ(record.kind, PlaneKind::kEdgeOn);
  EXPECT_EQ(record.step_x, 65536 / 2);
  EXPECT_EQ(record.step_y, -65536);
  EXPECT_EQ(record.start, -100 * 65536);
}

TEST(PlaneRecord, ALineFarFromTheBoxIsAConstantOfItsSide) {
  for (const double side : {1.0, -1.0}) {
    const PlaneRecord record = wide_record(plane(1, 1, 0, side * 1e9));
    EXPECT_EQ(record.start, static_cast<std::int64_t>(side) * 65536);
    EXPECT_EQ(record.step_x, 0);
    EXPECT_EQ(record.step_y, 0);
  }
}

TEST(PlaneRecord, APlaneTooSteepEvenForWideBecomesEdgeOnAtTheMiddleDepth) {
  const double c = 1e-15;
  const PlaneRecord record = wide_record(plane(1, 0, c, -100));
  EXPECT_EQ(record.kind, PlaneKind::kEdgeOn);
  EXPECT_EQ(record.start, -100 * 65536);
  EXPECT_EQ(record.step_x, 65536);
  const PlaneRecord nothing_inside = wide_record(plane(0, 0, -1, 1e300));
  EXPECT_EQ(nothing_inside.kind, PlaneKind::kEdgeOn);
  EXPECT_EQ(nothing_inside.start, 65536) << "z >= 1e300 holds nowhere";
}

TEST(PlaneRecord, SteppedDepthStaysWithinHalfAFractionPerStep) {
  constexpr unsigned kSeed = 86;
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> slope(-30, 30), depth(0, 4095);
  for (int round = 0; round < 20; ++round) {
    const ScreenPlane p = plane(slope(random), slope(random), round % 2 ? 1 : -1, depth(random));
    const PlaneRecord record = wide_record(p);
    ASSERT_FALSE(record.wide);
    for (int y = 0; y < 512; ++y)
      for (int x = 0; x < 512; ++x) {
        const double stepped =
            static_cast<double>(record.start + x * record.step_x + y * record.step_y) / 65536;
        const double real = -(p.a * x + p.b * y + p.d) / p.c;
        ASSERT_LE(std::abs(stepped - real), (x + y + 1) * std::ldexp(1.0, -17) + 1e-9)
            << "seed " << kSeed << " round " << round << " at " << x << "," << y;
      }
  }
}

}  // namespace
}  // namespace dendro::half_space
