#pragma once

#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "firmware/tools/ucode.h"
#include "models/parts/bps32/bps32_state.h"

namespace dendro::testing {

/// A run of a microprogram on the processor's core with a bus that is a plain memory. No time.
struct MachineRun {
  bps32::ProcessorState state;
  /// Address, function, data, 1 for a write: in order.
  std::vector<std::tuple<std::uint32_t, unsigned, std::uint32_t, int>> accesses;
  bool halted = false;
  int words = 0;
};

/// Runs from `state` (its scratch is kept except for the program's initial data) until halt or `limit` words.
MachineRun run_program(const tools::Ucode& ucode, bps32::ProcessorState state, int limit);

/// A processor state with every register, flag and scratch word taken from `seed`.
bps32::ProcessorState random_state(std::uint32_t seed);

}  // namespace dendro::testing
