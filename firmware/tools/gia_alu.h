#pragma once

#include <functional>

#include "firmware/tools/gia_lexer.h"
#include "firmware/tools/gia_program.h"
#include "firmware/tools/gia_symbols.h"

namespace dendro::tools {

/// One operand of the ALU as written.
struct Operand {
  enum Kind : std::uint8_t { kRegister, kQ, kD, kConstant };
  Kind kind = kConstant;
  unsigned reg = 0;        ///< kRegister
  unsigned dsrc = 0;       ///< kD
  unsigned lane = 0;       ///< kD: rotated right by 8 x lane
  bool uses_imm = false;   ///< kD
  Fixup fixup;             ///< kD with uses_imm
  std::int64_t value = 0;  ///< kConstant; kD with uses_imm: the field's value
  Token at;
};

/// An ALU expression before operands are assigned to R and S.
struct Expression {
  enum Op : std::uint8_t {
    kFixedZero,
    kFixedOnes,
    kPassOne,
    kInvert,
    kAdd,
    kSubtract,
    kAndNot,  ///< ~x & y
    kLogic,   ///< x and y in either place, function code `func`
    kSpecialFunction,
  };
  enum Shift : std::uint8_t { kNoShift, kRight, kLeft, kSpread };
  Op op = kPassOne;
  Operand x, y;
  unsigned func = 0;     ///< kLogic
  unsigned special = 0;  ///< kSpecialFunction: its destination code
  unsigned carry = 0;    ///< CarryIn
  Shift shift = kNoShift;
  unsigned fill = 0;
  bool keep_sign = false;
  bool old_product = false;
  Token at;
};

/// Reads the expression at the cursor. Throws SourceError.
Expression parse_expression(TokenCursor& cursor, const Symbols& symbols,
                            const std::function<int(const Token&)>& label);

/// Reads `zero`, `sign`, `rotate` or `carry` when one stands at the cursor.
unsigned parse_fill(TokenCursor& cursor);

/// The address of `name[...]` or `spad[...]` behind the opening bracket's name, for the imm field.
std::int64_t parse_scratch_address(TokenCursor& cursor, const Symbols& symbols);

}  // namespace dendro::tools
