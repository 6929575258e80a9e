#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "firmware/raster_primitives/host/layout.h"
#include "firmware/raster_primitives/host/triangle_setup.h"

namespace dendro::raster_primitives {

/// A sphere on the screen. Its shade at the offset (dx, dy) from the centre is level + swing · n·L.
struct ScreenSphere {
  double x = 0, y = 0, radius = 0;           ///< pixels
  double depth = 0, depth_radius = 0;        ///< units, of the centre
  std::array<double, 3> level{}, swing{};    ///< 0..255
  std::array<double, 3> light{};             ///< to the light: right, down, to the viewer; unit
};

/// sign · 2^shift
struct Digit {
  int sign = 1, shift = 0;
};

/// A sphere as it is sent: a paraboloid, whose depth and shade are linear in x, y and S.  ASSUMED DEV-097
/// S = r^2 - d^2 in pixels, with the centre on half pixels and r^2 rounded so that S is whole.
struct SphereSetup {
  std::int64_t a = 0, b = 0, c = 0;  ///< S = a·x + b·y + c - x^2 - y^2
  unsigned bits = 0;                 ///< of the largest S
  std::int64_t depth = 0;            ///< of the centre; the front is less by the sum of the digits' multiples of S
  std::vector<Digit> bulge;
  std::array<Stream, 3> colour;      ///< without the part that goes with S
  std::array<std::vector<Digit>, 3> shine;
};

// Floating-point operations of a sphere, counted from the formulas of set_up().
constexpr std::uint64_t kFlopsSphereScreen = 18 + 2 + 1 + 1;      // centre and depth, both radii
constexpr std::uint64_t kFlopsCircle = 2 * 2 + 5 + 3;             // half pixels, the constant, differences
constexpr std::uint64_t kFlopsSphereLevels = 3 * 4;               // level and swing from the object's colour
constexpr std::uint64_t kFlopsSphereColour = 3 * (1 + 2 + 2 + 4 + 2);  // over r, slopes, constant, factor of S
constexpr std::uint64_t kFlopsDigit = 3;                          // logarithm by exponent, nearest power, remainder

/// Sum of `most` powers of two at most that is nearest to `value`, greedily; with `towards_zero` not beyond it by 2^lowest. Digits
/// below 2^lowest are left out.
std::vector<Digit> digits_of(double value, int most, int lowest, bool towards_zero);

double value_of(const std::vector<Digit>& digits);

SphereSetup set_up(const ScreenSphere& sphere, int most_digits, const TriangleRules& rules);

std::uint64_t flops_of(const SphereSetup& sphere);

/// Sends spheres one after another; the pixels remember the circle of the one before.
class SphereSender {
 public:
  SphereSender(lib::IgcDriver& driver, const Layout& layout) : driver_(driver), layout_(layout) {}

  /// square := -(x^2 + y^2), bit by bit of x and of y: x · x is the sum of 2^k · x over the set bits k of x.
  void load_squares(int width, int height);

  void send(const SphereSetup& sphere);

 private:
  /// Adds or takes away a digit's multiple of S at a field of the pixel; `sign` 1 or -1 turns the digit.
  void copy(const Digit& digit, int sign, unsigned field, unsigned field_bits, unsigned square_bits);

  lib::IgcDriver& driver_;
  Layout layout_;
  std::int64_t a_ = 0, b_ = 0, c_ = 0;  ///< of the circle that the pixels hold
};

}  // namespace dendro::raster_primitives
