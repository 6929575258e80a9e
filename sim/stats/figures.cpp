#include <map>

#include "sim/stats/run_object.h"

namespace dendro::stats {
namespace {

/// Host phases come back several times in a run; a figure is their sum.
void add_phases(const RunObject& run, std::vector<std::pair<std::string, double>>& figures) {
  std::map<std::string, std::size_t> at;
  for (const PhaseRow& p : run.phases) {
    if (at.emplace(p.name, figures.size()).second) {
      figures.emplace_back("phase." + p.name + ".cycles", 0.0);
      figures.emplace_back("phase." + p.name + ".seconds", 0.0);
    }
    const std::size_t i = at[p.name];
    figures[i].second += static_cast<double>(p.cycles);
    figures[i + 1].second += p.seconds;
  }
}

}  // namespace

std::optional<std::pair<std::string, double>> busiest_unit(const RunObject& run) {
  std::optional<std::pair<std::string, double>> busiest;
  for (const UnitRow& unit : run.units) {
    double cycles = 0, busy = 0;
    for (const auto& [name, value] : unit.values) {
      if (name == "cycles") cycles = static_cast<double>(value);
      if (name == "busy") busy = static_cast<double>(value);
    }
    if (cycles > 0 && (!busiest || busy / cycles > busiest->second)) busiest = {unit.unit, busy / cycles};
  }
  return busiest;
}

std::vector<std::pair<std::string, double>> figures(const RunObject& run) {
  std::vector<std::pair<std::string, double>> figures = {
      {"cycles", static_cast<double>(run.cycles)},
      {"clock_hz", run.clock_hz},
      {"seconds", run.seconds},
      {"machine_cycles", static_cast<double>(run.machine_cycles)},
      {"machine_seconds", run.clock_hz > 0 ? static_cast<double>(run.machine_cycles) / run.clock_hz : 0},
      {"instructions", static_cast<double>(run.instructions)},
      {"host.seconds", run.host.seconds},
      {"host.simulated_hz", run.host.simulated_hz}};
  add_phases(run, figures);
  for (const UnitRow& unit : run.units)
    for (const auto& [name, value] : unit.values)
      figures.emplace_back(unit.unit + "." + name, static_cast<double>(value));
  if (run.error.psnr_db) figures.emplace_back("error.psnr_db", *run.error.psnr_db);
  figures.emplace_back("error.max_depth_error", run.error.max_depth_error);
  figures.emplace_back("error.wrong_pixels", static_cast<double>(run.error.wrong_pixels));
  figures.emplace_back("error.covered_pixels", static_cast<double>(run.error.covered_pixels));
  for (const auto& [name, value] : run.error.extra) figures.emplace_back("error." + name, value);
  for (const auto& [name, value] : run.facts) figures.emplace_back("fact." + name, value);
  return figures;
}

}  // namespace dendro::stats
