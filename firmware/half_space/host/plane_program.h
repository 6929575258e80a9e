#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "firmware/half_space/host/layout.h"

namespace dendro::half_space {

/// The values of bits 0-1 of a record's word 3.
enum class PlaneKind : unsigned { kFront = 0, kBack = 1, kEdgeOn = 2 };

/// What becomes of a plane whose depth leaves 16.16 inside the box [FG86, N-A1].
enum class SteepPolicy { kWide, kSaturate, kWrap };

/// a·x + b·y + c·z + d <= 0 inside, in screen space: x, y in pixels, z in units of the depth register.
struct ScreenPlane {
  double a = 0, b = 0, c = 0, d = 0;
  PlaneKind kind = PlaneKind::kFront;  ///< by the sign of c
  int face = 0;                        ///< front planes: 1, 2, ... in order; others 0
};

/// One plane as the scratchpad holds it. Front and back planes: depth at the first pixel of the first box and
/// its steps; edge-on planes: a·x + b·y + d there and its steps. All with 16 fraction bits.
struct PlaneRecord {
  PlaneKind kind = PlaneKind::kFront;
  bool wide = false;
  int face = 0;
  std::int64_t start = 0, step_x = 0, step_y = 0;

  /// Plain: the low halves of start, step_x, step_y, and the descriptor (kind in bits 0-1, wide in bit 2,
  /// face in bits 8-15). Wide: the same four, then the high halves of the three numbers and a spare word.
  std::vector<std::uint32_t> words() const;
};

/// Pixels x0..x1, y0..y1, both ends included.
struct Box {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  int width() const { return x1 - x0 + 1; }
  int height() const { return y1 - y0 + 1; }
};

using Rgb = std::array<std::uint8_t, 3>;

/// Everything the machine needs for one picture.
struct PlaneProgram {
  int width = 0, height = 0;                      ///< of the picture, pixels
  Box box;                                        ///< the first box
  std::vector<PlaneRecord> back, edge_on, front;  ///< in the order in which they are scanned
  std::vector<Rgb> shades;                        ///< entry 0 the background, entry f the shade of face f
  int maxdepth = 4095;                            ///< 2^bits - 1
  bool boxing = true;
  SteepPolicy steep = SteepPolicy::kWide;

  /// The records of all planes in the order back, edge-on, front.
  std::vector<std::uint32_t> record_words() const;
  std::size_t wide_records() const;
};

/// The record of a plane for a first box (S2). Slopes and start are rounded to the nearest 2^-16. A plane so
/// steep that 48.16 does not hold its depth inside the box becomes edge-on at `middle_depth`: over the whole
/// depth range it moves by less than 2^-32 of a pixel.
PlaneRecord make_record(const ScreenPlane& plane, const Box& box, SteepPolicy steep, double middle_depth);

}  // namespace dendro::half_space
