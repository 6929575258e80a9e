#pragma once

#include <cstdint>

namespace dendro::r3000_cache {

/// One of the two caches. Data sheet: README.md.
struct Spec {
  std::uint32_t size_bytes = 65536;  ///< a power of two [MAME]
  unsigned refill_words = 4;         ///< 4, 8, 16 or 32, aligned. ASSUMED DEV-123
  bool streaming = true;             ///< instruction cache: run while the block comes in. ASSUMED DEV-124
  bool store_partial =
      true;  ///< data cache: a byte merges into its cached word; false: invalidates it. ASSUMED DEV-125
  unsigned partial_store_cycles =
      1;  ///< data cache: stall of a store of less than a word that merges. ASSUMED DEV-125
};

}  // namespace dendro::r3000_cache
