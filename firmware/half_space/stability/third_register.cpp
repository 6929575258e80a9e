#include <fmt/format.h>

#include <algorithm>

#include "firmware/half_space/host/hulls_layout.h"
#include "firmware/half_space/host/prepare_hulls.h"
#include "firmware/half_space/stability/support.h"

// N-A6. Hulls in three registers of 8 bits: depths beyond 0..255 on both sides, hulls that touch exactly,
// fronts in one plane. All coefficients are multiples of 2^-6, so that records are exact and every word is
// known.

namespace dendro::half_space {
namespace {

using stability::Bound;
using Planes = std::vector<ScreenPlane>;

constexpr int kSide = 96;
constexpr int kOrders = 4;  ///< of the hulls of each set
constexpr int kMaxDepth = 255;

/// z = slope_x·x + slope_y·y + start as a back (1) or front (-1) plane.
ScreenPlane at_depth(double slope_x, double slope_y, double start, double side) {
  return {-side * slope_x, -side * slope_y, side, -side * start};
}

/// Front and back at these depths in the columns x0..x1.
Planes slab(double front, double back, double x0 = -1, double x1 = kSide) {
  return {at_depth(0, 0, front, -1), at_depth(0, 0, back, 1), {-1, 0, 0, x0}, {1, 0, 0, -x1}};
}

struct Set {
  std::string name;
  std::vector<Planes> hulls;
};

Planes random_planes(std::mt19937_64& random) {
  const auto sixty_fourths = [&](int low, int high) {
    return static_cast<double>(std::uniform_int_distribution<int>(low, high)(random)) / 64;
  };
  Planes planes;
  const double middle = sixty_fourths(-64 * 40, 64 * 290);  // many reach beyond the register
  for (int i = 0; i < 8; ++i) {
    const double side = i % 2 == 0 ? 1 : -1;
    const double sx = sixty_fourths(-512, 512), sy = sixty_fourths(-512, 512);
    const double start = middle + side * sixty_fourths(1000, 12000);
    planes.push_back(at_depth(sx, sy, start - 48 * (sx + sy), side));
  }
  return planes;
}

std::vector<Set> sets(std::uint64_t seed) {
  std::vector<Set> all = {
      {"a back touches the next front", {slab(50, 100, 0, 60), slab(100, 150, 30, 90)}},
      {"fronts in one plane", {slab(80, 120, 0, 60), slab(80, 200, 30, 90)}},
      {"a hull twice", {slab(60, 90), slab(60, 90)}},
      {"fronts that cross on column 48",
       {{at_depth(2, 0, 32, -1), at_depth(0, 0, 254, 1)},
        {at_depth(-2, 0, 224, -1), at_depth(0, 0, 254, 1)}}},
      {"side by side on column 40", {slab(70, 90, 0, 40), slab(70, 90, 40, 80)}},
      {"backs around the largest depth",
       {slab(200, 253, 0, 20), slab(200, 254, 20, 40), slab(200, 255, 40, 60), slab(200, 256, 60, 80),
        slab(200, 511, 80, 95)}},
      {"fronts around the largest depth",
       {slab(252, 254, 0, 20), slab(253.5, 254, 20, 40), slab(254, 254, 40, 60), slab(255, 256, 60, 80),
        slab(256, 300, 80, 95)}},
      {"fronts around the screen",
       {slab(-300, 40, 0, 20), slab(-1, 50, 20, 40), slab(0, 60, 40, 60), slab(-5, 0, 60, 80),
        slab(-9, -2, 80, 95)}},
      {"a slope through 8 bits twice",
       {{at_depth(8, 0, -256, -1), at_depth(8, 0, -200, 1)},
        {at_depth(-8, 4, 400, -1), at_depth(-8, 4, 450, 1)}}},
  };
  std::mt19937_64 random(seed);
  for (const int hulls : {3, 6}) {
    Set set{fmt::format("{} random hulls", hulls), {}};
    for (int i = 0; i < hulls; ++i) set.hulls.push_back(random_planes(random));
    set.hulls.push_back(set.hulls.front());
    all.push_back(std::move(set));
  }
  return all;
}

PreparedHulls prepared_hulls(const std::vector<Planes>& hulls) {
  PreparedHulls result;
  result.width = result.height = kSide;
  result.maxdepth = kMaxDepth;
  result.shades.resize(256);
  for (const Planes& planes : hulls) {
    const Prepared one = from_screen(planes, kSide, kSide, SteepPolicy::kWide, kMaxDepth);
    Hull hull;
    hull.screen = one.screen;
    hull.program = one.program;
    for (PlaneRecord& record : hull.program.front) record.face = 0;
    result.hulls.push_back(std::move(hull));
  }
  return result;
}

/// What one hull leaves in its two registers at a pixel, in rationals.
class ExactHull {
 public:
  explicit ExactHull(const Hull& hull) {
    for (const ScreenPlane& plane : hull.screen) planes_.emplace_back(plane), kinds_.push_back(plane.kind);
  }

