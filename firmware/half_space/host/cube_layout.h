#pragma once

#include <cstdint>
#include <vector>

namespace dendro::half_space {

/// One level of the texture cube: 2^bits texels a side, 4 bytes a texel in consecutive pixels. Texel (x, y,
/// z) begins at pixel base + ((x + (y << bits) + (z << 2 bits)) << 2), whose column is the low 9 bits and row
/// the rest [FG86 3].
struct CubeLevel {
  unsigned bits = 0;
  std::uint32_t base = 0;  ///< pixels from the frame buffer's first
  unsigned byte = 0;       ///< byte plane of the pixels: 0 red, 1 green, 2 blue, 3 the spare one
  std::uint32_t pixels() const { return 4u << 3 * bits; }
};

/// Where the cube and its MIP levels lie in a 512 x 512 frame buffer, the finest first.
struct CubeLayout {
  bool wide = false;  ///< true: in the fourth byte of 32-bit pixels; false: in lines 256-511 of 24-bit ones
  std::vector<CubeLevel> levels;
  unsigned bits() const { return levels.front().bits; }
};

constexpr int kHalfPictureLines =
    256;  ///< lines that the narrow layout leaves to the picture  ASSUMED DEV-048

/// bits: 1..5. Wide: all levels one after another from pixel 0 [FG86 3]. Else: the finest in the red byte of
/// the lower half, the others in its green byte (FG86-K16, `half`).  ASSUMED DEV-048
CubeLayout cube_layout(unsigned bits, bool wide);

}  // namespace dendro::half_space
