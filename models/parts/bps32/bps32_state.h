#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace dendro::bps32 {

/// All that the programmer of the BPS32 can see. Plain data: compared in lockstep tests.
struct ProcessorState {
  std::array<std::uint32_t, 16> ram{};
  std::uint32_t q = 0;
  bool z = false, n = false, c = false, v = false;
  bool divide_sign = false;
  bool host_flag = false;

  std::uint16_t pc = 0;       ///< 12 bits
  std::uint8_t page = 0;
  std::uint16_t counter = 0;  ///< R of the Am2910, 12 bits
  std::array<std::uint16_t, 5> stack{};
  std::uint8_t depth = 0;

  std::uint16_t sar = 0;      ///< 13 bits
  std::uint32_t bus_address = 0;
  std::uint32_t write_data = 0, read_data = 0;

  std::uint16_t mul_x = 0, mul_y = 0;
  std::uint32_t product = 0;          ///< what the product register shows
  std::uint32_t pending_product = 0;
  std::uint8_t product_in = 0;        ///< words until the pending product shows; 0: none pending

  std::uint16_t restart_pc = 0;
  std::uint8_t restart_page = 0;
  bool running = false;
  bool interrupt = false;

  std::vector<std::uint32_t> scratch;
  std::vector<std::uint64_t> control;
};

/// Ticks by cause; busy + stalls + idle = total.
struct ProcessorCounters {
  std::uint64_t busy = 0, stall_host = 0, stall_data = 0, stall_bus = 0, stall_scratch = 0, stall_branch = 0, idle = 0;
};

}  // namespace dendro::bps32
