#pragma once

namespace dendro::raster_primitives {

/// Bits of S, its sign included, in an array of this size, for spheres whose centre lies at most half the side outside and whose
/// radius is at most the side.
constexpr unsigned square_bits_for(int width, int height) {
  unsigned log = 0;
  while (1 << log < width || 1 << log < height) ++log;
  return 2 * log + 4;
}

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

  bool shadows = false;  ///< the bit `seen` says which pixels are in shadow when all is drawn

  bool has_spheres() const { return square_bits > 0; }
  unsigned used() const { return has_spheres() ? square + square_bits : shadows ? seen + 1 : colour + 24; }
};

}  // namespace dendro::raster_primitives
