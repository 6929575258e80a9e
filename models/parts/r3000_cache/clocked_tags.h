#pragma once

#include <cstdint>
#include <vector>

#include "models/parts/r3000_cache/r3000_cache_spec.h"

namespace dendro::r3000_cache {

/// The tags of one cache: for every word the address whose word it holds, or none. Addresses are physical.
class ClockedTags {
 public:
  explicit ClockedTags(const Spec& spec)
      : refill_words_(spec.refill_words), mask_(spec.size_bytes / 4 - 1), words_(spec.size_bytes / 4) {}

  bool holds(std::uint32_t address) const { return words_[index(address)] == entry(address); }
  void validate(std::uint32_t address) { words_[index(address)] = entry(address); }
  /// Whatever stands at the address's index.
  void invalidate(std::uint32_t address) { words_[index(address)] = 0; }

  std::uint32_t block_of(std::uint32_t address) const { return address & ~(4 * refill_words_ - 1); }
  void validate_block(std::uint32_t address) {
    for (unsigned i = 0; i < refill_words_; ++i) validate(block_of(address) + 4 * i);
  }

 private:
  static constexpr std::uint32_t kValid = 1u << 31;
  std::uint32_t index(std::uint32_t address) const { return address >> 2 & mask_; }
  static std::uint32_t entry(std::uint32_t address) { return address >> 2 | kValid; }

  std::uint32_t refill_words_, mask_;
  std::vector<std::uint32_t> words_;
};

}  // namespace dendro::r3000_cache
