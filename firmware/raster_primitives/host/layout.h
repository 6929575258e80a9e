#pragma once

namespace dendro::raster_primitives {

/// Where the fields of a pixel lie in its memory.
struct Layout {
  unsigned depth_bits = 16;
  unsigned depth = 0;
  unsigned flag = 16;
  unsigned colour = 17;  ///< 24 bits
  unsigned seen = 41;    ///< spheres, shadows
  unsigned square = 42;  ///< spheres
  unsigned square_bits = 0;

  explicit Layout(unsigned bits = 16) : depth_bits(bits), flag(bits), colour(bits + 1), seen(bits + 25), square(bits + 26) {}

  unsigned used() const { return square_bits > 0 ? square + square_bits : colour + 24; }
};

}  // namespace dendro::raster_primitives
