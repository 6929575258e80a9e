#include <fmt/format.h>

#include "firmware/half_space/stability/planes_support.h"

// N-P3. In a 512 x 512 array the A line must lag C by 8 clocks and B by 17, and without masks 8 dead clocks must part two
// expressions, or the sign of one runs into the next. The tree's nodes give every fourth pixel of every fourth line its
// values, which are compared with exact integers; one clock short must be seen.

namespace dendro::half_space {
namespace {

using stability::Bound;
using stability::TreeDrive;

constexpr int kStreams = 20, kEvery = 4;
constexpr unsigned kBits = 28;  ///< 16 of depth, 10 of fraction, 2 of guard
constexpr unsigned kMostGap = 12;
constexpr unsigned kNeeded = 8;  ///< dead clocks: levels of an axis, less one [DER 18 levels]

std::vector<stability::TreeStream> random_streams(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  constexpr std::int64_t kSlope = std::int64_t{1} << (kBits - 11), kConstant = std::int64_t{1} << (kBits - 2);
  std::uniform_int_distribution<std::int64_t> slope(-kSlope, kSlope - 1), constant(-kConstant, kConstant - 1);
  std::vector<stability::TreeStream> streams;
  for (int i = 0; i < kStreams; ++i) streams.push_back({slope(random), slope(random), constant(random), kBits});
  return streams;
}

/// A x + B y + C as a two's complement number of so many bits.
std::int64_t exact_value(const stability::TreeStream& s, const stability::TreePixel& p) {
  mpz_class value = mpz_class(static_cast<long>(s.a)) * p.x + mpz_class(static_cast<long>(s.b)) * p.y +
                    static_cast<long>(s.c);
  const mpz_class modulus = mpz_class(1) << s.bits;
  mpz_fdiv_r(value.get_mpz_t(), value.get_mpz_t(), modulus.get_mpz_t());
  if (value >= modulus / 2) value -= modulus;
  return static_cast<std::int64_t>(value.get_si());
}

class Checker {
 public:
  Checker(const stability::Rig& rig, std::uint64_t seed) : rig_(rig), seed_(seed), streams_(random_streams(seed)) {
    for (int y = 0; y < PlanesRig::kSide; y += kEvery)
      for (int x = 0; x < PlanesRig::kSide; x += kEvery) pixels_.push_back({x, y});
    for (const stability::TreeStream& s : streams_)
      for (const stability::TreePixel& p : pixels_) wanted_.push_back(exact_value(s, p));
  }

  Tally wrong(const TreeDrive& drive, const std::string& name) const {
    Tally tally;
    const auto values = rig_.tree(drive, streams_, pixels_);
    for (std::size_t s = 0, at = 0; s < streams_.size(); ++s)
      for (std::size_t p = 0; p < pixels_.size(); ++p, ++at) {
        ++tally.pixels;
        if (values[s][p] != wanted_[at])
          tally.fault(fmt::format("{}, seed {}: expression {}, pixel ({}, {}) is {}, not {}", name, seed_, s + 1,
                                  pixels_[p].x, pixels_[p].y, values[s][p], wanted_[at]));
      }
    return tally;
  }

 private:
  const stability::Rig& rig_;
  std::uint64_t seed_;
  std::vector<stability::TreeStream> streams_;
  std::vector<stability::TreePixel> pixels_;
  std::vector<std::int64_t> wanted_;
};

double percent(const Tally& tally) { return tally.per_million() / 1e4; }

}  // namespace

stability::Result planes_tree(const stability::Rig& rig, std::uint64_t seed) {
  const Checker checker(rig, seed);
  stability::Result result;
  const auto add = [&](const std::string& what, const TreeDrive& drive, Bound kind) {
    const Tally tally = checker.wrong(drive, what);
    result.rows.push_back({"N-P3", what + ": wrong values", percent(tally), 0, "%", "gmp", kind, tally.first});
  };
  add("masks, no dead clocks", {true, 0, 0, 0}, Bound::kAtMost);
  add("masks, 5 dead clocks", {true, 5, 0, 0}, Bound::kAtMost);
  for (const auto& [what, a, b] : {std::tuple("A one clock early", -1, 0), {"A one clock late", 1, 0},
                                   {"B one clock early", 0, -1}, {"B one clock late", 0, 1},
                                   {"A and B one clock early", -1, -1}}) {
    add(fmt::format("masks, {}", what), {true, 0, a, b}, Bound::kMoreThan);
    add(fmt::format("{} dead clocks, {}", kNeeded, what), {false, kNeeded, a, b}, Bound::kMoreThan);
  }
  stability::Curve curve{"N-P3", "Dead clocks between expressions, without masks, 512 x 512",
                         {"dead clocks", "wrong values, %"}, {}, false, "wrong values, %"};
  for (unsigned gap = 0; gap <= kMostGap; ++gap) {
    const std::string what = fmt::format("{} dead clocks without masks", gap);
    const Tally tally = checker.wrong({false, gap, 0, 0}, what);
    curve.rows.push_back({double(gap), percent(tally)});
    if (gap == 0 || gap + 1 >= kNeeded)
      result.rows.push_back({"N-P3", what + ": wrong values", percent(tally), 0, "%", "gmp",
                             gap < kNeeded ? Bound::kMoreThan : Bound::kAtMost, tally.first});
  }
  result.curves.push_back(curve);
  return result;
}

}  // namespace dendro::half_space
