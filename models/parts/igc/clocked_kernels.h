#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

#include "models/parts/igc/igc_isa.h"

/// What the nodes of a tree's level and the pixels do in one clock, 64 of them in a word. Vectors of the
/// host, chosen at run time.
namespace dendro::igc {

/// Memory that begins with a whole line of the host's cache: vectors that straddle two cost twice.
template <class T>
struct LineAllocator {
  using value_type = T;
  static constexpr std::align_val_t kLine{64};
  LineAllocator() = default;
  template <class U>
  LineAllocator(const LineAllocator<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), kLine)); }
  void deallocate(T* p, std::size_t) { ::operator delete(p, kLine); }
  bool operator==(const LineAllocator&) const { return true; }
  bool operator!=(const LineAllocator&) const { return false; }
};

/// One bit of every node or pixel.
using BitPlane = std::vector<std::uint64_t, LineAllocator<std::uint64_t>>;

/// One level of the tree. Row r of the `rows` of inputs, `row_words` each, has its children in rows 2r and 2r
/// + 1 of `out`: first the input itself, then the sum of input, coefficient and carry, whose carry is kept.
/// With `clear` the carry counts as 0 before.
struct LevelClock {
  const std::uint64_t* in;
  std::uint64_t *out, *carry;
  std::size_t rows, row_words;
  bool coefficient, clear;
};
void clock_level(const LevelClock& level);

/// The planes that a word works on. nullptr: a port that is not read, not written, or beyond the memory; no
/// tree bit.
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
