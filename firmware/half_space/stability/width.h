#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "firmware/half_space/stability/support.h"

// What the cases of register width share: a hull 160 pixels wide in a depth range of 512 pixels. A pixel that the real
// hull covers is lost when both its depths fall into one step of the register.

namespace dendro::half_space {

constexpr int kWidthFrame = 512, kWidthSide = 176;  ///< the hull lies inside the side; the rest of the frame is empty

/// An icosahedron turned and moved at random, with depth in pixels from 0 to 512.
std::vector<ScreenPlane> width_hull(std::mt19937_64& random);

/// The same hull in units of a register of `bits`.
Prepared at_width(std::vector<ScreenPlane> planes, int bits);

/// A pixel of the real hull; in 2^-32 of a step.
struct Thickness {
  std::int64_t front = 0, back = INT64_MAX, slack = 0;

  std::int64_t value() const { return back - front; }
};

/// From each plane's exact value and the most that the machine may be off there.
template <class Value, class Slack>
Thickness thickness(const std::vector<ScreenPlane>& screen, const Value& value32, const Slack& slack32) {
  Thickness at;
  for (std::size_t k = 0; k < screen.size(); ++k) {
    const std::int64_t z = value32(k), off = slack32(k);
    const bool back = screen[k].kind == PlaneKind::kBack;
    if (back ? z < at.back : z > at.front) (back ? at.back : at.front) = z;
    if (off > at.slack) at.slack = off;
  }
  return at;
}

struct Loss {
  std::int64_t lost = 0;     ///< covered in rationals, not in the register
  std::int64_t thin = 0;     ///< covered in rationals and thinner than a step, with the slack on both sides
  std::int64_t machine = 0;  ///< lost by the machine
  std::int64_t covered = 0;  ///< by the real hull
  Tally unexplained;         ///< lost although thicker, or gained
  Tally machine_unexplained;

  /// `shown`: what the machine made of it, if it was drawn.
  void count(const std::string& name, int x, int y, const Thickness& at, std::optional<bool> shown);
};

}  // namespace dendro::half_space
