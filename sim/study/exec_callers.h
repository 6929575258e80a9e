#pragma once

#include <string>

#include "models/machines/machine.h"
#include "sim/study/elf.h"

namespace dendro::study {

/// From where the program's word at `pc` was reached: ", called from 0x00400120 (caller+0x20), ..." with the innermost
/// call first, or nothing. Reads the prologues of functions that have symbols, and what they put on the stack.
std::string callers_text(const ElfProgram& program, const ProgramResult& result, std::uint32_t pc);

}  // namespace dendro::study
