#pragma once

#include <cstdint>

#include "models/parts/r3010/r3010.h"

namespace dendro::r3010 {

/// Clocks from the issue of an operation to the issue of one that reads its result. README.md, chapter Time.
struct Timing {
  unsigned add = 2, compare = 2;                        ///< add and sub; c.cond [GCC]
  unsigned multiply_single = 4, multiply_double = 5;    ///< [GCC]
  unsigned divide_single = 12, divide_double = 19;      ///< [GCC]
  unsigned move = 1;                                    ///< abs, neg, mov [GCC]
  unsigned single_to_double = 1, double_to_single = 2;  ///< ASSUMED DEV-121
  unsigned word_to_float = 3, float_to_word = 2;        ///< ASSUMED DEV-121
  unsigned rounding =
      1;  ///< last clocks of a multiply or divide that take the adder too, 0 or 1. ASSUMED DEV-122
};

enum class Unit : std::uint8_t { kAdder, kMultiplier, kDivider };

/// What an arithmetic word asks for.
struct Demand {
  Unit unit = Unit::kAdder;
  std::uint8_t cycles = 1;
};

/// Of a word with coprocessor 1's arithmetic; one that does not exist takes the adder for one clock.
Demand demand_of(std::uint32_t word, const Timing& timing);

}  // namespace dendro::r3010
