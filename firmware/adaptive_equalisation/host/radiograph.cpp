#include "firmware/adaptive_equalisation/host/radiograph.h"

#include <algorithm>
#include <cmath>

namespace dendro::adaptive_equalisation {
namespace {

std::uint64_t mix(std::uint64_t value) {
  value += 0x9E3779B97F4A7C15;
  value = (value ^ value >> 30) * 0xBF58476D1CE4E5B9;
  value = (value ^ value >> 27) * 0x94D049BB133111EB;
  return value ^ value >> 31;
}

/// 0..1, the same for the same numbers.
double unit(std::uint64_t seed, std::uint64_t number) {
  return static_cast<double>(mix(seed ^ mix(number)) >> 11) / 9007199254740992.0;
}

/// 1 inside an ellipse, 0 outside, a soft edge between.
double ellipse(double x, double y, double rx, double ry, double edge) {
  const double distance = std::sqrt(x * x / (rx * rx) + y * y / (ry * ry));
  const double t = std::clamp((1 + edge - distance) / (2 * edge), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// A smooth bump of height 1 and half width 1.
double bump(double t) {
  const double s = std::max(0.0, 1 - t * t / 4);
  return s * s * s;
}

struct Nodule {
  double x, y, radius, contrast;
};

class Chest {
 public:
  explicit Chest(std::uint64_t seed) : seed_(seed) {
    for (std::uint64_t n = 0; n < 28; ++n)
      nodules_.push_back({-0.75 + 1.5 * unit(seed, 8 * n), -0.7 + 1.4 * unit(seed, 8 * n + 1), 0.012 + 0.03 * unit(seed, 8 * n + 2),
                          0.015 + 0.03 * unit(seed, 8 * n + 3)});
  }

  /// Share of the rays that is stopped at (x, y), -1..1, y down.
  double operator()(double x, double y) const {
    const double body = ellipse(x, y - 0.25, 0.92, 1.25, 0.06);
    const double lungs = std::max(ellipse(std::abs(x) - 0.42, y + 0.05, 0.3, 0.62, 0.12), 0.0);
    double stopped = body * (0.80 - 0.62 * lungs);
    stopped += 0.16 * body * bump(x / 0.07) * (0.85 + 0.15 * bump(std::fmod(std::abs(y) * 7, 1.0) * 4 - 2));
    stopped += 0.30 * lungs * ellipse(x - 0.12, y - 0.25, 0.3, 0.3, 0.25);
    stopped += body * ribs(x, y) + vessels(x, y) * lungs;
    for (const Nodule& n : nodules_) {
      const double d = std::sqrt((x - n.x) * (x - n.x) + (y - n.y) * (y - n.y)) / n.radius;
      stopped += body * n.contrast * bump(d);
    }
    return std::clamp(stopped, 0.0, 1.0);
  }

 private:
  /// Arcs on both sides, faint.
  static double ribs(double x, double y) {
    const double u = std::abs(x), arc = y + 0.9 * (u - 0.45) * (u - 0.45) - 0.12 * u;
    const double place = (arc + 0.9) / 0.19, nearest = std::floor(place + 0.5);
    if (nearest < 1 || nearest > 8 || u < 0.08 || u > 0.86) return 0;
    return 0.05 * bump((place - nearest) / 0.16);
  }

  /// Branches that leave the middle.
  double vessels(double x, double y) const {
    double sum = 0;
    for (std::uint64_t n = 0; n < 12; ++n) {
      const double slope = -1.4 + 2.8 * unit(seed_, 1000 + n), bend = -1.2 + 2.4 * unit(seed_, 2000 + n);
      const double side = n % 2 == 0 ? 1 : -1, u = side * x - 0.1;
      if (u < 0 || u > 0.6) continue;
      const double off = y - (0.05 + slope * u + bend * u * u), width = 0.012 * (1 - u / 0.65);
      sum += 0.05 * (1 - u / 0.6) * bump(off / width);
    }
    return sum;
  }

  std::uint64_t seed_;
  std::vector<Nodule> nodules_;
};

}  // namespace

std::vector<std::uint16_t> radiograph(int width, int height, unsigned bits, std::uint64_t seed) {
  const Chest chest(seed);
  const double most = std::ldexp(1.0, static_cast<int>(bits)) - 1;
  std::vector<std::uint16_t> picture;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto number = static_cast<std::uint64_t>(y) * 65536 + static_cast<std::uint64_t>(x);
      double grain = -2;
      for (std::uint64_t k = 0; k < 4; ++k) grain += unit(seed + 77, 4 * number + k);
      const double passed = 1 - chest((x + 0.5) / width * 2 - 1, (y + 0.5) / height * 2 - 1);
      const double value = most * (0.03 + 0.94 * passed * passed) + most * 0.004 * grain;
      picture.push_back(static_cast<std::uint16_t>(std::clamp(std::floor(value + 0.5), 0.0, most)));
    }
  return picture;
}

}  // namespace dendro::adaptive_equalisation
