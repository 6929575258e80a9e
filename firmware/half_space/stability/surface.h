#pragma once

#include <array>
#include <string>
#include <vector>

#include "firmware/half_space/host/colour_program.h"
#include "firmware/half_space/stability/support.h"

// What the cases of the textured surface share: a cube whose texels hold their own indices, so that a
// coloured pixel shows which texel it took.

namespace dendro::half_space {

constexpr int kFrameSide = 512;  ///< pixels of the image memory

/// Where a pixel landed in the cube.
using Texel = std::array<std::uint32_t, 3>;

inline Texel texel_of(std::uint32_t word) { return {word & 0xFF, word >> 8 & 0xFF, word >> 16 & 0xFF}; }

std::string name_of(const Texel& texel);

/// One picture that colour.gia has drawn over a cube of indices.
struct IndexPicture {
  Words words;                        ///< of the picture, rows top down
  std::vector<std::uint32_t> line_q;  ///< the program's own coordinates below the last line
  std::vector<std::uint32_t> depths;  ///< its table: three words a depth
};

/// `nearest`: a depth a pixel of the picture, rows top down. The cube's level must lie below the picture.
IndexPicture draw_indices(const stability::Rig& rig, const Colouring& colouring,
                          const std::vector<int>& nearest);

}  // namespace dendro::half_space
