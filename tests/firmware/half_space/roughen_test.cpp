#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "firmware/half_space/host/hulls_layout.h"
#include "firmware/half_space/reference/roughen_model.h"
#include "sim/base/error.h"
#include "tests/firmware/half_space/program_on_machine.h"

namespace dendro::half_space {
namespace {

using namespace testing_programs;

constexpr unsigned kSeed = 53;
constexpr const char* kProgram = "firmware/half_space/rds3000/roughen.gia";

std::uint32_t hull_pixel(std::uint32_t front, std::uint32_t back) { return front | back << kHullBackLow; }

/// Every kind of pixel that hulls.gia leaves, and front = back other than 0.
Frame random_hull_frame(std::mt19937& random) {
  Frame frame(kFrame * kFrame);
  for (std::uint32_t& word : frame) {
    const unsigned kind = random() % 10;
    const std::uint32_t back = 1 + random() % 254, front = random() % back;
    word = kind < 2    ? 0
           : kind == 2 ? hull_pixel(back, back)
           : kind == 3 ? hull_pixel(front, 255)
                       : hull_pixel(front, back);
    word |= (random() & 0xFF) << kNearestLow;
  }
  return frame;
}

Box random_box(std::mt19937& random) {
  const auto side = [&](int& low, int& high) {
    low = static_cast<int>(random() % kFrame), high = static_cast<int>(random() % kFrame);
    if (low > high) std::swap(low, high);
    if (high - low > 200) high = low + 200;
  };
  Box box;
  side(box.x0, box.x1), side(box.y0, box.y1);
  return box;
}

Frame roughened(const Frame& before, const Roughening& roughening, const std::string& pack) {
  const lib::ProgramImage image = assembled(kProgram, pack);
  return frame_after(before, image, with_cards(3),
                     [&](lib::RdsDriver& driver) { run_roughen(driver, image, roughening); });
}

/// What happened to a pixel.
struct Fates {
  int moved = 0, clamped = 0, holes = 0, empty = 0, unbounded = 0;

  void count(std::uint32_t before, std::uint32_t after, int field, int maxdepth) {
    const int front = static_cast<int>(before & 0xFF), back = static_cast<int>(before >> 8 & 0xFF);
    if (front >= back) {
      ++empty;
      EXPECT_EQ(after, before);
    } else if (back >= maxdepth) {
      ++unbounded;
      EXPECT_EQ(after, before);
    } else if (std::max(1, front + field) >= back) {
      ++holes;
      EXPECT_EQ(after & kHullBoth, 0u);
    } else {
      ++(front + field < 1 ? clamped : moved);
      EXPECT_EQ(static_cast<int>(after & 0xFF), std::max(1, front + field));
      EXPECT_EQ(after >> 8, before >> 8);
    }
  }
};

TEST(RoughenMicrocode, EveryPixelWordIsThatOfTheIntegerModelStraightAndPacked) {
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> hurst(0.1, 1), extent(1, 255);
  Fates fates;
  for (int i = 0; i < 8; ++i) {
    const Frame before = random_hull_frame(random);
    const int maxdepth = i % 4 == 3 ? 200 : 255;
    const Box box = i == 0 ? Box{511, 300, 511, 300} : random_box(random);
    const Roughening roughening = make_roughening({i == 1 ? 1.0 : 0.05 + 0.1 * i, hurst(random)},
                                                  extent(random), box, maxdepth, kSeed, i);
    Frame wanted = before;
    roughen_model(roughening, kFrame, wanted);
    const std::vector<int> tile = roughen_tile(roughening);
    for (const char* pack : {"none", "full"}) {
      const Frame got = roughened(before, roughening, pack);
      for (int p = 0; p < kFrame * kFrame; ++p)
        ASSERT_EQ(got[p], wanted[p]) << pack << " case " << i << " at " << p % kFrame << "," << p / kFrame;
    }
    for (int y = box.y0; y <= box.y1; ++y)
      for (int x = box.x0; x <= box.x1; ++x)
        fates.count(before[y * kFrame + x], wanted[y * kFrame + x], tile[y % 64 * 64 + x % 64], maxdepth);
  }
  EXPECT_GT(fates.moved, 5000);
  EXPECT_GT(fates.clamped, 500) << "z' < 1 must occur";
  EXPECT_GT(fates.holes, 500) << "z' >= back must occur";
  EXPECT_GT(fates.empty, 5000);
  EXPECT_GT(fates.unbounded, 2000);
}

TEST(RoughenMicrocode, IsTheSameWithASlowerMultiplier) {
  std::mt19937 random(kSeed);
  const Frame before = random_hull_frame(random);
  const Roughening roughening = make_roughening({0.3, 0.6}, 200, {100, 50, 260, 180}, 255, kSeed, 9);
  Frame wanted = before;
  roughen_model(roughening, kFrame, wanted);
  for (const char* pack : {"none", "full"}) {
    const lib::ProgramImage image = assembled(kProgram, pack, 4);
    EXPECT_EQ(wanted, frame_after(before, image, with_multiplier(4),
                                  [&](lib::RdsDriver& driver) { run_roughen(driver, image, roughening); }))
        << pack;
  }
}

TEST(RoughenMicrocode, TheFieldRepeatsEvery64PixelsAndHasNoSeam) {
  const Frame before(kFrame * kFrame, hull_pixel(127, 254));
  // Displacements of at most 12 times 10 depths clamp nothing.
  const Roughening roughening = make_roughening({0.05, 0.5}, 200, {0, 0, 199, 199}, 255, kSeed, 1);
  const Frame after = roughened(before, roughening, "full");
  const auto front = [&](int x, int y) { return static_cast<int>(after[y * kFrame + x] & 0xFF); };
  double inside = 0, across = 0;
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x) {
      ASSERT_EQ(front(x, y), front(x + 64, y));
      ASSERT_EQ(front(x, y), front(x, y + 64));
      const double step = std::abs(front(x, y) - front(x + 1, y)) + std::abs(front(y, x) - front(y, x + 1));
      (x % 64 == 63 ? across : inside) += step;
    }
  EXPECT_GT(inside, 0);
  const double ratio = across / 1.0 / (inside / 63);
  EXPECT_GT(ratio, 0.6);
  EXPECT_LT(ratio, 1.6);
}

/// log2 of how the standard deviation of increments grows with twice the distance, over several tiles.
double measured_hurst(double hurst) {
  double sums[5] = {};
  for (std::uint64_t stream = 0; stream < 30; ++stream) {
    const std::vector<int> tile = roughen_tile(make_roughening({0.8, hurst}, 250, {}, 255, kSeed, stream));
    for (int k = 0; k < 5; ++k)
      for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
          const double right = tile[y * 64 + (x + (1 << k)) % 64] - tile[y * 64 + x];
          const double down = tile[(y + (1 << k)) % 64 * 64 + x] - tile[y * 64 + x];
          sums[k] += right * right + down * down;
        }
  }
  // Distance 16 is a quarter of the period and falls off; 1 to 8 are left.
  return std::log2(sums[3] / sums[0]) / 2 / 3;
}

