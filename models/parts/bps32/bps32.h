#pragma once

#include <cstdint>
#include <vector>

#include "models/parts/bps32/bps32_isa.h"
#include "models/parts/bps32/bps32_spec.h"
#include "models/parts/bps32/bps32_state.h"

/// The BPS32 processor: README.md is the data sheet, bps32_isa.h the control word, bps32_execute.h what one word does.
namespace dendro::bps32 {

struct Decoded;
/// Does steps 1 to 4 of a kAlu word.
using AluHandler = void (*)(ProcessorState&, const Decoded&);

/// A control word taken apart once, with what the timing asks of it.
struct Decoded {
  std::uint16_t imm = 0;
  std::uint8_t seq = 0, cond = 0, dest = 0, func = 0, a = 0, b = 0, lane = 0, carry = 0, fill = 0;
  std::uint8_t dsrc = 0, ydst = 0, busop = 0, busfn = 0, mul = 0;
  bool pol = false, i0 = false, ea = false, oeb = false, latch = false, halt = false;

  /// What a word may at most do, so that execute() need not ask field by field.
  /// kAlu: a plain ALU operation, then the next word. The others leave the data alone: kJump is CJP, kLoop is RFCT or
  /// RPCT, kAccess starts an access, kMultiply a multiplication, then the next word.
  enum Kind : std::uint8_t { kGeneric, kAlu, kJump, kLoop, kAccess, kMultiply };
  Kind kind = kGeneric;
  AluHandler alu = nullptr;     ///< for kAlu
  bool uses_d = false;          ///< the D bus reaches R or S
  bool plain_alu = false;       ///< no shifter, no Q, no special function: F goes to Y and perhaps to RAM[B]
  bool writes_ram = false;      ///< for plain_alu
  bool holds = false;           ///< any of the stalls below may apply, or the word is marked
  bool reads_bus = false;       ///< dsrc is the read data register
  bool starts_access = false;
  bool touches_scratch = false;
  bool reads_time = false;      ///< the branch depends on a condition that only time decides
  bool marked = false;
};

Decoded decode(std::uint64_t word);

AluHandler alu_handler(const Decoded& word);

/// Index of the first control word of the page at hand; pages beyond the store's end wrap.
inline std::size_t page_base(const ProcessorState& p) { return p.page * std::size_t{kPageWords} % p.control.size(); }

/// A processor after power-on: everything zero, not running.
ProcessorState power_on(const ProcessorSpec& spec);

}  // namespace dendro::bps32
