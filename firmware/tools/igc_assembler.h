#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// The assembler of the image generation controller's micro-programs. docs/igc-assembler.md describes the language.
namespace dendro::tools {

struct IgcOptions {
  int ports = 1;          ///< of the array's memory, 1 or 2
  int memory_bits = 256;  ///< of a pixel
  /// Values that the registers will hold while the programs run, by name; those that are not named are not checked
  /// against the memory.
  std::map<std::string, unsigned> registers;
};

struct IgcProgram {
  unsigned entry = 0, words = 0;  ///< in the control store
  std::string phase;              ///< what its time is booked under
  bool uses_tree = false;
};

struct IgcImage {
  std::vector<std::uint64_t> words;  ///< of the control store, from 0
  std::map<std::string, IgcProgram> programs;
  std::map<std::string, unsigned> registers;  ///< numbers by name
};

/// Assembles a source text. `file_name` is only named in errors. Throws UserError `FILE:LINE:COLUMN: message`.
IgcImage assemble_igc(std::string_view source, const std::string& file_name, const IgcOptions& options = {});

}  // namespace dendro::tools
