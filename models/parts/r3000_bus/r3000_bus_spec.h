#pragma once

#include <cstdint>

namespace dendro::r3000_bus {

/// Write buffer and main memory behind the caches. Data sheet: README.md.
struct Spec {
  unsigned entries = 4;             ///< of the write buffer, one word each. ASSUMED DEV-126
  bool read_bypass = true;          ///< a read overtakes waiting writes to other blocks. ASSUMED DEV-126
  unsigned first_word_cycles = 10;  ///< before the first word of a read. ASSUMED DEV-127
  unsigned word_cycles = 1;         ///< each word of a read, the first included. ASSUMED DEV-127
  unsigned write_cycles = 6;        ///< a write. ASSUMED DEV-128
  unsigned page_write_cycles = 3;   ///< a write into the DRAM page of the access before it. ASSUMED DEV-128
  std::uint32_t page_bytes = 2048;  ///< of a DRAM page, a power of two. ASSUMED DEV-128
};

}  // namespace dendro::r3000_bus
