#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "sim/stats/run_object.h"

namespace dendro::stats {
namespace {

std::string error_line(const ErrorInfo& error) {
  const std::string psnr =
      error.psnr_db ? fmt::format("PSNR {:.1f} dB", *error.psnr_db) : "identical picture";
  std::string text = fmt::format(
      "against {} precision: {}, depth error at most {:.3g} units, {} of {} covered pixels "
      "wrong",
      error.reference, psnr, error.max_depth_error, grouped(error.wrong_pixels),
      grouped(error.covered_pixels));
  for (const auto& [name, value] : error.extra) text += fmt::format(", {} {:g}", name, value);
  return text;
}

std::string time_lines(const RunObject& run) {
  if (run.cycles == 0)
    return fmt::format("  no time at this level; {} microinstructions\n",
                       grouped(static_cast<std::int64_t>(run.instructions)));
  std::string text = fmt::format("  {} cycles at {:g} MHz = {}", grouped(run.cycles), run.clock_hz / 1e6,
                                 readable_seconds(run.seconds));
  if (run.seconds_low)
    text += fmt::format(", {} to {} {}", readable_seconds(*run.seconds_low), readable_seconds(*run.seconds_high),
                        run.level == "estimate" && run.contributions.empty() ? "with 99.7 % of all samples" : "over the assumptions");
  text += "\n";
  for (const PhaseRow& p : run.phases)
    text += fmt::format("    {:<20} {:>14} cycles {:>12}  {}\n", p.name, grouped(p.cycles),
                        readable_seconds(p.seconds), p.on_host ? "host" : "machine");
  return text;
}

std::string unit_lines(const RunObject& run) {
  std::string text;
  for (const UnitRow& unit : run.units) {
    const double total = static_cast<double>(unit.values.front().second);
    if (total == 0) continue;
    text += fmt::format("    {:<24}", unit.unit);
    for (std::size_t i = 1; i < unit.values.size(); ++i) {
      const auto& [name, value] = unit.values[i];
      const bool share = name == "busy" || name == "idle" || name.compare(0, 6, "stall_") == 0;
      if (share && value != 0)
        text += fmt::format("  {} {:.1f} %", name, 100.0 * static_cast<double>(value) / total);
    }
    text += "\n";
  }
  if (const auto unit = busiest_unit(run); unit && run.units.size() > 1)
    text += fmt::format("    busiest: {}, {:.1f} %\n", unit->first, 100 * unit->second);
  return text.empty() ? text : "  units\n" + text;
}

std::string interval_lines(const RunObject& run) {
  std::string text;
  const std::size_t shown = std::min<std::size_t>(run.contributions.size(), 5);
  for (std::size_t i = 0; i < shown; ++i) {
    const Contribution& c = run.contributions[i];
    if (c.high <= c.low) break;
    text += fmt::format("    {:<36} {:>10} to {:>10}  {}\n", c.key, readable_seconds(c.low),
                        readable_seconds(c.high), c.source);
  }
  if (!text.empty()) text = "  widened most by\n" + text;
  for (const std::string& note : run.interval_notes) text += "    note: " + note + "\n";
  return text;
}

std::string csv_quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

std::string grouped(std::int64_t number) {
  std::string digits = std::to_string(number < 0 ? -number : number);
  for (std::ptrdiff_t at = static_cast<std::ptrdiff_t>(digits.size()) - 3; at > 0; at -= 3)
    digits.insert(static_cast<std::size_t>(at), ",");
  return (number < 0 ? "-" : "") + digits;
}

std::string readable_seconds(double seconds) {
  const double size = std::fabs(seconds);
  if (size == 0 || size >= 1) return fmt::format("{:.4g} s", seconds);
  if (size >= 1e-3) return fmt::format("{:.4g} ms", seconds * 1e3);
  return fmt::format("{:.4g} us", seconds * 1e6);
}

std::string to_csv(const RunObject& run) {
  std::string text = "name,value\n";
  const auto add = [&](const std::string& name, const std::string& value) {
    text += csv_quoted(name) + "," + csv_quoted(value) + "\n";
  };
  add("scene", run.scene);
  add("algorithm", run.algorithm);
  add("machine", run.machine);
  add("preset", run.preset);
  add("level", run.level);
  add("seed", std::to_string(run.seed));
  add("cycles", run.has_time() ? std::to_string(run.cycles) : "");
  add("clock_hz", fmt::format("{}", run.clock_hz));
  add("seconds", run.has_time() ? fmt::format("{}", run.seconds) : "");
  add("seconds_low", run.seconds_low ? fmt::format("{}", *run.seconds_low) : "");
  add("seconds_high", run.seconds_high ? fmt::format("{}", *run.seconds_high) : "");
  add("machine_cycles", run.has_time() ? std::to_string(run.machine_cycles) : "");
  add("instructions", std::to_string(run.instructions));
  for (const PhaseRow& p : run.phases) add("phase." + p.name + ".cycles", std::to_string(p.cycles));
  for (const UnitRow& unit : run.units)
    for (const auto& [name, value] : unit.values) add(unit.unit + "." + name, std::to_string(value));
  add("error.psnr_db", run.error.psnr_db ? fmt::format("{}", *run.error.psnr_db) : "");
  add("error.max_depth_error", fmt::format("{}", run.error.max_depth_error));
  add("error.wrong_pixels", std::to_string(run.error.wrong_pixels));
  add("error.covered_pixels", std::to_string(run.error.covered_pixels));
  for (const auto& [name, value] : run.error.extra) add("error." + name, fmt::format("{}", value));
  return text;
}

std::string to_summary(const RunObject& run) {
  std::string text = fmt::format("{}: {} on {}:{}, level {}\n", run.scene, run.algorithm, run.machine,
                                 run.preset, run.level);
  text += time_lines(run) + interval_lines(run) + unit_lines(run);
  text += "  " + error_line(run.error) + "\n";
  if (!run.assumptions.empty()) text += fmt::format("  rests on {}\n", fmt::join(run.assumptions, ", "));
  for (const std::string& note : run.notes) text += "  note: " + note + "\n";
  text += fmt::format("  host {:.3g} s, {:.3g} million ticks a second, {:.3g} times real time, {} MB\n",
                      run.host.seconds, run.host.simulated_hz / 1e6, run.host.real_time_factor,
                      run.host.peak_rss_bytes / 1000000);
  return text;
}

}  // namespace dendro::stats
