#pragma once

#include <cstdint>
#include <vector>

#include "firmware/half_space/host/colour_program.h"

namespace dendro::half_space {

/// A coordinate in 16.16 texels of the level after `x` steps right, `y` down and depth `z`, modulo 2^32.
std::uint32_t texel_coordinate(const Colouring& colouring, unsigned axis, int x, int y, int z);

/// S10 and S11 on integers: `frame` holds the 512 x 512 pixel words, the cube's bytes among them. What
/// colour.gia must leave there, bit for bit.
void colour_model(const Colouring& colouring, std::vector<std::uint32_t>& frame);

}  // namespace dendro::half_space
