#pragma once

#include <string>

#include "firmware/tools/ucode.h"

namespace dendro::tools {

/// Source text that assembles to the identical Ucode. A word whose symbolic form would encode otherwise is
/// printed as `word 0x...;`.
std::string disassemble(const Ucode& ucode);

}  // namespace dendro::tools
