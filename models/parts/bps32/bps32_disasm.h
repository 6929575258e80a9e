#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace dendro::bps32 {

/// Name for a microprogram address, or an empty string to print the number.
using AddressName = std::function<std::string(unsigned address)>;

/// One control word in the language of docs/microassembler.md, without the final `;`. A word with a code that
/// has no symbolic form is `word 0x...`. Fields without effect are not shown, so the text need not encode to
/// the same bits.
std::string disassemble_word(std::uint64_t word, const AddressName& name = nullptr);

}  // namespace dendro::bps32
