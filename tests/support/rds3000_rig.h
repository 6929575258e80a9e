#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "models/machines/machine.h"
#include "models/machines/rds3000/rds3000_spec.h"
#include "models/machines/rds3000/rds3000_state.h"
#include "models/parts/host/host_port.h"

/// Runs one host program on one RDS-3000 of any level and reports everything that can be seen afterwards.
namespace dendro::test {

/// Every observable as "name value", in a fixed order: the ones that carry time only at levels that have it.
struct Outcome {
  std::vector<std::string> state;   ///< registers, scratchpad, image memory, tables: also at `function`
  std::vector<std::string> timing;  ///< run length, counters, run intervals, marks
  bool time_dependent = false;
};

using HostProgram = std::function<void(HostPort&)>;

/// Runs in a child process, because SystemC elaborates once per process; a crash fails the calling test.
Outcome run_rds3000(Level level, const rds3000::Spec& spec, const MachineOptions& options,
                    const HostProgram& program);

/// The first line in which two reports differ, or an empty string.
std::string first_difference(const std::vector<std::string>& a, const std::vector<std::string>& b);

}  // namespace dendro::test
