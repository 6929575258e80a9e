#pragma once

#include <cstdint>

namespace dendro::bps32 {

struct ProcessorSpec {
  std::int64_t tick_ps = 200000;       ///< [FG86 6.1]
  int multiply_ticks = 2;              ///< words from start to product [FG86 6.1]
  int taken_branch_ticks = 0;
  int scratch_ticks = 1;
  int accesses_in_flight = 1;          ///< 0 or 1
  int steal_ticks = 1;                 ///< per host access to scratchpad or control store
  unsigned scratch_words = 8192;       ///< [FG86 6.1]
  unsigned control_store_words = 4096; ///< [FG86 6.1]; a multiple of 4096
};

struct BusSpec {
  int arbitration_ticks = 0;
  int write_ticks = 1;
  int register_read_ticks = 2;
};

}  // namespace dendro::bps32