  struct Registers {
    int front = 0, back = kMaxDepth;
    bool beyond = false;  ///< a depth outside 0..255 was clamped

    bool covered() const { return front < back && back < kMaxDepth; }
    std::uint32_t word() const {
      return front < back ? static_cast<std::uint32_t>(front | back << kHullBackLow) : 0;
    }
  };

  Registers at(int x, int y) {
    Registers r;
    bool outside = false;
    for (std::size_t k = 0; k < planes_.size(); ++k) {
      const std::int64_t value = planes_[k].floor32(x, y);
      if (kinds_[k] == PlaneKind::kEdgeOn) {
        outside = outside || value > 0;
        continue;
      }
      const std::int64_t z = value >> 32;
      r.beyond = r.beyond || z < 0 || z > kMaxDepth;
      const int depth = static_cast<int>(std::clamp<std::int64_t>(z, 0, kMaxDepth));
      if (kinds_[k] == PlaneKind::kBack)
        r.back = std::min(r.back, depth);
      else
        r.front = std::max(r.front, depth);
    }
    if (outside) r.front = r.back = 0;
    return r;
  }

 private:
  std::vector<ExactPlane> planes_;
  std::vector<PlaneKind> kinds_;
};

struct Exact {
  Words words;
  std::int64_t ties = 0;    ///< pixels where two hulls share a depth of their surfaces
  std::int64_t beyond = 0;  ///< pixels with a depth beyond 8 bits
};

Exact exact_words(const PreparedHulls& prepared) {
  std::vector<ExactHull> hulls(prepared.hulls.begin(), prepared.hulls.end());
  Exact exact;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      int nearest = kMaxDepth;
      std::vector<int> surfaces;
      std::uint32_t last = 0;
      bool beyond = false;
      for (ExactHull& hull : hulls) {
        const auto r = hull.at(x, y);
        last = r.word();
        beyond = beyond || r.beyond;
        if (!r.covered()) continue;
        nearest = std::min(nearest, r.front);
        surfaces.push_back(r.front), surfaces.push_back(r.back);
      }
      std::sort(surfaces.begin(), surfaces.end());
      exact.ties += std::adjacent_find(surfaces.begin(), surfaces.end()) != surfaces.end();
      exact.beyond += beyond;
      exact.words.push_back(last | static_cast<std::uint32_t>(nearest) << kNearestLow);
    }
  return exact;
}

void compare(const Words& got, const Words& wanted, std::uint32_t mask, const std::string& set,
             Tally& tally) {
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    ++tally.pixels;
    if ((got[i] & mask) == (wanted[i] & mask)) continue;
    const auto part = [](std::uint32_t word, int low) { return word >> low & kHullField; };
    tally.fault(fmt::format(
        "{}: pixel ({}, {}) has nearest {}, and front {}, back {} of the last hull, not {}, {}, {}", set,
        i % kSide, i / kSide, part(got[i], kNearestLow), part(got[i], 0), part(got[i], kHullBackLow),
        part(wanted[i], kNearestLow), part(wanted[i], 0), part(wanted[i], kHullBackLow)));
  }
}

}  // namespace

stability::Result third_register(const stability::Rig& rig, std::uint64_t seed) {
  Tally words, order;
  std::int64_t ties = 0, beyond = 0, hulls = 0;
  std::mt19937_64 random(seed + 1);
  const std::vector<Set> all = sets(seed);
  for (const Set& set : all) {
    std::vector<Planes> now = set.hulls;
    hulls += static_cast<std::int64_t>(now.size());
    Words first;
    for (int i = 0; i < kOrders; ++i) {
      const std::string name = i == 0 ? set.name : fmt::format("{}, order {} of seed {}", set.name, i, seed);
      const PreparedHulls prepared = prepared_hulls(now);
      const Words got = draw_hulls(rig, prepared);
      const Exact exact = exact_words(prepared);
      compare(got, exact.words, 0xFFFFFF, name, words);
      if (i == 0) first = got, ties += exact.ties, beyond += exact.beyond;
      compare(got, first, kHullField << kNearestLow, name, order);
      std::shuffle(now.begin(), now.end(), random);
    }
  }
  return {
      {{"N-A6", fmt::format("words of {} hulls in {} sets against the rational minimum", hulls, all.size()),
        static_cast<double>(words.count), 0, "pixels", "gmp", Bound::kAtMost, words.first},
       {"N-A6", fmt::format("nearest depths that change with the order of the hulls, {} orders", kOrders),
        static_cast<double>(order.count), 0, "pixels", "machine", Bound::kAtMost, order.first},
       {"N-A6", "pixels where two hulls touch exactly", static_cast<double>(ties), 0, "pixels", "gmp",
        Bound::kMoreThan, ""},
       {"N-A6", "pixels with a depth beyond 8 bits", static_cast<double>(beyond), 0, "pixels", "gmp",
        Bound::kMoreThan, ""}},
      {}};
}

}  // namespace dendro::half_space
