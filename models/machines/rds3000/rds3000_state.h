#pragma once

#include <cstdint>

#include "models/parts/bps32/bps32_state.h"
#include "models/parts/dr64/dr64_counters.h"
#include "models/parts/video/video.h"

namespace dendro::rds3000 {

using bps32::ProcessorCounters;
using bps32::ProcessorState;

struct BusCounters {
  std::uint64_t processor_reads = 0, processor_writes = 0, host_reads = 0, host_writes = 0;
  std::uint64_t busy = 0;  ///< ticks in which an access holds the bus, booked whole when it is granted
};

using MemoryCounters = dr64::Counters;

}  // namespace dendro::rds3000
