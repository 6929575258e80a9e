#pragma once

#include <gmpxx.h>

#include <cstdint>
#include <string>
#include <vector>

#include "firmware/half_space/host/prepare.h"
#include "firmware/half_space/reference/fixed_point.h"

namespace dendro::half_space {

/// The exact rational value of a plane at a pixel: its depth, or for an edge-on plane a·x + b·y + d with the
/// larger of |a| and |b| scaled to 1. Coefficients are taken as the doubles they are.
class ExactPlane {
 public:
  explicit ExactPlane(const ScreenPlane& plane);

  /// floor(value · 2^32), held within ±2^61.
  std::int64_t floor32(int x, int y);

  /// The record whose three numbers are rounded down to 2^-16 instead of to the nearest: what a host without
  /// rounding would send.
  PlaneRecord truncated(const Box& box) const;

 private:
  mpz_class value_floor(const mpz_class& x, const mpz_class& y, bool constant, unsigned bits) const;

  PlaneKind kind_;
  int face_;
  mpz_class x_, y_, one_, divisor_;  // value = (x_·x + y_·y + one_) / divisor_, divisor_ > 0
  mpz_class x32_, y32_, one32_, work_, quotient_;
};

/// How far the passes may be from exact planes: each of start, step_x and step_y is off by at most this many
/// 2^-17 (1: rounded to nearest, 2: truncated, 0: the planes are exact in 16.16).
enum class Rounding { kNone = 0, kNearest = 1, kTruncated = 2 };

/// All words that the passes may leave in a pixel, from exact rationals and the bound of N-A2: the value of a
/// plane i pixels and j lines from the first pixel of the box is off by at most (i + j + 1) roundings.
class Enclosure {
 public:
  explicit Enclosure(const Prepared& prepared, Rounding rounding = Rounding::kNearest);

  /// Empty when the word is among them, else which plane speaks against it, at which step.
  std::string objection(int x, int y, std::uint32_t word);

  /// True when only one word is possible.
  bool decided(int x, int y);

  /// The bound on a plane's value at a pixel, 2^-32.
  std::int64_t slack(std::size_t plane, int x, int y) const;

  ExactPlane& plane(std::size_t i) { return exact_[i]; }

 private:
  struct Range {
    int low = 0, high = 0;
  };
  struct Pixel {
    Range front, back;
    bool surely_outside = false, maybe_outside = false;
    std::size_t outside = 0, lowest_back = 0, highest_front = 0;  // planes to blame
  };

  Pixel at(int x, int y);
  std::string describe(std::size_t plane, int x, int y);
  std::string object_to_face(int x, int y, int face, int depth);

  const Prepared& prepared_;
  std::int64_t step_slack_;
  std::vector<ExactPlane> exact_;
  std::vector<Range> ranges_;  // of the pixel last looked at
};

/// The words that passes 0 to 4 must leave, from the records as rationals: every value is start + i·step_x +
/// j·step_y by multiplication, every depth its floor. Independent of stepping, boxing and the adders.
std::vector<std::uint32_t> exact_record_words(const PlaneProgram& program);

/// Face number in a pixel's word after pass 4; 0 is background.
inline int face_of(std::uint32_t word) { return static_cast<int>(word >> kFaceLow & kFaceMask); }
inline int depth_of(std::uint32_t word) { return static_cast<int>(word & kFieldMask); }

}  // namespace dendro::half_space
