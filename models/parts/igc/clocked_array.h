#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "models/parts/igc/clocked_kernels.h"

namespace dendro::igc {

/// A register of the pixels, or a bit of their memory.
enum class PixelPlane : std::uint8_t { kMemory, kEnable, kCarry, kData };

/// The pixels behind a tree: E, C, D and memory of each, in the order of the tree's leaves. One broadcast
/// word a clock.
class ClockedArray {
 public:
  /// `words` of 64 pixels each. All bits are 0.
  ClockedArray(std::size_t words, unsigned memory_bits, unsigned ports);

  /// `leaves`: the tree's bits of this clock.
  void clock(const ArrayWord& word, const std::uint64_t* leaves);

  unsigned memory_bits() const { return static_cast<unsigned>(memory_.size()); }
  bool memory(unsigned bit, std::size_t leaf) const { return get(memory_.at(bit), leaf); }
  bool enable(std::size_t leaf) const { return get(enable_, leaf); }
  bool carry(std::size_t leaf) const { return get(carry_, leaf); }
  bool data(std::size_t leaf) const { return get(data_, leaf); }
  /// `bit`: of the memory.
  bool value(PixelPlane which, unsigned bit, std::size_t leaf) const;
  void set(PixelPlane which, unsigned bit, std::size_t leaf, bool value);
  /// Pixels whose E is set.
  std::uint64_t enabled() const;

 private:
  static bool get(const BitPlane& plane, std::size_t leaf) { return plane[leaf / 64] >> leaf % 64 & 1; }
  template <class Array>
  static auto& plane_of(Array& array, PixelPlane which, unsigned bit);
  std::uint64_t* plane(bool used, unsigned address);

  unsigned ports_;
  std::vector<BitPlane> memory_;
  BitPlane enable_, carry_, data_;
};

}  // namespace dendro::igc
