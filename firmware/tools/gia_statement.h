#pragma once

#include <functional>

#include "firmware/tools/gia_program.h"
#include "firmware/tools/gia_symbols.h"
#include "firmware/tools/gia_word.h"

namespace dendro::tools {

/// A condition as written: `zero`, `!zero`, `old(zero)`, `!old(zero)`.
struct Condition {
  unsigned code = bps32::kAlways;
  bool inverted = false;
  bool old = false;
  Token at;
};

/// Number of the label that a token names, which may be defined later.
using LabelLookup = std::function<int(const Token&)>;

/// Reads the condition at the cursor. Throws SourceError for an unknown one.
Condition parse_condition(TokenCursor& cursor);

/// Reads one microinstruction up to and including its `;`. Throws SourceError.
Micro parse_statement(TokenCursor& cursor, const Symbols& symbols, Program& program,
                      const LabelLookup& label);

/// `counter = count - 1` for a loop: a constant over imm, anything else through the ALU. `count` 0 is an
/// error where it is known. The cursor stands at the count.
Micro parse_loop_count(TokenCursor& cursor, const Symbols& symbols, Program& program,
                       const LabelLookup& label);

}  // namespace dendro::tools
