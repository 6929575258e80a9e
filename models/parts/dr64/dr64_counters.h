#pragma once

#include <cstdint>

namespace dendro::dr64 {

/// Card-ticks by cause, booked whole when a card is granted.
struct Counters {
  std::uint64_t busy_access = 0, busy_video = 0, busy_refresh = 0;
  std::uint64_t reads = 0, writes = 0, masked_writes = 0, fetches = 0, refreshes = 0;
  std::uint64_t wait_ticks = 0;  ///< from asking the cards to their grant
};

}  // namespace dendro::dr64
