#pragma once

#include <cstdint>
#include <vector>

namespace dendro::adaptive_equalisation {

/// A picture like a radiograph of a chest, made from nothing but `seed`: dense parts between nearly black ones, faint ribs, vessels
/// and nodules in both, grain. Values 0..2^bits - 1, rows top down. Additions, products and square roots only, so that it is
/// the same everywhere.
std::vector<std::uint16_t> radiograph(int width, int height, unsigned bits, std::uint64_t seed);

}  // namespace dendro::adaptive_equalisation
