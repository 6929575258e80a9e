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

  unsigned texture_bits = 0;  ///< of u and of v; 0: no texture
  unsigned texel = 0;         ///< a bit that says whether the pixel shows a texture, u, v; set by place_texture()

  /// Behind all other fields, which must be known.
  void place_texture(unsigned bits) {
    texel = used();
    texture_bits = bits;
  }
  unsigned texel_v() const { return texel + 1 + texture_bits; }

  bool has_spheres() const { return square_bits > 0; }
  unsigned used() const { return texture_bits > 0 ? texel_v() + texture_bits : has_spheres() ? square + square_bits : shadows ? seen + 1 : colour + 24; }
};

}  // namespace dendro::raster_primitives
