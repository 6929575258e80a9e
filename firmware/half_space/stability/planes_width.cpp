#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "firmware/half_space/stability/planes_support.h"
#include "firmware/half_space/stability/width.h"

// N-P4. The hulls of N-A4 in depth fields of 12 to 24 bits. A pixel may be lost, or gained, only where the hull is thinner
// than a step with the bound of N-P2 on both sides. From about 20 bits on it is single precision that sets the bound.

namespace dendro::half_space {
namespace {

using stability::Bound;

constexpr unsigned kWidths[] = {12, 14, 16, 18, 20, 22, 24};
constexpr int kHulls = 8;
constexpr double kUnit = 4294967296.0;  // 2^32

/// A hull whose planes all go into a stream; with nearly no seed has it to be drawn twice.
std::optional<std::vector<StreamPlane>> streams_of(const PlanesRig& array, const std::vector<ScreenPlane>& planes) {
  std::vector<StreamPlane> streams;
  for (const PlaneKind kind : {PlaneKind::kBack, PlaneKind::kFront})
    for (const ScreenPlane& plane : planes) {
      if (plane.kind != kind) continue;
      streams.push_back(array.stream(plane));
      if (streams.back().kind != kind) return std::nullopt;
    }
  return streams;
}

struct Measured {
  Loss loss;
  Tally depths;         ///< depths of covered pixels beyond the bound
  double error = 0, bound = 0;
};

void measure(const PlanesRig& array, const std::vector<ScreenPlane>& planes, const std::vector<StreamPlane>& streams,
             const std::string& name, Measured& out) {
  const Field nearest = array.draw(streams, array.layout().nearest);
  std::vector<ExactPlane> exact(planes.begin(), planes.end());
  for (int y = 0; y < kWidthSide; ++y)
    for (int x = 0; x < kWidthSide; ++x) {
      const Thickness at = thickness(
          planes, [&](std::size_t k) { return exact[k].floor32(x, y); },
          [&](std::size_t k) {
            return static_cast<std::int64_t>(std::ceil(stream_slack(planes[k], PlanesRig::kFraction, x, y) * kUnit)) + 1;
          });
      const std::uint32_t got = nearest[static_cast<std::size_t>(y) * PlanesRig::kSide + x];
      const bool shown = got != array.most();
      out.loss.count(name, x, y, at, shown);
      if (!shown || at.value() <= 0) continue;
      const double z = static_cast<double>(at.front) / kUnit, slack = static_cast<double>(at.slack) / kUnit;
      const double off = std::max({got - z, z - (got + 1.0), 0.0});
      out.error = std::max(out.error, off), out.bound = std::max(out.bound, slack);
      if (off > slack)
        out.depths.fault(fmt::format("{}: pixel ({}, {}) holds {}, {:.6f} away from {:.6f}", name, x, y, got, off, z));
    }
}

double per_million(std::int64_t pixels) {
  return 1e6 * static_cast<double>(pixels) / (double(kHulls) * kWidthFrame * kWidthFrame);
}

}  // namespace

stability::Result planes_width(const stability::Rig& rig, std::uint64_t seed) {
  stability::Result result;
  stability::Curve curve{"N-P4",
                         "Pixels lost at the silhouette, 160-pixel hulls, Pixel-Planes",
                         {"bits of the depth field", "exact planes (per 1e6)", "machine (per 1e6)",
                          "thinner than a step (per 1e6)"},
                         {},
                         true,
                         "pixels lost per 1e6"};
  stability::Curve errors{"N-P4-depth", "Error of depth on the same hulls, 10 fraction bits",
                          {"bits of the depth field", "measured", "bound"}, {}, true, "units of depth"};
  for (const unsigned bits : kWidths) {
    const PlanesRig array(rig, bits);
    std::mt19937_64 random(seed);
    Measured m;
    for (int i = 0; i < kHulls; ++i) {
      std::vector<ScreenPlane> planes;
      std::optional<std::vector<StreamPlane>> streams;
      while (!streams) {
        planes = at_width(width_hull(random), static_cast<int>(bits)).screen;
        streams = streams_of(array, planes);
      }
      measure(array, planes, *streams, fmt::format("{} bits, hull {} of seed {}", bits, i + 1, seed), m);
    }
    curve.rows.push_back({double(bits), per_million(m.loss.lost), per_million(m.loss.machine), per_million(m.loss.thin)});
    errors.rows.push_back({double(bits), m.error, m.bound});
    const auto row = [&](const std::string& what, double measured, double bound, const char* unit, const Tally& tally) {
      result.rows.push_back({"N-P4", fmt::format("{} bits: {}", bits, what), measured, bound, unit, "gmp", Bound::kAtMost,
                             tally.first});
    };
    row("pixels lost; the bound are those thinner than a step", per_million(m.loss.machine), per_million(m.loss.thin),
        "pixels per 1e6", m.loss.machine_unexplained);
    row("pixels lost or gained that are not thinner than a step", static_cast<double>(m.loss.machine_unexplained.count), 0,
        "pixels", m.loss.machine_unexplained);
    row("largest error of depth", m.error, m.bound, "depth units", m.depths);
    row("depths beyond the bound at their place", static_cast<double>(m.depths.count), 0, "pixels", m.depths);
  }
  result.curves = {curve, errors};
  return result;
}

}  // namespace dendro::half_space