TEST(RoughenModel, IncrementsGrowWithTheHurstExponent) {
  double last = 0;
  for (const double hurst : {0.3, 0.5, 0.8}) {
    const double measured = measured_hurst(hurst);
    // The torus holds the far increments down, those of large exponents most.
    EXPECT_NEAR(measured, hurst, 0.25);
    EXPECT_GT(measured, last + 0.1);
    last = measured;
  }
}

TEST(RoughenModel, CrownsHaveFieldsOfTheirOwnThatTheSeedRepeats) {
  const auto tile = [](std::uint64_t seed, std::uint64_t stream) {
    return roughen_tile(make_roughening({0.1, 0.5}, 200, {}, 255, seed, stream));
  };
  EXPECT_EQ(tile(1, 2), tile(1, 2));
  EXPECT_NE(tile(1, 2), tile(1, 3));
  EXPECT_NE(tile(1, 2), tile(2, 2));
}

TEST(RoughenHost, AmplitudesFallByTheHurstExponentAndTwoStagesHalveTheDistance) {
  const Roughening roughening = make_roughening({0.5, 0.5}, 200, {}, 255, 1, 1);
  ASSERT_EQ(roughening.amplitudes.size(), 12u);
  EXPECT_EQ(roughening.amplitudes[0], 100u << 7);
  for (std::size_t i = 2; i < 12; ++i)
    EXPECT_NEAR(roughening.amplitudes[i], roughening.amplitudes[i - 2] * std::sqrt(0.5), 1);
  EXPECT_EQ(roughening.seeds.size(), 8u);
}

TEST(RoughenHost, KeysOutsideTheirRangeAreErrors) {
  for (const auto& [key, value] : {std::pair("roughness", 1.5),
                                   {"roughness", -0.1},
                                   {"roughness_hurst", 0.0},
                                   {"roughness_hurst", 1.1}}) {
    scene::Options options("half_space", {"a.toml", 3});
    options.set(key, {value, {"a.toml", 7}});
    try {
      read_roughen(options);
      ADD_FAILURE() << key << " " << value;
    } catch (const UserError& e) {
      EXPECT_NE(std::string(e.what()).find("a.toml:7"), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find(key), std::string::npos) << e.what();
    }
  }
}

}  // namespace
}  // namespace dendro::half_space
