#pragma once

#include <cstdint>
#include <string>

namespace dendro::r3000 {

/// "$sp" and so on, 0 to 31.
const char* register_name(unsigned reg);

/// The word at `address` in the assembler's notation, without pseudo-instructions but nop; a word that is no
/// MIPS I instruction gives ".word 0x..". Words of absent coprocessors count as none.
std::string disassemble(std::uint32_t word, std::uint32_t address);

/// True if the word is an instruction of the R3000A or the R3010.
bool is_mips1(std::uint32_t word);

}  // namespace dendro::r3000
