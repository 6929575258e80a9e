#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "firmware/half_space/pixel_planes/prepare_planes.h"
#include "firmware/half_space/stability/support.h"

namespace dendro::half_space {

/// The values of a depth field on the whole array, row by row.
using Field = std::vector<std::uint32_t>;

/// A pixel array of 512 x 512 with its shipped micro-programs.
class PlanesRig {
 public:
  static constexpr int kSide = 512;
  static constexpr unsigned kFraction = 10;  ///< of the shipped firmware on this array

  /// The memory grows beyond the machine's where three depths of so many bits and a colour need it.
  PlanesRig(const stability::Rig& rig, unsigned depth_bits);

  const PixelLayout& layout() const { return layout_; }
  std::uint32_t most() const { return (std::uint32_t{1} << layout_.depth_bits) - 1; }

  /// The plane as the firmware streams it.
  StreamPlane stream(const ScreenPlane& plane, unsigned fraction = kFraction) const;

  /// Draws the planes as one hull; the field whose lowest bit is `low` (layout().front, back or nearest) after it.
  Field draw(const std::vector<StreamPlane>& planes, unsigned low) const;

 private:
  std::unique_ptr<stability::Rig> rig_;
  PixelLayout layout_;
  ArraySite site_;
};

/// A coefficient as the translator must make it: times 2^fraction, rounded to nearest, ties to even.
std::int64_t exact_coefficient(float value, unsigned fraction);

/// The streamed expression in exact integers, without its fraction: floor((A x + B y + C) / 2^fraction).
class ExactStream {
 public:
  explicit ExactStream(const StreamPlane& plane);

  std::int64_t floor(int x, int y) const { return (a_ * x + b_ * y + c_) >> fraction_; }
  /// Fewest guard bits with which every pixel of the array has its value, of `depth_bits` + guard bits.
  unsigned guard(unsigned depth_bits) const;

 private:
  std::int64_t a_, b_, c_;
  unsigned fraction_;
};

/// A front or back plane z = a x + b y + c.
ScreenPlane plane_of(PlaneKind kind, double a, double b, double c);

/// The most by which a streamed depth, before its fraction is cut off, differs from the real plane's at (x, y), in units
/// of depth: each of three coefficients is off by half a step of its fraction, and by half a step of single precision.
double stream_slack(const ScreenPlane& plane, unsigned fraction, int x, int y);

}  // namespace dendro::half_space
