#pragma once

#include <cstdint>

#include "models/machines/machine.h"
#include "models/parts/r3000/r3000_state.h"
#include "models/parts/r3000/r3000_timing.h"
#include "models/parts/r3000_bus/r3000_bus_counters.h"
#include "models/parts/r3000_bus/r3000_bus_spec.h"
#include "models/parts/r3000_cache/r3000_cache_spec.h"
#include "models/parts/r3010/r3010_timing.h"

namespace dendro::sgi_4d35 {

struct Spec {
  r3000::Spec processor;
  r3000::Timing pipeline;
  r3010::Timing fpu;
  r3000_cache::Spec instruction_cache, data_cache;
  r3000_bus::Spec bus;
  double clock_hz = 0;
  std::uint32_t main_bytes = 0;
};

/// Clocks and events of one run, the same at `cycle` and `clocked` to the last one. Causes:
/// models/parts/r3000/README.md.
struct Counters {
  std::uint64_t cycles = 0, busy = 0, nops = 0, tlb_refill_cycles = 0;
  std::uint64_t stall_exception = 0, stall_fp = 0, stall_multiply_divide = 0, stall_instruction_miss = 0,
                stall_data_miss = 0, stall_uncached = 0, stall_partial_store = 0, stall_write_buffer = 0;
  std::uint64_t instruction_accesses = 0, instruction_misses = 0, data_accesses = 0, data_misses = 0;
  r3000_bus::Counters memory;
};

/// The counters as the units of stats.json: processor, instruction_cache, data_cache, memory.
std::vector<UnitStats> units_of(const Counters& counters, const r3000::Counters& events);

/// A word that left MEM: what two levels are compared by. `killed`: it faulted, or was interrupted.
struct Retired {
  std::uint64_t clock = 0;
  std::uint32_t pc = 0;
  bool killed = false;
};

/// Checks the parameters. Throws UserError.
Spec resolve(const config::ParameterSet& parameters);

/// The SGI 4D/35 [MO95 8] as an entry of the list of machines. For programs, at `function` and `clocked`.
MachineType sgi_4d35_type();

}  // namespace dendro::sgi_4d35
