#include "sim/study/exec_profile.h"

#include <fmt/format.h>

#include <algorithm>

#include "models/parts/r3000/r3000_isa.h"

namespace dendro::study {
namespace {

/// Words of the monitor lie below every program's in kseg0.
constexpr std::uint32_t kMonitorEnd = r3000::kKseg0 + 0x00400000;

const ElfProgram::Symbol* function_at(std::uint32_t address, const ElfProgram& program) {
  const auto behind = std::upper_bound(
      program.functions.begin(), program.functions.end(), address,
      [](std::uint32_t at, const ElfProgram::Symbol& symbol) { return at < symbol.address; });
  if (behind == program.functions.begin()) return nullptr;
  const ElfProgram::Symbol& symbol = *(behind - 1);
  return address - symbol.address < std::max<std::uint32_t>(symbol.size, 4) ? &symbol : nullptr;
}

struct Cause {
  const char* text;
  const char* counter;
};
constexpr Cause kCauses[] = {{"floating-point interlocks", "stall_fp"},
                             {"multiplier and divider", "stall_multiply_divide"},
                             {"instruction misses", "stall_instruction_miss"},
                             {"data misses", "stall_data_miss"},
                             {"uncached reads", "stall_uncached"},
                             {"stores of less than a word", "stall_partial_store"},
                             {"write buffer full", "stall_write_buffer"},
                             {"exceptions and start", "stall_exception"}};

}  // namespace

std::vector<ProfileRow> profile_of(const std::map<std::uint32_t, WordClocks>& words,
                                   const ElfProgram& program) {
  std::map<std::string, ProfileRow> by_name;
  for (const auto& [address, clocks] : words) {
    const ElfProgram::Symbol* function = function_at(address, program);
    const bool monitor = address >= r3000::kKseg0 && address < kMonitorEnd;
    const std::string name = function ? function->name : monitor ? "(monitor)" : "(unknown)";
    ProfileRow& row = by_name[name];
    row.name = name;
    row.cycles += static_cast<std::int64_t>(clocks.clocks);
    if (function ? address == function->address
                 : address == r3000::kUtlbVector || address == r3000::kGeneralVector)
      row.calls += clocks.times;
  }
  std::vector<ProfileRow> rows;
  for (const auto& named : by_name) rows.push_back(named.second);
  std::stable_sort(rows.begin(), rows.end(),
                   [](const ProfileRow& a, const ProfileRow& b) { return a.cycles > b.cycles; });
  return rows;
}

std::string profile_text(const std::vector<ProfileRow>& rows, std::int64_t cycles) {
  std::string text = fmt::format("{:>12}{:>18}{:>9}  {}\n", "calls", "cycles", "share", "function");
  for (const ProfileRow& row : rows)
    text += fmt::format("{:>12}{:>18}{:>8.2f}%  {}\n", stats::grouped(static_cast<std::int64_t>(row.calls)),
                        stats::grouped(row.cycles),
                        100.0 * static_cast<double>(row.cycles) / static_cast<double>(std::max<std::int64_t>(cycles, 1)), row.name);
  return text;
}

std::vector<Phase> phases_of(const std::vector<ProgramMark>& marks, std::int64_t cycles) {
  std::vector<Phase> phases;
  std::int64_t begin = 0;
  std::string name = "start";
  for (const ProgramMark& mark : marks) {
    phases.push_back({name, mark.cycles - begin, false});
    begin = mark.cycles;
    name = mark.number == DENDRO_MARK_STOP ? "unmarked" : "mark " + std::to_string(mark.label);
  }
  if (!phases.empty()) phases.push_back({name, cycles - begin, false});
  return phases;
}

std::string cause_text(const stats::RunObject& run) {
  std::map<std::string, std::uint64_t> values;
  for (const stats::UnitRow& unit : run.units)
    if (unit.unit == "sgi_4d35.processor") values.insert(unit.values.begin(), unit.values.end());
  if (values.count("stall_fp") == 0 || run.cycles == 0 || run.instructions == 0) return "";
  const auto instructions = static_cast<double>(run.instructions), cycles = static_cast<double>(run.cycles);
  std::string text = fmt::format("{:.3f} cycles per instruction:\n", cycles / instructions);
  const auto line = [&](const std::string& what, std::uint64_t clocks) {
    const auto part = static_cast<double>(clocks);
    text += fmt::format("  {:<28}{:>8.3f}{:>8.2f}%\n", what, part / instructions, 100 * part / cycles);
  };
  line("base", values["busy"] - values["nops"]);
  line("nops", values["nops"]);
  for (const Cause& cause : kCauses)
    if (values[cause.counter] != 0) line(cause.text, values[cause.counter]);
  if (values["tlb_refill_cycles"] != 0)
    text += fmt::format("  of all these, refills of the TLB {:.2f}%\n",
                        100 * static_cast<double>(values["tlb_refill_cycles"]) / cycles);
  return text;
}

}  // namespace dendro::study
