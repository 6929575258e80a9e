#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/half_space/stability/support.h"

// N-A4. A hull 160 pixels wide in a depth range of 512 pixels. A pixel that the real hull covers is lost when
// both its depths fall into one step of the register; so each bit halves the loss.

namespace dendro::half_space {
namespace {

using stability::Bound;

constexpr int kWidths[] = {6, 8, 10, 12, 16, 24};
constexpr int kMachineBits = 12;  ///< two registers fit into a 24-bit pixel up to here
constexpr int kHulls = 12;
constexpr int kFrame = 512, kSide = 176;  ///< the hull lies inside kSide; the rest of the frame is empty
constexpr double kRadius = 80;            ///< pixels, and units of length along z
constexpr double kSideways = (kSide - 1) / 2.0;

/// The icosahedron with depth in pixels from 0 to 512.
std::vector<ScreenPlane> hull(std::mt19937_64& random) {
  scene::Scene scene = looking_at(random_solid(random, "icosahedron"), kSide, kSide / kRadius);
  std::uniform_real_distribution<double> shift(-0.5, 0.5);
  for (double& v : scene.objects[0].at) v = shift(random) / kRadius;
  const Prepared prepared = prepare(scene);
  std::vector<ScreenPlane> planes;
  for (std::size_t k = 0; k < prepared.world.size(); ++k) {
    const scene::HalfSpace& p = prepared.world[k];  // seen along -z
    const double a = p.normal.x, b = -p.normal.y, c = -p.normal.z;
    planes.push_back({a, b, c, -(p.offset * kRadius + (a + b) * kSideways + c * kFrame / 2.0)});
  }
  return planes;
}

/// The same hull in units of a register of `bits`.
Prepared at_width(std::vector<ScreenPlane> planes, int bits) {
  for (ScreenPlane& plane : planes) plane.c *= kFrame / std::ldexp(1.0, bits);
  // The records of widths that no machine has are never drawn.
  return from_screen(planes, kSide, kSide, SteepPolicy::kWide, (1 << bits) - 1);
}

struct Loss {
  std::int64_t lost = 0;  ///< covered in rationals, not in the register
  std::int64_t thin =
      0;  ///< covered in rationals and thinner than a step, with the bound of N-A2 on both sides
  std::int64_t machine = 0;  ///< lost by the machine
  std::int64_t covered = 0;  ///< by the real hull
  Tally unexplained;         ///< lost although thicker, or gained
  Tally machine_unexplained;
};

/// Covered by the real hull; its thickness in 2^-32 of a step.
std::int64_t thickness(Enclosure& enclosure, const Prepared& prepared, int x, int y, std::int64_t& front,
                       std::int64_t& back, std::int64_t& slack) {
  front = 0, back = INT64_MAX, slack = 0;
  for (std::size_t k = 0; k < prepared.screen.size(); ++k) {
    const std::int64_t z = enclosure.plane(k).floor32(x, y);
    const bool is_back = prepared.screen[k].kind == PlaneKind::kBack;
    if (is_back ? z < back : z > front) (is_back ? back : front) = z;
    slack = std::max(slack, enclosure.slack(k, x, y));
  }
  return back - front;
}

void count_pixel(const std::string& name, int x, int y, const Words* words, std::int64_t thick,
                 std::int64_t front, std::int64_t back, std::int64_t slack, Loss& loss) {
  constexpr std::int64_t kStep = std::int64_t{1} << 32;
  const bool covered = thick > 0, quantised = front >> 32 < back >> 32;
  const auto place = [&] {
    return fmt::format("{}: pixel ({}, {}), thickness {:.6f} steps", name, x, y,
                       static_cast<double>(thick) * 0x1p-32);
  };
  loss.covered += covered;
  if (covered && thick < kStep + 2 * slack) ++loss.thin;
  if (covered && !quantised) ++loss.lost;
  if (covered != quantised && !(covered && thick < kStep)) loss.unexplained.fault(place());
  if (words == nullptr) return;
  const bool shown = face_of((*words)[static_cast<std::size_t>(y) * kSide + x]) != 0;
  if (covered && !shown) ++loss.machine;
  const bool explained = covered ? thick < kStep + 2 * slack : thick > -2 * slack;
  if (covered != shown && !explained) loss.machine_unexplained.fault(place());
}

void measure(const stability::Rig& rig, const Prepared& prepared, int bits, const std::string& name,
             Loss& loss) {
  Enclosure enclosure(prepared);
  Words words;
  if (bits <= kMachineBits) words = draw(rig, prepared);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      std::int64_t front = 0, back = 0, slack = 0;
      const std::int64_t thick = thickness(enclosure, prepared, x, y, front, back, slack);
      count_pixel(name, x, y, words.empty() ? nullptr : &words, thick, front, back, slack, loss);
    }
}

double per_million(std::int64_t pixels) {
  return 1e6 * static_cast<double>(pixels) / (double(kHulls) * kFrame * kFrame);
}

}  // namespace

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
      measure(rig, at_width(hull(random), bits), bits,
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
