#pragma once

#include <array>
#include <cstdint>

#include "models/parts/am2910/am2910_isa.h"

namespace dendro::am2910 {

constexpr unsigned kStackEntries = 5;

/// Register/counter and stack. The program counter is its owner's.
struct State {
  std::uint16_t counter = 0;
  std::array<std::uint16_t, kStackEntries> stack{};
  std::uint8_t depth = 0;
};

/// One instruction: returns the next address, 12 bits. `pc` is the address of the word being executed, `d` the direct
/// input [2910DS]. AnyState has State's members.
template <class AnyState>
inline std::uint16_t step(AnyState& s, unsigned op, bool pass, std::uint16_t pc, std::uint16_t d) {
  const std::uint16_t next = (pc + 1) & kAddressMask;
  const auto top = [&] { return s.stack[s.depth == 0 ? 0 : s.depth - 1]; };
  const auto push = [&](std::uint16_t address) {
    if (s.depth < kStackEntries) ++s.depth;
    s.stack[s.depth - 1] = address;
  };
  const auto pop = [&] {
    if (s.depth > 0) --s.depth;
  };
  const auto decrement = [&] { s.counter = (s.counter - 1) & kAddressMask; };
  std::uint16_t to = next;
  switch (op) {
    case kJZ: s.depth = 0; return 0;
    case kCJS:
      if (pass) { push(next); to = d; }
      return to;
    case kJMAP: return d;
    case kCJP:
    case kCJV: return pass ? d : next;
    case kPUSH:
      push(next);
      if (pass) s.counter = d;
      return next;
    case kJSRP: push(next); return pass ? d : s.counter;
    case kJRP: return pass ? d : s.counter;
    case kRFCT:
      if (s.counter == 0) { pop(); return next; }
      decrement();
      return top();
    case kRPCT:
      if (s.counter == 0) return next;
      decrement();
      return d;
    case kCRTN:
      if (pass) { to = top(); pop(); }
      return to;
    case kCJPP:
      if (pass) { to = d; pop(); }
      return to;
    case kLDCT: s.counter = d; return next;
    case kLOOP:
      if (!pass) return top();
      pop();
      return next;
    case kTWB:
      if (pass) {
        if (s.counter != 0) decrement();
        pop();
        return next;
      }
      if (s.counter == 0) { pop(); return d; }
      decrement();
      return top();
    default: return next;
  }
}

}  // namespace dendro::am2910
