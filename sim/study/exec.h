#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/study/exec_profile.h"
#include "sim/study/run.h"

namespace dendro::study {

/// A run of any program by the machine's generic host: load, run, wait for the halt.
struct ExecArguments {
  std::string machine;  ///< NAME[:PRESET] or FILE.toml
  std::string
      program;        ///< path of a .ucode file, of a .gia or .igc source that is assembled first, or of an ELF file
  std::string text;   ///< of the program, instead of the file's; `program` only names it then
  std::string level;  ///< empty: cycle, or the machine's first
  std::vector<std::string> arguments;  ///< of the program, its own name not among them; pixel-planes: commands
  std::vector<std::string> settings;   ///< key=value of machine parameters
  std::vector<std::pair<std::uint32_t, std::uint32_t>> dumps;  ///< scratch address or pixel, how many
  bool profile = false;  ///< `cycle` of a machine whose programs are ELF files: cycles by function
  std::optional<int> gdb_port;  ///< ELF files, `function` and `cycle`: wait there for GDB; 0: any free port
  MachineOptions options;
};

struct ExecOutput {
  stats::RunObject object;     ///< without scene, picture and error
  int exit_code = 0;           ///< of a microprogram: low byte of scratch word 0
  bool prints_output = false;  ///< the program wrote to standard output itself
  std::vector<ProfileRow> profile;
  std::vector<std::vector<std::uint32_t>> dumps;  ///< scratch words
  std::vector<std::string> dump_lines;            ///< these, or pixels, as text
};

/// The machine that a program would run on, with the settings in its parameters. Throws UserError.
config::Preset exec_preset(const Catalogue& catalogue, const ExecArguments& arguments);

/// The level that is asked for. Throws UserError.
Level exec_level(const ExecArguments& arguments, const MachineType& type);

/// Runs the program in this process, for its effect on what `options` points to. At levels with time this
/// elaborates SystemC: once per process. Throws UserError.
void exec_here(const Catalogue& catalogue, const ExecArguments& arguments, Progress* progress);

/// Runs the program, a microprogram in a worker process. Throws UserError.
ExecOutput exec_program(const Catalogue& catalogue, const ExecArguments& arguments, Progress* progress);

std::string exec_json(const ExecOutput& output);

}  // namespace dendro::study
