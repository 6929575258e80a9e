#pragma once

#include <map>
#include <string>
#include <vector>

#include "models/machines/machine.h"
#include "sim/stats/run_object.h"
#include "sim/study/elf.h"

namespace dendro::study {

/// A function of a program: how often its first word left the pipeline, and the clocks of its own words.
struct ProfileRow {
  std::string name;
  std::uint64_t calls = 0;
  std::int64_t cycles = 0;
};

/// The most expensive first; what lies in no function is `(monitor)` in kseg0 below the program, else `(unknown)`. The
/// cycles add up to the run's.
std::vector<ProfileRow> profile_of(const std::map<std::uint32_t, WordClocks>& words, const ElfProgram& program);
std::string profile_text(const std::vector<ProfileRow>& rows, std::int64_t cycles);

/// Phases of a program's marks: `start` before the first; a start or label n begins `mark n`, a stop `unmarked`. They
/// add up to `cycles`. None without marks.
std::vector<Phase> phases_of(const std::vector<ProgramMark>& marks, std::int64_t cycles);

/// Cycles per instruction and what they are made of, a line each; empty for a machine that has no such counters.
std::string cause_text(const stats::RunObject& run);

}  // namespace dendro::study
