#pragma once

#include "sim/study/elf.h"
#include "sim/study/exec.h"
#include "sim/study/exec_services.h"

namespace dendro::study {

/// exec_program() for a machine whose programs are ELF files: in this process, with its standard input and
/// output.
ExecOutput exec_elf(const Catalogue& catalogue, const ExecArguments& arguments);

/// Runs the program at `cycle` for its effect on what `options` points to; what it prints is
/// not shown. Throws UserError.
void record_elf(const Catalogue& catalogue, const ExecArguments& arguments);

/// The program, its monitor and its first stack in `main_bytes` of memory; `arguments` say its name and its arguments.
/// Throws UserError.
ProgramImage place_program(const ElfProgram& program, const ExecArguments& arguments, std::uint32_t main_bytes);

/// The machine's main memory. Throws UserError when programs of this kind cannot run in it.
std::uint32_t main_bytes_of(const config::ParameterSet& parameters);

/// What is wrong with a program that did not end well, or empty.
std::string ending_error(const CallServices& services, const ProgramResult& result, const ElfProgram& program,
                         std::uint64_t limit);

/// The bytes of an embedded file of objcopy's "verilog" format, by physical address.
std::vector<ProgramImage::Chunk> embedded_chunks(const std::string& path);

}  // namespace dendro::study
