#include <fmt/format.h>

#include <algorithm>

#include "firmware/half_space/stability/support.h"

// N-A5. All coefficients are multiples of 2^-6, so that records are exact and every word is known.

namespace dendro::half_space {
namespace {

using stability::Bound;

constexpr int kSide = 128;
constexpr int kOrders = 6;  ///< permutations of each set

struct Set {
  std::string name;
  std::vector<ScreenPlane> planes;
};

/// z = slope_x·x + slope_y·y + start as a back (1) or front (-1) plane.
ScreenPlane at_depth(double slope_x, double slope_y, double start, double side) {
  return {-side * slope_x, -side * slope_y, side, -side * start};
}

Set random_set(std::mt19937_64& random, int planes, bool twice) {
  const auto sixty_fourths = [&](int low, int high) {
    return static_cast<double>(std::uniform_int_distribution<int>(low, high)(random)) / 64;
  };
  Set set{fmt::format("{} random planes{}", planes, twice ? ", each twice" : ""), {}};
  for (int i = 0; i < planes; ++i) {
    const double side = i % 2 == 0 ? 1 : -1;
    const double sx = sixty_fourths(-256, 256), sy = sixty_fourths(-256, 256);
    const double middle = 2048 + side * sixty_fourths(3000, 12000);
    set.planes.push_back(at_depth(sx, sy, middle - 64 * (sx + sy), side));
    if (twice) set.planes.push_back(set.planes.back());
  }
  return set;
}

std::vector<Set> sets(std::uint64_t seed) {
  std::vector<Set> all = {
      {"front and back in one plane", {at_depth(0, 0, 100, 1), at_depth(0, 0, 100, -1)}},
      {"front and back in one slanted plane", {at_depth(3.5, -1.25, 700, 1), at_depth(3.5, -1.25, 700, -1)}},
      {"less than a step apart", {at_depth(0, 0, 100.75, 1), at_depth(0, 0, 100.25, -1)}},
      {"one step apart", {at_depth(0, 0, 101, 1), at_depth(0, 0, 100, -1)}},
      {"wedge with its edge on column 64", {at_depth(-2, 0, 328, 1), at_depth(2, 0, 72, -1)}},
      {"wedge with its edge between columns", {at_depth(-2, 0.5, 329, 1), at_depth(2, 0.5, 71, -1)}},
      {"front at the nearest, back at the largest depth", {at_depth(0, 0, 0, -1), at_depth(0, 0, 4095, 1)}},
  };
  std::mt19937_64 random(seed);
  for (const int planes : {8, 20}) {
    all.push_back(random_set(random, planes, false));
    all.push_back(random_set(random, planes, true));
  }
  return all;
}

}  // namespace

stability::Result ties(const stability::Rig& rig, std::uint64_t seed) {
  Tally exact, order, covered;
  std::int64_t tied = 0;
  std::mt19937_64 random(seed + 1);
  for (const Set& set : sets(seed)) {
    std::vector<ScreenPlane> planes = set.planes;
    Words first;
    for (int i = 0; i < kOrders; ++i) {
      const std::string name = i == 0 ? set.name : fmt::format("{}, order {} of seed {}", set.name, i, seed);
      const Prepared prepared = from_screen(planes, kSide, kSide);
      Enclosure enclosure(prepared, Rounding::kNone);
      Words words = draw(rig, prepared);
      compare_enclosed(words, enclosure, kSide, name, exact);
      // Numbers of faces follow the order; what is covered, and how deep, does not.
      for (std::uint32_t& word : words) word = face_of(word) != 0 ? 1u << kFaceLow | (word & kFieldMask) : 0;
      if (i == 0) first = words;
      for (const std::uint32_t word : words) tied += word == 0, covered.count += word != 0;
      compare_words(words, first, kSide, name, order);
      std::shuffle(planes.begin(), planes.end(), random);
    }
  }
  return {{{"N-A5",
            fmt::format("words against the sign of front - back, {} pixels covered, {} empty", covered.count,
                        tied),
            static_cast<double>(exact.count), 0, "pixels", "gmp", Bound::kAtMost, exact.first},
           {"N-A5",
            fmt::format("pixels that change with the order of the planes, {} orders of each set", kOrders),
            static_cast<double>(order.count), 0, "pixels", "machine", Bound::kAtMost, order.first},
           {"N-A5", "covered pixels, so that the sets decide something", static_cast<double>(covered.count),
            0, "pixels", "machine", Bound::kMoreThan, ""}},
          {}};
}

}  // namespace dendro::half_space
