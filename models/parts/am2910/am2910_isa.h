#pragma once

#include <cstdint>

namespace dendro::am2910 {

constexpr unsigned kAddressBits = 12;
constexpr unsigned kAddressMask = 0xFFF;

/// Sequencer instructions, I3-I0 [2910DS]. README.md says what each does on pass and on fail.
enum Op : std::uint8_t {
  kJZ = 0,    ///< jump to zero, clear the stack
  kCJS = 1,   ///< conditional jump to subroutine
  kJMAP = 2,  ///< jump to D
  kCJP = 3,   ///< conditional jump
  kPUSH = 4,  ///< push and, on pass, load the counter
  kJSRP = 5,  ///< subroutine at D (pass) or R (fail)
  kCJV = 6,   ///< conditional jump to D, the vector
  kJRP = 7,   ///< jump to D (pass) or R (fail)
  kRFCT = 8,  ///< repeat the loop at the stack top while the counter is not zero
  kRPCT = 9,  ///< repeat at D while the counter is not zero
  kCRTN = 10, ///< conditional return
  kCJPP = 11, ///< conditional jump to D and pop
  kLDCT = 12, ///< load the counter
  kLOOP = 13, ///< go to the stack top until pass
  kCONT = 14, ///< continue
  kTWB = 15,  ///< three-way branch
};

constexpr const char* kOpNames[16] = {"jz",   "cjs",  "jmap", "cjp",  "push", "jsrp", "cjv",  "jrp",
                                      "rfct", "rpct", "crtn", "cjpp", "ldct", "loop", "cont", "twb"};

}  // namespace dendro::am2910
