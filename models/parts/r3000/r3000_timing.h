#pragma once

namespace dendro::r3000 {

/// Clocks of the integer pipeline that are not one. Rules: README.md, chapter Time.
struct Timing {
  unsigned multiply_cycles = 12;  ///< from mult to a mfhi or mflo that does not wait [GCC]
  unsigned divide_cycles = 35;    ///< from div [GCC]
  unsigned exception_cycles =
      3;  ///< positions between a word that faults and the first of the handler. ASSUMED DEV-120
};

}  // namespace dendro::r3000
