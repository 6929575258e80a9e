#pragma once

#include <cstdint>
#include <vector>

namespace dendro::adaptive_equalisation {

/// For every pixel the number of pixels of its contextual region that are darker, in integers and by the definition: the region
/// of `region` x `region` pixels has the pixel at its middle (region / 2 before it) and is moved into the picture at its borders.
std::vector<std::uint32_t> ranks(const std::vector<std::uint16_t>& grey, int width, int height, int region);

}  // namespace dendro::adaptive_equalisation
