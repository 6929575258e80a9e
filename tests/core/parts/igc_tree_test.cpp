#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "models/parts/igc/clocked_tree.h"

namespace dendro::igc {
namespace {

using Wide = __int128;

/// A stream as a test sends it: coefficients, bits of T that are looked at, clocks behind it without a
/// stream.
struct Stream {
  std::int64_t a = 0, b = 0, c = 0;
  unsigned bits = 0, pause = 1;
};

/// How the tree is set up. The skews of the data sheet unless a test spoils them.
struct Rules {
  unsigned levels_x = 6, levels_y = 6;
  bool masked = true;
  unsigned gap = 0;
  int spoil_a = 0, spoil_b = 0;  ///< added to the skews

  unsigned skew_a() const { return static_cast<unsigned>(static_cast<int>(levels_x) - 1 + spoil_a); }
  unsigned skew_b() const {
    return static_cast<unsigned>(static_cast<int>(levels_x + levels_y) - 1 + spoil_b);
  }
};

Wide value_of(const Stream& s, unsigned x, unsigned y) { return Wide{s.a} * x + Wide{s.b} * y + s.c; }

/// Bits of all pixels and streams that are not those of the exact integers.
std::uint64_t wrong_bits(const Rules& setup, const std::vector<Stream>& streams) {
  TreeFeed feed(setup.skew_a(), setup.skew_b(), setup.gap);
  ClockedTree tree(setup.levels_x, setup.levels_y, setup.masked);
  const unsigned width = 1u << setup.levels_x, height = 1u << setup.levels_y,
                 latency = setup.levels_x + setup.levels_y;
  std::vector<std::size_t> leaves;
  for (unsigned y = 0; y < height; ++y)
    for (unsigned x = 0; x < width; ++x) leaves.push_back(leaf_of(setup.levels_x, x, y));

  // What the leaves show in each clock: the stream and its bit, or nothing that is looked at.
  struct Expected {
    int stream = -1;
    unsigned bit = 0;
  };
  std::vector<Expected> shown;
  std::vector<int> starts;
  for (int s = 0; s < static_cast<int>(streams.size()); ++s) {
    for (unsigned i = 0; i < setup.gap + streams[s].bits; ++i) {
      starts.push_back(i == 0 ? s : -1);
      shown.push_back(i < setup.gap ? Expected{} : Expected{s, i - setup.gap});
    }
    starts.insert(starts.end(), streams[s].pause, -1);
    shown.insert(shown.end(), streams[s].pause, Expected{});
  }
  starts.resize(starts.size() + latency, -1);
  std::uint64_t wrong = 0;
  for (std::size_t n = 0; n < starts.size(); ++n) {
    const Expected now = n >= latency ? shown[n - latency] : Expected{};
    if (now.stream >= 0) {
      const Stream& s = streams[static_cast<std::size_t>(now.stream)];
      for (unsigned y = 0, p = 0; y < height; ++y)
        for (unsigned x = 0; x < width; ++x, ++p) {
          const bool bit = tree.leaves()[leaves[p] / 64] >> leaves[p] % 64 & 1;
          wrong += bit != static_cast<bool>(value_of(s, x, y) >> now.bit & 1);
        }
    }
    if (starts[n] >= 0) {
      const Stream& s = streams[static_cast<std::size_t>(starts[n])];
      feed.start(s.a, s.b, s.c);
    }
    tree.clock(feed.clock());
  }
  return wrong;
}

std::vector<Stream> random_streams(std::uint64_t seed, int count, unsigned bits,
                                   unsigned shortest_pause = 0) {
  std::mt19937_64 random(seed);
  const auto coefficient = [&] {
    return static_cast<std::int64_t>(random()) >> (63 - bits + random() % bits);
  };
  std::vector<Stream> streams;
  for (int i = 0; i < count; ++i) {
    Stream s{coefficient(), coefficient(), coefficient(), 0, 0};
    s.bits = bits;
    s.pause = shortest_pause + (random() % 4 == 0 ? static_cast<unsigned>(random() % 30) : 0);
    streams.push_back(s);
  }
  return streams;
}

TEST(ClockedTree, EveryLeafIsTheExactIntegerForRandomCoefficientsAndCorners) {
  std::vector<Stream> streams = random_streams(1, 20, 40);
  for (const std::int64_t one : {std::int64_t{0}, std::int64_t{1}, std::int64_t{-1},
                                 (std::int64_t{1} << 39) - 1, -(std::int64_t{1} << 39)})
    for (const std::int64_t two : {std::int64_t{0}, std::int64_t{1}, std::int64_t{-1}})
      for (int which = 0; which < 3; ++which)
        streams.push_back({which == 0 ? one : two, which == 1 ? one : two, which == 2 ? one : -two, 60, 0});
  EXPECT_EQ(wrong_bits({6, 6}, streams), 0u);
}

TEST(ClockedTree, EveryShapeOfArrayGivesExactIntegers) {
  for (const auto& [x, y] : {std::pair{6u, 6u}, {6u, 10u}, {10u, 6u}, {7u, 7u}, {9u, 6u}, {6u, 9u}})
    EXPECT_EQ(wrong_bits({x, y}, random_streams(2 + x, 4, 30)), 0u) << x << " + " << y << " levels";
}

TEST(ClockedTree, FiveHundredAndTwelveSquaredGivesExactIntegers) {
  EXPECT_EQ(wrong_bits({9, 9}, random_streams(3, 4, 28)), 0u);
  EXPECT_EQ(wrong_bits({9, 9, false, 8}, random_streams(4, 4, 28)), 0u);
}

TEST(ClockedTree, CoefficientsOfSixtyFourBitsRepeatTheirSign) {
  const std::int64_t most = std::int64_t{1} << 62;
  EXPECT_EQ(
      wrong_bits({6, 6}, {{most, most, most, 80, 1}, {-most, -most, -most, 80, 1}, {-1, most, -most, 90, 1}}),
      0u);
}

TEST(ClockedTree, MaskedStreamsMayTouchHoweverShortTheyAre) {
  std::vector<Stream> streams;
  std::mt19937_64 random(5);
  for (int i = 0; i < 200; ++i)
    streams.push_back({static_cast<std::int64_t>(random()) >> 2, static_cast<std::int64_t>(random()) >> 2,
                       static_cast<std::int64_t>(random()) >> 2, 1 + static_cast<unsigned>(random() % 20),
                       static_cast<unsigned>(random() % 3)});
  EXPECT_EQ(wrong_bits({6, 6}, streams), 0u);
  EXPECT_EQ(wrong_bits({6, 8, true, 3}, streams), 0u);
}

TEST(ClockedTree, WithoutMaskStreamsNeedLevelsOfTheLongerAxisLessOneLeadingZeros) {
  for (const auto& [x, y] : {std::pair{6u, 6u}, {7u, 6u}, {6u, 8u}}) {
    const unsigned least = std::max(x, y) - 1;
    const std::vector<Stream> streams = random_streams(6, 12, 32);
    EXPECT_EQ(wrong_bits({x, y, false, least}, streams), 0u);
    EXPECT_EQ(wrong_bits({x, y, false, least + 5}, streams), 0u);
    for (unsigned gap = 0; gap < least; ++gap) EXPECT_GT(wrong_bits({x, y, false, gap}, streams), 0u) << gap;
  }
}

TEST(ClockedTree, LeadingZerosOfAMaskedStreamAreZeros) {
  TreeFeed feed(5, 11, 4);
  ClockedTree tree(6, 6, true);
  feed.start(-3, -5, -7);
  for (int i = 0; i < 40; ++i) tree.clock(feed.clock());
  feed.start(-1, -1, -1);
  for (unsigned n = 0; n < 16; ++n) {
    for (std::size_t w = 0; n >= 12 && w < tree.words(); ++w)
      ASSERT_EQ(tree.leaves()[w], 0u) << "clock " << n;
    tree.clock(feed.clock());
  }
}

TEST(ClockedTree, ASkewOneClockOffIsSeenAsWrong) {
  const std::vector<Stream> streams = random_streams(7, 4, 30);
  for (const int spoil : {-1, 1}) {
    Rules a{6, 6}, b{6, 6};
    a.spoil_a = spoil, b.spoil_b = spoil;
    EXPECT_GT(wrong_bits(a, streams), 0u);
    EXPECT_GT(wrong_bits(b, streams), 0u);
  }
}

TEST(ClockedTree, AShorterGapSpoilsMorePixels) {
  const std::vector<Stream> streams = random_streams(8, 8, 24);
  EXPECT_EQ(wrong_bits({9, 9, false, 8}, streams), 0u);
  const std::uint64_t seven = wrong_bits({9, 9, false, 7}, streams);
  const std::uint64_t none = wrong_bits({9, 9, false, 0}, streams);
  EXPECT_GT(seven, 0u);
  EXPECT_GT(none, seven);
}

}  // namespace
}  // namespace dendro::igc
