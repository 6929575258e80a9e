#pragma once

#include <cstdint>

namespace dendro::am2903 {

/// The control inputs of all eight slices together; codes of bps32_isa.h, semantics in README.md.
struct Control {
  std::uint8_t dest;  ///< I8-I5
  std::uint8_t func;  ///< I4-I1
  bool i0;
  std::uint8_t fill;
};

/// Operands and state before the operation.
struct Input {
  std::uint32_t r, s, q;
  bool carry_in, latched_carry, divide_sign;
};

/// Results. `ram_written` says whether Y goes to RAM[B].
struct Output {
  std::uint32_t y, q;
  bool ram_written;
  bool z, n, c, v;
  bool divide_sign;
};

/// One operation in 32-bit word arithmetic [29203V].
Output operate(const Control& control, const Input& in);

}  // namespace dendro::am2903
