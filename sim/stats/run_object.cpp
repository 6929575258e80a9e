#include "sim/stats/run_object.h"

#include <set>

#include "sim/base/check.h"

namespace dendro::stats {
namespace {

void check_unit(const UnitRow& unit) {
  DENDRO_CHECK(!unit.values.empty() && unit.values.front().first == "cycles",
               "{}: the first counter is `cycles`", unit.unit);
  std::uint64_t sum = 0;
  std::set<std::string> names;
  for (const auto& [name, value] : unit.values) {
    DENDRO_CHECK(names.insert(name).second, "{}.{} twice", unit.unit, name);
    if (name == "busy" || name == "idle" || name.compare(0, 6, "stall_") == 0) sum += value;
  }
  DENDRO_CHECK(names.count("busy") && names.count("idle"), "{}: no busy or no idle", unit.unit);
  DENDRO_CHECK(sum == unit.values.front().second, "{}: busy + stalls + idle = {}, cycles = {}", unit.unit,
               sum, unit.values.front().second);
}

}  // namespace

void add_sampling_interval(RunObject& run) {
  for (const UnitRow& unit : run.units)
    for (const auto& [name, value] : unit.values) {
      if (name == "low") run.seconds_low = static_cast<double>(value) / run.clock_hz;
      if (name == "high") run.seconds_high = static_cast<double>(value) / run.clock_hz;
    }
}

void check_sanity(const RunObject& run) {
  std::int64_t sum = 0;
  for (const PhaseRow& phase : run.phases) {
    DENDRO_CHECK(phase.cycles >= 0, "phase {}: {}", phase.name, phase.cycles);
    sum += phase.cycles;
  }
  DENDRO_CHECK(sum == run.cycles, "phases add up to {}, cycles = {}", sum, run.cycles);
  DENDRO_CHECK(run.cycles == 0 || run.machine_cycles <= run.cycles, "machine {} of {} cycles",
               run.machine_cycles, run.cycles);
  std::set<std::string> names;
  for (const UnitRow& unit : run.units) {
    DENDRO_CHECK(names.insert(unit.unit).second, "unit {} twice", unit.unit);
    check_unit(unit);
  }
}

}  // namespace dendro::stats
