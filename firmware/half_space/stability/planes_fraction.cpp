#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/half_space/stability/planes_support.h"

// N-P2. A x + B y + C is streamed with its coefficients rounded to f bits behind the point and then exact, so a depth is off
// by at most (x + y + 1) / 2^(f+1) units and what single precision takes: 1023 / 2^(f+1) at the far corner. What the
// register holds is its floor; the error is the distance of the real depth from the unit that the register names.

namespace dendro::half_space {
namespace {

using stability::Bound;

constexpr unsigned kBits = 16;
constexpr unsigned kFewest = 4, kMost = 13;
constexpr int kRandomPlanes = 3;
constexpr double kReach = 60;  ///< units a pixel, of each slope

/// Inside the depths on the whole array.
ScreenPlane random_plane(std::mt19937_64& random) {
  std::uniform_real_distribution<double> slope(-kReach, kReach);
  const double a = slope(random), b = slope(random), last = PlanesRig::kSide - 1;
  const double low = std::min(a * last, 0.0) + std::min(b * last, 0.0);
  return plane_of(PlaneKind::kFront, a, b, 1000 - low + std::abs(slope(random)));
}

/// The same plane with every coefficient almost half a step above a number of `fraction` bits; slopes have it in single precision too.
ScreenPlane worst_plane(std::mt19937_64& random, unsigned fraction) {
  const ScreenPlane plane = random_plane(random);
  const auto worst = [&](double v) {
    return (std::floor(std::ldexp(v, static_cast<int>(fraction))) + 0.46875) / std::ldexp(1.0, static_cast<int>(fraction));
  };
  return plane_of(PlaneKind::kFront, worst(plane.a), worst(plane.b), worst(plane.d));
}

struct Error {
  double units = 0, bound = 0;
  Tally beyond;  ///< pixels off by more than the bound there
};

void measure(const PlanesRig& array, const ScreenPlane& plane, unsigned fraction, const std::string& name, Error& error) {
  const Field front = array.draw({array.stream(plane, fraction)}, array.layout().front);
  ExactPlane exact(plane);
  for (int y = 0; y < PlanesRig::kSide; ++y)
    for (int x = 0; x < PlanesRig::kSide; ++x) {
      const double z = static_cast<double>(exact.floor32(x, y)) * 0x1p-32;
      const double got = front[static_cast<std::size_t>(y) * PlanesRig::kSide + x];
      const double off = std::max({got - z, z - (got + 1), 0.0}), slack = stream_slack(plane, fraction, x, y) + 0x1p-32;
      error.units = std::max(error.units, off), error.bound = std::max(error.bound, slack);
      if (off > slack)
        error.beyond.fault(fmt::format("{}: pixel ({}, {}) holds {}, {:.6f} away from {:.6f}; {:.6f} are possible", name,
                                       x, y, got, off, z, slack));
    }
}

}  // namespace

stability::Result planes_fraction(const stability::Rig& rig, std::uint64_t seed) {
  const PlanesRig array(rig, kBits);
  stability::Result result;
  stability::Curve curve{"N-P2",
                         "Error of depth on a 512 x 512 array",
                         {"fraction bits", "measured, depth units", "bound", "1023 / 2^(f+1)"},
                         {},
                         true,
                         "units of depth"};
  for (unsigned fraction = kFewest; fraction <= kMost; ++fraction) {
    std::mt19937_64 random(seed);
    Error error;
    for (int i = 0; i <= kRandomPlanes; ++i)
      measure(array, i == 0 ? worst_plane(random, fraction) : random_plane(random), fraction,
              fmt::format("{} fraction bits, plane {}, seed {}", fraction, i + 1, seed), error);
    const double rule = std::ldexp(1023.0, -static_cast<int>(fraction) - 1);
    curve.rows.push_back({double(fraction), error.units, error.bound, rule});
    result.rows.push_back({"N-P2", fmt::format("{} fraction bits: largest error of depth", fraction), error.units,
                           error.bound, "depth units", "gmp", Bound::kAtMost, error.beyond.first});
    result.rows.push_back({"N-P2", fmt::format("{} fraction bits: pixels beyond the bound at their place", fraction),
                           static_cast<double>(error.beyond.count), 0, "pixels", "gmp", Bound::kAtMost,
                           error.beyond.first});
    if (fraction + 1 == PlanesRig::kFraction)
      result.rows.push_back({"N-P2", fmt::format("{} fraction bits are too few for half a unit", fraction), error.units,
                             0.5, "depth units", "gmp", Bound::kMoreThan, ""});
    if (fraction == PlanesRig::kFraction)
      result.rows.push_back({"N-P2", fmt::format("{} fraction bits, the firmware's: half a unit", fraction), error.units,
                             0.5 + 0x1p-8, "depth units", "gmp", Bound::kAtMost, error.beyond.first});
  }
  result.curves.push_back(curve);
  return result;
}

}  // namespace dendro::half_space
