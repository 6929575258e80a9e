#include "tests/lockstep/sgi_4d35_lockstep.h"

#include <fmt/format.h>

#include <algorithm>

#include "models/machines/sgi_4d35/cycle.h"

namespace dendro::sgi_4d35 {
namespace {

std::string retired_difference(const std::vector<Retired>& a, const std::vector<Retired>& b) {
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    if (a[i].clock != b[i].clock || a[i].pc != b[i].pc || a[i].killed != b[i].killed)
      return fmt::format("word {}: 0x{:08x} in clock {}{}; 0x{:08x} in clock {}{}", i, a[i].pc, a[i].clock,
                         a[i].killed ? " killed" : "", b[i].pc, b[i].clock, b[i].killed ? " killed" : "");
  if (a.size() != b.size()) return fmt::format("{} and {} words left MEM", a.size(), b.size());
  return "";
}

std::string counter_difference(const Ran& a, const Ran& b) {
  for (const auto& [name, value] : a.counters)
    if (b.counters.at(name) != value)
      return fmt::format("{}: {} and {}", name, value, b.counters.at(name));
  if (a.counters.size() != b.counters.size()) return "counters";
  if (a.cycles != b.cycles) return fmt::format("cycles: {} and {}", a.cycles, b.cycles);
  if (a.stopped != b.stopped) return "only one stopped";
  return "";
}

}  // namespace

Ran run_unlogged(const Spec& spec, const ProgramImage& image, std::uint64_t limit) {
  Ran ran;
  StopService services;
  RunOptions options;
  options.final_state = &ran.state;
  const ProgramResult result = run_cycle(spec, image, services, limit, options);
  ran.cycles = static_cast<std::uint64_t>(result.cycles);
  ran.instructions = result.instructions;
  ran.stopped = result.stopped;
  ran.memory_digest = services.digest;
  for (const UnitStats& unit : result.units)
    for (const auto& [name, value] : unit.values)
      ran.counters[unit.unit.substr(unit.unit.find('.') + 1) + "." + name] = value;
  return ran;
}

std::string difference(const Ran& a, const Ran& b) {
  std::string text;
  if (!a.retired.empty() && !b.retired.empty()) text = retired_difference(a.retired, b.retired);
  if (text.empty()) text = counter_difference(a, b);
  if (text.empty()) text = state_difference(a.state, b.state);
  if (text.empty() && a.memory_digest != b.memory_digest) text = "memory";
  return text;
}

}  // namespace dendro::sgi_4d35
