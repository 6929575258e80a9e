#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "models/machines/rds3000/rds3000_spec.h"
#include "tests/support/rds3000_rig.h"

namespace dendro::test {

/// What a random program may do.
struct Flavour {
  bool reads_time = false;   ///< branches on bus_busy, data_ready, vertical_blank, field
  bool host_meddles = false; ///< the host reads and writes memory, scratchpad and look-up table while it runs
};

/// A random machine, program, memory contents and host, all from one seed. The program always halts: branches go
/// forward, loops are counted, subroutines are leaves.
struct RandomRun {
  rds3000::Spec spec;
  std::vector<std::uint64_t> words;
  std::vector<std::uint32_t> scratch;
  HostProgram host;
};

RandomRun random_run(std::uint64_t seed, const Flavour& flavour);

}  // namespace dendro::test
