#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/half_space/stability/planes_support.h"

// N-P1. A plane that rises by s depth ranges over the screen (both axes together) and passes the range somewhere on it
// stays within s ranges of it, so that g guard bits with 2^(g-1) >= 1 + s hold it. Its register is compared with exact
// integers of the rounded coefficients at every pixel; with a bit fewer than they need it must be wrong.

namespace dendro::half_space {
namespace {

using stability::Bound;

constexpr unsigned kBits = 16;
constexpr int kGentlest = -1, kSteepest = 12;  ///< log2 of s
constexpr int kPlanesEach = 4;
constexpr int kBeyond[] = {23, 26, 30};        ///< log2 of s of planes that no stream holds
constexpr double kNearLine = 0x1p-6;           ///< pixels; the line moves by less over all depths, with its roundings

/// s ranges a screen in a random direction, through the depths at a random pixel; or, at its worst, through the farthest
/// depth at the corner from which it rises over the whole screen.
ScreenPlane random_plane(std::mt19937_64& random, int log2_s, bool front, bool worst = false) {
  std::uniform_real_distribution<double> unit(0, 1), turn(-M_PI, M_PI);
  const double angle = turn(random), sum = std::abs(std::cos(angle)) + std::abs(std::sin(angle));
  const double slope = std::ldexp(1.0, static_cast<int>(kBits) + log2_s) / (PlanesRig::kSide - 1) / sum;
  const double a = slope * std::cos(angle), b = slope * std::sin(angle);
  const double last = PlanesRig::kSide - 1;
  const double x = worst ? (a > 0 ? 0 : last) : unit(random) * last, y = worst ? (b > 0 ? 0 : last) : unit(random) * last;
  const double z = std::ldexp(worst ? 0.999 : unit(random), static_cast<int>(kBits));
  return plane_of(front ? PlaneKind::kFront : PlaneKind::kBack, a, b, z - a * x - b * y);
}

/// Pixels whose register is not the exact integer's. Of back only what is above bit 0, which says where a hull is seen.
void compare(const PlanesRig& array, const StreamPlane& plane, const std::string& name, Tally& tally) {
  const bool front = plane.kind == PlaneKind::kFront;
  const unsigned hidden = front ? 0 : 1;
  const Field field = array.draw({plane}, front ? array.layout().front : array.layout().back);
  const ExactStream exact(plane);
  for (int y = 0; y < PlanesRig::kSide; ++y)
    for (int x = 0; x < PlanesRig::kSide; ++x) {
      ++tally.pixels;
      const auto wanted =
          static_cast<std::uint32_t>(std::clamp<std::int64_t>(exact.floor(x, y), 0, array.most()));
      const std::uint32_t got = field[static_cast<std::size_t>(y) * PlanesRig::kSide + x];
      if (got >> hidden != wanted >> hidden)
        tally.fault(fmt::format("{}: pixel ({}, {}) holds {}, not {}", name, x, y, got, wanted));
    }
}

struct Totals {
  Tally right, fewer, unseen, unruly, steep;
  int most_spare = 0;  ///< guard bits that the host takes beyond what the plane needs
};

double rule(int log2_s) { return std::ceil(std::log2(1 + std::ldexp(1.0, log2_s))) + 1; }

/// Fewest and most guard bits that the host takes for planes of one slope.
std::pair<unsigned, unsigned> check_slope(const PlanesRig& array, std::mt19937_64& random, int log2_s, std::uint64_t seed,
                                          Totals& totals) {
  unsigned fewest = 64, most = 0;
  for (int i = 0; i < kPlanesEach; ++i) {
    StreamPlane plane = array.stream(random_plane(random, log2_s, i % 2 == 0, i < 2));
    const std::string name = fmt::format("{} plane {} of 2^{} ranges a screen, seed {}",
                                         i % 2 == 0 ? "front" : "back", i + 1, log2_s, seed);
    const unsigned needed = ExactStream(plane).guard(kBits), taken = plane.guard;
    fewest = std::min(fewest, taken), most = std::max(most, taken);
    totals.most_spare = std::max(totals.most_spare, static_cast<int>(taken) - static_cast<int>(needed));
    if (needed > rule(log2_s)) totals.unruly.fault(fmt::format("{}: {} guard bits are needed", name, needed));
    compare(array, plane, fmt::format("{}, {} guard bits", name, taken), totals.right);
    if (needed < 2) continue;
    plane.guard = needed - 1;
    const std::int64_t before = totals.fewer.count;
    compare(array, plane, fmt::format("{}, {} guard bits", name, needed - 1), totals.fewer);
    if (totals.fewer.count == before) totals.unseen.fault(name + ": no pixel is wrong");
  }
  return {fewest, most};
}

/// Planes that become sign tests, between two flat ones: coverage against the exact line at the middle of the depths.
void check_beyond(const PlanesRig& array, std::mt19937_64& random, int log2_s, std::uint64_t seed, Totals& totals) {
  const double near = 5.5, far = array.most() - 5.5;
  for (const bool front : {true, false}) {
    const ScreenPlane plane = random_plane(random, log2_s, front);
    const StreamPlane stream = array.stream(plane);
    const std::string name =
        fmt::format("{} plane of 2^{} ranges a screen, seed {}", front ? "front" : "back", log2_s, seed);
    if (stream.kind != PlaneKind::kEdgeOn) totals.steep.fault(name + " is no sign test");
    const Field nearest = array.draw({array.stream(plane_of(PlaneKind::kBack, 0, 0, far)), stream,
                                      array.stream(plane_of(PlaneKind::kFront, 0, 0, near))},
                                     array.layout().nearest);
    ScreenPlane line = plane;  // outside where a x + b y + c z + d > 0
    line.kind = PlaneKind::kEdgeOn;
    line.d += line.c * array.most() / 2.0;
    ExactPlane exact(line);
    for (int y = 0; y < PlanesRig::kSide; ++y)
      for (int x = 0; x < PlanesRig::kSide; ++x) {
        ++totals.steep.pixels;
        const double outside = static_cast<double>(exact.floor32(x, y)) * 0x1p-32;
        const bool covered = nearest[static_cast<std::size_t>(y) * PlanesRig::kSide + x] != array.most();
        if (std::abs(outside) > kNearLine && covered != (outside < 0))
          totals.steep.fault(fmt::format("{}: pixel ({}, {}), {:.4f} pixels {}, is {}", name, x, y, std::abs(outside),
                                         outside < 0 ? "inside" : "outside", covered ? "covered" : "empty"));
      }
  }
}

}  // namespace

stability::Result planes_guard(const stability::Rig& rig, std::uint64_t seed) {
  const PlanesRig array(rig, kBits);
  std::mt19937_64 random(seed);
  Totals totals;
  stability::Curve curve{"N-P1",
                         "Guard bits of planes that pass the depths on a 512 x 512 array",
                         {"log2 of depth ranges a screen", "most that a plane takes, 2^(g-1) >= 1 + s", "fewest"},
                         {},
                         false,
                         "guard bits, sign included"};
  for (int log2_s = kGentlest; log2_s <= kSteepest; ++log2_s) {
    const auto [fewest, most] = check_slope(array, random, log2_s, seed, totals);
    curve.rows.push_back({double(log2_s), double(most), double(fewest)});
  }
  for (const int log2_s : kBeyond) check_beyond(array, random, log2_s, seed, totals);
  const auto row = [](const std::string& what, const Tally& tally, const char* unit, Bound kind = Bound::kAtMost) {
    return stability::Row{"N-P1", what, static_cast<double>(tally.count), 0, unit, "exact integers", kind, tally.first};
  };
  return {{row("wrong registers, guard bits chosen by plane", totals.right, "pixels"),
           row("wrong registers, one guard bit fewer than needed", totals.fewer, "pixels", Bound::kMoreThan),
           row("planes that one guard bit fewer leaves right", totals.unseen, "planes"),
           row("planes that need more than 2^(g-1) >= 1 + s", totals.unruly, "planes"),
           {"N-P1", "guard bits taken beyond those needed", static_cast<double>(totals.most_spare), 1, "bits",
            "exact integers", Bound::kAtMost, ""},
           row("sign tests of planes too steep to stream: wrong further than 1/64 pixel from the line", totals.steep,
               "pixels")},
          {curve}};
}

}  // namespace dendro::half_space
