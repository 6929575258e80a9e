#include "sim/study/timeline.h"

#include "sim/trace/chrome_trace.h"

namespace dendro::study {
namespace {

using Values = std::vector<std::pair<std::string, double>>;

bool is_share(const std::string& name) { return name == "busy" || name == "idle" || name.compare(0, 6, "stall_") == 0; }

Values shares_of(const stats::UnitRow& unit) {
  Values shares;
  const double total = static_cast<double>(unit.values.front().second);
  for (const auto& [name, value] : unit.values)
    if (is_share(name) && total > 0) shares.emplace_back(name + " %", 100.0 * static_cast<double>(value) / total);
  return shares;
}

}  // namespace

std::string timeline_json(const stats::RunObject& run) {
  trace::ChromeTrace trace(run.scene + " on " + run.machine + ":" + run.preset + ", level " + run.level);
  const double us = run.clock_hz > 0 ? 1e6 / run.clock_hz : 0;
  std::int64_t at = 0;
  for (const stats::PhaseRow& phase : run.phases) {
    trace.span(phase.on_host ? "host" : "machine", phase.name, static_cast<double>(at) * us,
               static_cast<double>(phase.cycles) * us,
               {{"from_tick", static_cast<double>(at)}, {"ticks", static_cast<double>(phase.cycles)}});
    at += phase.cycles;
  }
  for (const auto& [name, tick] : run.marks) trace.instant("marks", name, static_cast<double>(tick) * us);
  for (const stats::UnitRow& unit : run.units)
    trace.span(unit.unit, "whole run", 0, static_cast<double>(run.cycles) * us, shares_of(unit));
  return trace.json();
}

}  // namespace dendro::study
