#pragma once

#include <cstdint>

namespace dendro::ik11b {

/// The host computer and its interface; all times in picoseconds.
struct HostSpec {
  std::int64_t word_ps = 3333333;        ///< DMA time of one 32-bit word
  std::int64_t dma_start_ps = 1500000000;
  std::int64_t register_ps = 1000000;    ///< one access to an interface register
  std::int64_t program_load_ps = 3000000000000;
  std::int64_t interrupt_ps = 1000000000;
  std::int64_t instruction_ps = 2000000;
  std::int64_t flop_ps = 10000000;
};

}  // namespace dendro::ik11b
