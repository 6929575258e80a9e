#include "firmware/raster_primitives/host/sphere_setup.h"

#include <algorithm>
#include <cmath>

#include "sim/base/check.h"

namespace dendro::raster_primitives {
namespace {

unsigned bits_of(std::int64_t value) {
  unsigned bits = 0;
  while (value >> bits != 0) ++bits;
  return bits;
}

/// Beyond the end of the byte's margin a sum that is too large would show as black.
constexpr double kMostExcess = 2;

}  // namespace

std::vector<Digit> digits_of(double value, int most, int lowest, bool towards_zero) {
  std::vector<Digit> digits;
  double rest = value;
  while (static_cast<int>(digits.size()) < most && rest != 0) {
    int exponent = 0;
    const double mantissa = std::frexp(std::abs(rest), &exponent);  // 1/2 <= mantissa < 1
    // A later digit takes back what an earlier one is too large; the last one has none behind it.
    bool up = mantissa > 0.75;
    if (towards_zero && static_cast<int>(digits.size()) + 1 == most) up = rest * value < 0 && mantissa > 0.5;
    const int shift = up ? exponent : exponent - 1;
    if (shift < lowest) break;
    digits.push_back({rest > 0 ? 1 : -1, shift});
    rest -= std::ldexp(rest > 0 ? 1.0 : -1.0, shift);
  }
  return digits;
}

double value_of(const std::vector<Digit>& digits) {
  double sum = 0;
  for (const Digit& digit : digits) sum += std::ldexp(digit.sign, digit.shift);
  return sum;
}

SphereSetup set_up(const ScreenSphere& sphere, int most_digits, const TriangleRules& rules) {
  SphereSetup out;
  const double x = std::round(2 * sphere.x) / 2, y = std::round(2 * sphere.y) / 2, square = sphere.radius * sphere.radius;
  out.a = std::llround(2 * x), out.b = std::llround(2 * y);
  out.c = std::llround(square - x * x - y * y);
  out.bits = bits_of(static_cast<std::int64_t>(square) + 2);
  out.depth = std::llround(sphere.depth);
  const int lowest = 1 - static_cast<int>(out.bits);
  out.bulge = digits_of(sphere.depth_radius / square, most_digits, lowest, false);
  for (std::size_t k = 0; k < 3; ++k) {
    const double slope = sphere.swing[k] / sphere.radius, shine = sphere.swing[k] * sphere.light[2] / square;
    out.shine[k] = digits_of(shine, most_digits, lowest, false);
    if ((std::abs(value_of(out.shine[k])) - std::abs(shine)) * square > kMostExcess)
      out.shine[k] = digits_of(shine, most_digits, lowest, true);
    double cut = 0;  // half a unit is lost where a copy is cut off on its right
    for (const Digit& digit : out.shine[k]) cut += digit.shift < 0 ? 0.5 * digit.sign : 0;
    Stream& stream = out.colour[k];
    stream.fraction = rules.fraction;
    const double a = slope * sphere.light[0], b = slope * sphere.light[1];
    stream.at.a = static_cast<float>(a), stream.at.b = static_cast<float>(b);
    stream.at.c = static_cast<float>(sphere.level[k] - a * x - b * y + 0.5 + cut);
  }
  return out;
}

std::uint64_t flops_of(const SphereSetup& sphere) {
  std::size_t digits = sphere.bulge.size();
  for (const auto& part : sphere.shine) digits += part.size();
  return kFlopsSphereScreen + kFlopsCircle + kFlopsSphereLevels + kFlopsSphereColour + kFlopsDigit * digits;
}

void SphereSender::load_squares(int width, int height) {
  driver_.run("clear_square");
  for (const bool down : {false, true})
    for (unsigned k = 0; 1 << k < (down ? height : width); ++k) {
      const auto along = [down](float slope) { return down ? lib::Expression{0, slope, 0} : lib::Expression{slope, 0, 0}; };
      driver_.run("select_bit", along(std::ldexp(1.0f, -static_cast<int>(k))), k, 0);
      driver_.run("subtract_square", along(std::ldexp(1.0f, static_cast<int>(k))), 0, 0);
    }
  a_ = b_ = c_ = 0;
}

void SphereSender::send(const SphereSetup& sphere) {
  const lib::Expression change = {static_cast<float>(sphere.a - a_), static_cast<float>(sphere.b - b_),
                                  static_cast<float>(sphere.c - c_)};
  DENDRO_CHECK(static_cast<std::int64_t>(change.c) == sphere.c - c_);
  a_ = sphere.a, b_ = sphere.b, c_ = sphere.c;
  driver_.run("circle", change, 0, 0);
  for (const Digit& digit : sphere.bulge) copy(digit, 1, layout_.depth, layout_.depth_bits, sphere.bits);
  driver_.run("sphere_depth", {0, 0, static_cast<float>(sphere.depth)}, 0, 0);
  for (const Digit& digit : sphere.bulge) copy(digit, -1, layout_.depth, layout_.depth_bits, sphere.bits);
  driver_.run("keep_seen");
  const char* const names[] = {"red", "green", "blue"};
  for (unsigned k = 0; k < 3; ++k) {
    raster_primitives::send(driver_, names[k], sphere.colour[k]);
    for (const Digit& digit : sphere.shine[k]) copy(digit, 1, layout_.colour + 8 * k, 8, sphere.bits);
  }
}

void SphereSender::copy(const Digit& digit, int sign, unsigned field, unsigned field_bits, unsigned square_bits) {
  const int left = std::max(0, digit.shift), right = std::max(0, -digit.shift);
  const int room = static_cast<int>(field_bits) - left;
  const int turns = std::min(static_cast<int>(square_bits) - right, room);
  if (turns <= 0) return;
  driver_.set_register("from", layout_.square + static_cast<unsigned>(right));
  driver_.set_register("to", field + static_cast<unsigned>(left));
  driver_.set_register("turns", static_cast<unsigned>(turns));
  driver_.set_register("above", field + static_cast<unsigned>(left + turns));
  driver_.set_register("above_bits", static_cast<unsigned>(room - turns));
  driver_.run(digit.sign * sign > 0 ? "add_copy" : "subtract_copy");
}

}  // namespace dendro::raster_primitives
