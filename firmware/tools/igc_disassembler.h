#pragma once

#include <string>

#include "firmware/tools/igc_assembler.h"
#include "firmware/tools/ucode.h"

namespace dendro::tools {

/// The image as the contents of a `.ucode` file for pixel-planes: words, and programs as symbols.
Ucode igc_ucode(const IgcImage& image);

/// A source that assembles to the same words. Registers become r0, r1, ...; programs keep their names. Throws UserError
/// for words that the assembler cannot make.
std::string disassemble_igc(const Ucode& ucode);

}  // namespace dendro::tools
