#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "firmware/lib/pixel_planes/igc_driver.h"
#include "sim/study/exec.h"

namespace dendro::study {

/// What `dendro exec` does on a machine whose programs run when a host commands them: micro-programs, and the commands
/// that stand behind the program: `NAME`, `NAME:A,B,C`, each with `:fraction=N`, `:guard=N`, `:constant=N`; and
/// `REGISTER=VALUE`.
class IgcExec {
 public:
  /// Reads a .igc source, which is assembled for the machine, or a .ucode file. Throws UserError.
  IgcExec(const ExecArguments& arguments, const config::ParameterSet& parameters);

  /// The programs' entries as marks: phase_PHASE.NAME.
  std::map<std::string, std::uint32_t> symbols() const;
  /// The host program: loads, sends all commands, waits.
  void drive(HostPort& host) const;
  /// All memory of a pixel, in hexadecimal.
  std::string pixel(const Machine& machine, std::uint32_t pixel) const;

 private:
  struct Command {
    std::string name;  ///< of a program or register
    bool is_register = false;
    unsigned value = 0;  ///< of the register
    std::optional<lib::Expression> expression;
    unsigned fraction = 0, guard = 0;
    std::optional<std::uint64_t> constant;
  };

  void assemble(const ExecArguments& arguments, const std::string& text);
  void read(const std::string& file, const std::string& text);
  static void check_fits(const std::string& word, const Command& command);
  static Command parse(const std::string& word);
  void check(const std::string& file) const;
  std::string names() const;

  int ports_, memory_bits_;
  lib::IgcPrograms programs_;
  std::vector<Command> commands_;
};

}  // namespace dendro::study
