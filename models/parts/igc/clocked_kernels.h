#pragma once

#include <cstddef>
#include <cstdint>

#include "models/parts/igc/igc_isa.h"

/// What the nodes of a tree's level and the pixels do in one clock, 64 of them in a word. Vectors of the host, chosen at run time.
namespace dendro::igc {

/// One level of the tree. For each of its 64 x `words` nodes: the left child is the input, the right child the sum of
/// input, coefficient and carry, and the carry of that sum is kept. With `clear` the carry counts as 0 before.
struct LevelClock {
  const std::uint64_t* in;
  std::uint64_t *left, *right, *carry;
  std::size_t words;
  bool coefficient, clear;
};
void clock_level(const LevelClock& level);

/// The planes that a word works on. nullptr: a port that is not read, not written, or beyond the memory; no tree bit.
struct PixelClock {
  const std::uint64_t *tree, *read_a, *read_b;
  std::uint64_t *write_a, *write_b;
  std::uint64_t *enable, *carry, *data;
  std::size_t words;
};
/// One clock of all pixels, all from the planes as they were before it.
void clock_pixels(const PixelClock& planes, const ArrayWord& word);

/// The host's vectors in use ("AVX3", ...).
const char* vector_target();

}  // namespace dendro::igc
