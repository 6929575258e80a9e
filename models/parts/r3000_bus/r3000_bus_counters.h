#pragma once

#include <cstdint>

namespace dendro::r3000_bus {

/// Clocks and events of memory. README.md.
struct Counters {
  std::uint64_t busy = 0, reads = 0, read_words = 0, writes = 0, page_writes = 0, overtaken = 0;
};

}  // namespace dendro::r3000_bus
