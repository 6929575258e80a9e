#pragma once

#include <string>
#include <string_view>

#include "firmware/tools/gia_program.h"

namespace dendro::tools {

/// Reads a whole microprogram source. Throws SourceError (a UserError with file, line and column).
Program parse_program(std::string_view source, const std::string& file, unsigned scratch_words);

}  // namespace dendro::tools
