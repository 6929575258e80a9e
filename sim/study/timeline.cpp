#include "sim/study/timeline.h"

#include "sim/scene/chart.h"
#include "sim/trace/chrome_trace.h"

namespace dendro::study {
namespace {

/// Windows that are one point of the picture, where single ones could not be told apart.
constexpr std::size_t kWindowsPerPoint = 4;

using Values = std::vector<std::pair<std::string, double>>;

bool is_activity(const std::string& name) {
  return name.compare(0, 4, "busy") == 0 || name.compare(0, 6, "stall_") == 0;
}
bool is_share(const std::string& name) { return is_activity(name) || name == "idle"; }

Values shares_of(const stats::UnitRow& unit) {
  Values shares;
  const double total = static_cast<double>(unit.values.front().second);
  for (const auto& [name, value] : unit.values)
    if (is_share(name) && total > 0) shares.emplace_back(name + " %", 100.0 * static_cast<double>(value) / total);
  return shares;
}

void add_phases(const RunOutput& run, double us, trace::ChromeTrace& trace) {
  std::int64_t at = 0;
  for (const Phase& phase : run.phases) {
    trace.span(phase.on_host ? "host" : "machine", phase.name, static_cast<double>(at) * us,
               static_cast<double>(phase.cycles) * us,
               {{"from_tick", static_cast<double>(at)}, {"ticks", static_cast<double>(phase.cycles)}});
    at += phase.cycles;
  }
}

/// The value that a unit's counter had in the sample before; there is none before the first.
std::uint64_t value_before(const ActivitySample* before, std::size_t unit, std::size_t value) {
  return before == nullptr ? 0 : before->units[unit].values[value].second;
}

/// What the counters of a unit grew by since the sample before, in percent of the ticks that it counted.
Values shares_between(const ActivitySample* before, const ActivitySample& sample, std::size_t unit) {
  const auto& values = sample.units[unit].values;
  const double total = static_cast<double>(values.front().second - value_before(before, unit, 0));
  Values shares;
  for (std::size_t v = 1; v < values.size(); ++v)
    if (is_activity(values[v].first) && total > 0)
      shares.emplace_back(values[v].first,
                          100.0 * static_cast<double>(values[v].second - value_before(before, unit, v)) / total);
  return shares;
}

void add_activity(const RunOutput& run, double us, trace::ChromeTrace& trace) {
  const ActivitySample* before = nullptr;
  for (const ActivitySample& sample : run.activity) {
    const double from = before == nullptr ? 0 : static_cast<double>(before->tick) * us;
    for (std::size_t u = 0; u < sample.units.size(); ++u)
      trace.counter(sample.units[u].unit, from, shares_between(before, sample, u));
    before = &sample;
  }
}

}  // namespace

std::string timeline_json(const RunOutput& output) {
  const stats::RunObject& run = output.object;
  trace::ChromeTrace trace(run.scene + " on " + run.machine + ":" + run.preset + ", level " + run.level);
  const double us = run.clock_hz > 0 ? 1e6 / run.clock_hz : 0;
  add_phases(output, us, trace);
  for (const auto& [name, tick] : run.marks) trace.instant("marks", name, static_cast<double>(tick) * us);
  for (const stats::UnitRow& unit : run.units)
    trace.span(unit.unit, "whole run", 0, static_cast<double>(run.cycles) * us, shares_of(unit));
  add_activity(output, us, trace);
  return trace.json();
}

scene::RgbImage timeline_picture(const RunOutput& run) {
  scene::LineChart chart;
  chart.title = run.object.scene + ": how busy every unit is";
  chart.x.label = "seconds of the machine";
  chart.y = {"busy, percent", false, {}, 0, 135};  // room for the names above 100 %
  const ActivitySample* before = nullptr;
  for (std::size_t i = 0; i < run.activity.size(); ++i) {
    const ActivitySample& sample = run.activity[i];
    if (i % kWindowsPerPoint != kWindowsPerPoint - 1 && i + 1 != run.activity.size()) continue;
    const double middle = static_cast<double>(sample.tick + (before == nullptr ? 0 : before->tick)) / 2;
    chart.series.resize(sample.units.size());
    for (std::size_t u = 0; u < sample.units.size(); ++u) {
      const std::string& name = sample.units[u].unit;
      chart.series[u].name = name.substr(name.find('.') + 1);
      for (const auto& [cause, share] : shares_between(before, sample, u)) {
        if (cause != "busy") continue;
        chart.series[u].x.push_back(middle / run.object.clock_hz);
        chart.series[u].y.push_back(share);
      }
    }
    before = &sample;
  }
  return scene::draw(chart);
}

}  // namespace dendro::study
