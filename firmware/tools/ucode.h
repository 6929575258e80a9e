#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace dendro::tools {

struct ScratchSymbol {
  std::uint32_t address = 0;  ///< first scratchpad word
  std::uint32_t size = 0;     ///< in words

  bool operator==(const ScratchSymbol& o) const { return address == o.address && size == o.size; }
};

/// An assembled microprogram: the contents of a `.ucode` file.
struct Ucode {
  std::string machine = "rds3000";
  int isa_version = 0;
  std::string pack = "none";  ///< "none" or "full": how densely the words were packed
  int multiply_ticks =
      2;  ///< words from a multiplication's start to its product that the text was checked for
  std::uint32_t entry = 0;                              ///< address of the first word to execute
  std::map<std::string, std::uint32_t> symbols;         ///< labels and their addresses, 0 to words.size()
  std::map<std::string, ScratchSymbol> scratch;         ///< named scratchpad areas
  std::map<std::uint32_t, std::uint32_t> scratch_data;  ///< initial contents by address
  std::vector<std::uint64_t> words;

  bool operator==(const Ucode& o) const;
  bool operator!=(const Ucode& o) const { return !(*this == o); }
};

/// True for a name that a label, constant, register or scratch area may have: an identifier that is no word
/// of the language.
bool is_free_name(std::string_view name);

/// The `.ucode` text: header, words in hex, SHA-256 of all that precedes.
std::string write_ucode(const Ucode& ucode);

/// Reads the text of a `.ucode` file. `file` is only named in errors. Throws UserError with file and line
/// when the text is truncated, damaged, newer than this program or for another machine.
Ucode read_ucode(std::string_view text, const std::string& file);

}  // namespace dendro::tools
