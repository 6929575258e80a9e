#include "firmware/half_space/stability/width.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

// N-A4. Each bit halves the loss.

namespace dendro::half_space {
namespace {

using stability::Bound;

constexpr int kWidths[] = {6, 8, 10, 12, 16, 24};
constexpr int kMachineBits = 12;  ///< two registers fit into a 24-bit pixel up to here
constexpr int kHulls = 12;
constexpr double kRadius = 80;  ///< pixels, and units of length along z
constexpr double kSideways = (kWidthSide - 1) / 2.0;

void measure(const stability::Rig& rig, const Prepared& prepared, int bits, const std::string& name,
             Loss& loss) {
  Enclosure enclosure(prepared);
  Words words;
  if (bits <= kMachineBits) words = draw(rig, prepared);
  for (int y = 0; y < kWidthSide; ++y)
    for (int x = 0; x < kWidthSide; ++x) {
      const Thickness at = thickness(
          prepared.screen, [&](std::size_t k) { return enclosure.plane(k).floor32(x, y); },
          [&](std::size_t k) { return enclosure.slack(k, x, y); });
      std::optional<bool> shown;
      if (!words.empty()) shown = face_of(words[static_cast<std::size_t>(y) * kWidthSide + x]) != 0;
      loss.count(name, x, y, at, shown);
    }
}

double per_million(std::int64_t pixels) {
  return 1e6 * static_cast<double>(pixels) / (double(kHulls) * kWidthFrame * kWidthFrame);
}

}  // namespace

std::vector<ScreenPlane> width_hull(std::mt19937_64& random) {
  scene::Scene scene = looking_at(random_solid(random, "icosahedron"), kWidthSide, kWidthSide / kRadius);
  std::uniform_real_distribution<double> shift(-0.5, 0.5);
  for (double& v : scene.objects[0].at) v = shift(random) / kRadius;
  const Prepared prepared = prepare(scene);
  std::vector<ScreenPlane> planes;
  for (std::size_t k = 0; k < prepared.world.size(); ++k) {
    const scene::HalfSpace& p = prepared.world[k];  // seen along -z
    const double a = p.normal.x, b = -p.normal.y, c = -p.normal.z;
    planes.push_back({a, b, c, -(p.offset * kRadius + (a + b) * kSideways + c * kWidthFrame / 2.0)});
  }
  return planes;
}

Prepared at_width(std::vector<ScreenPlane> planes, int bits) {
  for (ScreenPlane& plane : planes) plane.c *= kWidthFrame / std::ldexp(1.0, bits);
  // The records of widths that no machine has are never drawn.
  return from_screen(planes, kWidthSide, kWidthSide, SteepPolicy::kWide, (1 << bits) - 1);
}

void Loss::count(const std::string& name, int x, int y, const Thickness& at, std::optional<bool> shown) {
  constexpr std::int64_t kStep = std::int64_t{1} << 32;
  const std::int64_t thick = at.value();
  const bool is_covered = thick > 0, quantised = at.front >> 32 < at.back >> 32;
  const auto place = [&] {
    return fmt::format("{}: pixel ({}, {}), thickness {:.6f} steps", name, x, y,
                       static_cast<double>(thick) * 0x1p-32);
  };
  covered += is_covered;
  if (is_covered && thick < kStep + 2 * at.slack) ++thin;
  if (is_covered && !quantised) ++lost;
  if (is_covered != quantised && !(is_covered && thick < kStep)) unexplained.fault(place());
  if (!shown) return;
  if (is_covered && !*shown) ++machine;
  const bool explained = is_covered ? thick < kStep + 2 * at.slack : thick > -2 * at.slack;
  if (is_covered != *shown && !explained) machine_unexplained.fault(place());
}

stability::Result register_width(const stability::Rig& rig, std::uint64_t seed) {
  stability::Result result;
  stability::Curve curve{"N-A4",
                         "Pixels lost at the silhouette, 160-pixel hulls in a range of 512",
                         {"bits of the depth register", "exact planes (per 1e6)", "machine (per 1e6)",
                          "thinner than a step (per 1e6)", "exact planes (per 1e6 covered)"},
                         {},
                         true,
                         "pixels lost per 1e6"};
  std::vector<double> measured;
  for (const int bits : kWidths) {
    std::mt19937_64 random(seed);
    Loss loss;
    for (int i = 0; i < kHulls; ++i)
      measure(rig, at_width(width_hull(random), bits), bits,
              fmt::format("{} bits, hull {} of seed {}", bits, i + 1, seed), loss);
    measured.push_back(per_million(loss.lost));
    const bool on_machine = bits <= kMachineBits;
    curve.rows.push_back({double(bits), per_million(loss.lost), on_machine ? per_million(loss.machine) : NAN,
                          per_million(loss.thin),
                          1e6 * static_cast<double>(loss.lost) / static_cast<double>(loss.covered)});
    result.rows.push_back({"N-A4",
                           fmt::format("{} bits: pixels lost; the bound are those thinner than a step", bits),
                           per_million(on_machine ? loss.machine : loss.lost), per_million(loss.thin),
                           "pixels per 1e6", "gmp", Bound::kAtMost, ""});
    const Tally& odd = on_machine ? loss.machine_unexplained : loss.unexplained;
    result.rows.push_back({"N-A4",
                           fmt::format("{} bits: pixels lost or gained that are not thinner than a step{}",
                                       bits, on_machine ? ", machine" : ", quantised planes"),
                           static_cast<double>(odd.count + loss.unexplained.count), 0, "pixels", "gmp",
                           Bound::kAtMost, odd.count > 0 ? odd.first : loss.unexplained.first});
  }
  const double factor = std::pow(measured[0] / std::max(measured[3], 1e-9), 1.0 / (kWidths[3] - kWidths[0]));
  result.rows.push_back(
      {"N-A4", fmt::format("loss per bit from 6 to 12 bits falls by {:.3f}: distance from 2", factor),
       std::abs(factor - 2), 0.1, "", "halves per bit", Bound::kAtMost, ""});
  result.curves.push_back(curve);
  return result;
}

}  // namespace dendro::half_space
