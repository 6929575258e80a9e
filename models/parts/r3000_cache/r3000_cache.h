#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "models/parts/r3000_cache/r3000_cache_spec.h"

namespace dendro::r3000_cache {

/// The tags of one cache, one for every word. Addresses are physical. README.md.
class Tags {
 public:
  explicit Tags(const Spec& spec)
      : refill_words_(spec.refill_words),
        mask_(spec.size_bytes / 4 - 1),
        store_partial_(spec.store_partial),
        tags_(spec.size_bytes / 4, kInvalid) {}

  /// True if the word of the address is there.
  bool hit(std::uint32_t address) const { return tags_[address >> 2 & mask_] == address >> 2; }
  /// The whole block of the address becomes valid.
  void fill(std::uint32_t address) {
    const std::uint32_t first = block_of(address) >> 2;
    for (unsigned i = 0; i < refill_words_; ++i) tags_[(first + i) & mask_] = first + i;
  }
  void store_word(std::uint32_t address) { tags_[address >> 2 & mask_] = address >> 2; }
  /// After a store of less than a word that is not isolated.
  void store_part(std::uint32_t address) {
    if (!store_partial_) invalidate(address);
  }
  void invalidate(std::uint32_t address) { tags_[address >> 2 & mask_] = kInvalid; }

  /// First byte of the block that a miss at the address fetches.
  std::uint32_t block_of(std::uint32_t address) const { return address & ~(refill_bytes() - 1); }
  std::uint32_t refill_bytes() const { return 4 * refill_words_; }

  std::uint32_t words() const { return mask_ + 1; }
  /// The address whose word stands at this index, if any.
  std::optional<std::uint32_t> held(std::uint32_t index) const {
    if (tags_[index] == kInvalid) return std::nullopt;
    return tags_[index] << 2;
  }

 private:
  static constexpr std::uint32_t kInvalid = ~0u;

  std::uint32_t refill_words_, mask_;
  bool store_partial_;
  std::vector<std::uint32_t> tags_;  ///< number of the word in memory
};

}  // namespace dendro::r3000_cache
