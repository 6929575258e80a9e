#pragma once

#include <cstdint>
#include <vector>

#include "firmware/half_space/host/roughen_program.h"

namespace dendro::half_space {

/// The stochastic field in whole depths, row by row, kTileSide a row.
std::vector<int> roughen_tile(const Roughening& roughening);

/// S8 on integers: what roughen.gia must leave in the pixel words of a picture `width` wide, bit for bit.
/// Pixels with front >= back (empty) or back >= maxdepth (unbounded) stay.
void roughen_model(const Roughening& roughening, int width, std::vector<std::uint32_t>& pixels);

}  // namespace dendro::half_space
