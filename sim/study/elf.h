#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace dendro::study {

/// What of an executable a bare MIPS I machine needs.
struct ElfProgram {
  struct Segment {
    std::uint32_t address = 0;
    std::vector<std::uint8_t> bytes;  ///< with the zeros behind what the file holds
  };
  struct Symbol {
    std::uint32_t address = 0, size = 0;
    std::string name;
  };
  std::uint32_t entry = 0;
  std::vector<Segment> segments;
  std::vector<Symbol> functions;  ///< sorted by address

  /// The one that holds the address; null: none known.
  const Symbol* function_of(std::uint32_t address) const;
  /// "main+0x10", or "0x00400100" where no function is known.
  std::string place(std::uint32_t address) const;
};

/// Reads a statically linked big-endian MIPS I executable. Throws UserError naming `path` for anything else;
/// for another instruction set it says which instruction stands where.
ElfProgram read_elf(const std::string& bytes, const std::string& path);

}  // namespace dendro::study
