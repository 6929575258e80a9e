#pragma once

#include <cstdint>

namespace dendro::am2903 {

/// What the eight slices see during one tick. Codes as in the control word (bps32_isa.h).
struct SliceInputs {
  std::uint32_t r = 0, s = 0, q = 0;
  std::uint8_t func = 0;  ///< I4-I1
  std::uint8_t dest = 0;  ///< I8-I5
  std::uint8_t fill = 0;
  bool i0 = false;
  bool carry_in = false;
  bool latched_carry = false;
  bool divide_sign = false;
};

/// What they give. `y` goes to RAM[B] when `write_ram`; `q` and `divide_sign` are the registers' next values.
struct SliceOutputs {
  std::uint32_t f = 0, y = 0, q = 0;
  bool write_ram = false;
  bool z = false, n = false, c = false, v = false;
  bool divide_sign = false;
};

struct SliceSum {
  std::uint32_t f;
  bool carry;     ///< out of bit 31
  bool overflow;  ///< carry into bit 31 xor carry out of it
};

/// a + b + carry as the hardware forms it: bit generate/propagate, look-ahead within each 4-bit slice, an
/// Am2902 over each four slices, and a second level over the two.
SliceSum look_ahead_sum(std::uint32_t a, std::uint32_t b, bool carry);

/// One operation of eight Am2903-style slices, from the tables of README.md.
SliceOutputs evaluate_slices(const SliceInputs& in);

}  // namespace dendro::am2903
