#include "firmware/tools/gia_program.h"

namespace dendro::tools {

using namespace bps32;

bool uses_condition(std::uint64_t word) {
  switch (get(word, kSeq)) {
    case am2910::kJZ:
    case am2910::kJMAP:
    case am2910::kRFCT:
    case am2910::kRPCT:
    case am2910::kLDCT:
    case am2910::kCONT:
      return false;
    default:
      return get(word, kCond) != kAlways;
  }
}

bool uses_sequencer_input(std::uint64_t word) {
  switch (get(word, kSeq)) {
    case am2910::kJZ:
    case am2910::kRFCT:
    case am2910::kCRTN:
    case am2910::kLOOP:
    case am2910::kCONT:
      return false;
    default:
      return true;
  }
}

bool ends_block(std::uint64_t word) {
  if (get(word, kHalt)) return true;
  const unsigned seq = get(word, kSeq);
  return seq != am2910::kCONT && seq != am2910::kLDCT;
}

bool never_falls_through(std::uint64_t word) {
  const unsigned seq = get(word, kSeq);
  const bool sure = get(word, kCond) == kAlways && !get(word, kPol);
  switch (seq) {
    case am2910::kJZ:
    case am2910::kJMAP:
    case am2910::kJRP:
      return true;
    case am2910::kCJP:
    case am2910::kCJV:
    case am2910::kCJPP:
    case am2910::kCRTN:
      return sure;
    default:
      return false;
  }
}

bool writes_ram(std::uint64_t word) {
  const unsigned dest = get(word, kDest);
  if (get(word, kFunc) == kSpecial && !get(word, kI0)) {
    return dest % 2 == 0;
  }
  return dest != kQRight && dest != kQ && dest != kYOnly && dest != kQLeft;
}

bool latches_flags(std::uint64_t word) { return get(word, kLatch) || get(word, kYdst) == kYStatus; }

bool reads_product(std::uint64_t word) {
  const unsigned d = get(word, kDsrc);
  return d == kDProduct || d == kDProductHi || d == kDProductLo;
}

bool starts_multiply(std::uint64_t word) {
  const unsigned m = get(word, kMul);
  return m == kMulSigned || m == kMulUnsigned;
}

}  // namespace dendro::tools
