#pragma once

#include "models/parts/am2903/am2903.h"
#include "models/parts/am2910/am2910.h"
#include "models/parts/bps32/bps32.h"

namespace dendro::bps32 {

/// What a word needs from outside while it executes. A Port has the same members; they are inlined.
struct PortConcept {
  bool bus_busy() const;
  bool data_ready() const;
  bool vertical_blank() const;
  bool field() const;
  void start_read(std::uint32_t address, unsigned function);  ///< the word goes to State::read_data
  void start_write(std::uint32_t address, std::uint32_t data, unsigned function);
};

template <class Port>
inline bool condition(const ProcessorState& p, unsigned cond, const Port& port) {
  switch (cond) {
    case kAlways: return true;
    case kZero: return p.z;
    case kNegative: return p.n;
    case kCarrySet: return p.c;
    case kOverflow: return p.v;
    case kLess: return p.n != p.v;
    case kLessEqual: return p.z || p.n != p.v;
    case kQ0: return p.q & 1;
    case kCounterZero: return p.counter == 0;
    case kBusBusy: return port.bus_busy();
    case kDataReady: return port.data_ready();
    case kProductReady: return p.product_in == 0;
    case kVerticalBlank: return port.vertical_blank();
    case kFieldFlag: return port.field();
    case kHostFlag: return p.host_flag;
    default: return p.z || !p.c;
  }
}

inline std::uint32_t status_word(const ProcessorState& p) {
  return p.z * kStatusZ | p.n * kStatusN | p.c * kStatusC | p.v * kStatusV | p.host_flag * kStatusHost;
}

/// Takes the scratch contents' size to be a power of two.
inline std::uint32_t d_bus(const ProcessorState& p, const Decoded& d) {
  switch (d.dsrc) {
    case kDBus: return p.read_data;
    case kDSpad: return p.scratch[d.imm & (p.scratch.size() - 1)];
    case kDSpadAr:
    case kDSpadArInc: return p.scratch[p.sar & (p.scratch.size() - 1)];
    case kDProduct: return p.product;
    case kDProductHi: return static_cast<std::uint32_t>(static_cast<std::int32_t>(p.product) >> 16);
    case kDProductLo: return p.product & 0xFFFF;
    case kDImm: return static_cast<std::uint32_t>(base::sign_extend(d.imm, 12));
    case kDCounter: return p.counter;
    case kDStatus: return status_word(p);
    case kDBusAddress: return p.bus_address;
    case kDSar: return p.sar;
    default: return 0;
  }
}

/// Y and the flags of the simple operations, written in place.
struct AluResult {
  std::uint32_t y;
  bool z, n, c, v;
};

inline AluResult plain_alu(unsigned func, std::uint32_t r, std::uint32_t s, bool carry_in) {
  const auto add = [carry_in](std::uint32_t a, std::uint32_t b) {
    const std::uint64_t wide = std::uint64_t{a} + b + carry_in;
    const auto f = static_cast<std::uint32_t>(wide);
    return AluResult{f, f == 0, (f >> 31) != 0, (wide >> 32) != 0, (((a ^ f) & (b ^ f)) >> 31) != 0};
  };
  const auto logic = [](std::uint32_t f) { return AluResult{f, f == 0, (f >> 31) != 0, false, false}; };
  switch (func) {
    case kSpecial: return logic(0xFFFFFFFF);
    case kSMinusR: return add(s, ~r);
    case kRMinusS: return add(r, ~s);
    case kRPlusS: return add(r, s);
    case kPassS: return add(s, 0);
    case kNotS: return add(~s, 0);
    case kPassR: return add(r, 0);
    case kNotR: return add(~r, 0);
    case kFZero: return logic(0);
    case kNotRAndS: return logic(~r & s);
    case kXnor: return logic(~(r ^ s));
    case kXor: return logic(r ^ s);
    case kAnd: return logic(r & s);
    case kNor: return logic(~(r | s));
    case kNand: return logic(~(r & s));
    default: return logic(r | s);
  }
}

inline void write_y(ProcessorState& p, const Decoded& d, std::uint32_t y) {
  const std::size_t scratch_mask = p.scratch.size() - 1;
  switch (d.ydst) {
    case kYBusX: p.bus_address = (p.bus_address & ~0x3FFu) | (y & 0x3FF); break;
    case kYBusY: p.bus_address = (p.bus_address & 0x3FF) | (y & 0x3FFF) << 10; break;
    case kYBusAddress: p.bus_address = y & 0xFFFFFF; break;
    case kYBusData: p.write_data = y; break;
    case kYSpad: p.scratch[d.imm & scratch_mask] = y; break;
    case kYSpadAr:
    case kYSpadArInc: p.scratch[p.sar & scratch_mask] = y; break;
    case kYMulX: p.mul_x = static_cast<std::uint16_t>(y); break;
    case kYMulXHi: p.mul_x = static_cast<std::uint16_t>(y >> 16); break;
    case kYMulY: p.mul_y = static_cast<std::uint16_t>(y); break;
    case kYStatus:
      p.z = y & kStatusZ;
      p.n = y & kStatusN;
      p.c = y & kStatusC;
      p.v = y & kStatusV;
      break;
    default: break;
  }
  if (d.dsrc == kDSpadArInc || d.ydst == kYSpadArInc) p.sar = (p.sar + 1) & 0x1FFF;
  if (d.ydst == kYSar) p.sar = y & 0x1FFF;
}

inline void clock_multiplier(ProcessorState& p, unsigned mul, int multiply_ticks) {
  if (mul == kMulSigned || mul == kMulUnsigned) {
    p.pending_product = mul == kMulSigned
                            ? static_cast<std::uint32_t>(static_cast<std::int16_t>(p.mul_x) *
                                                         static_cast<std::int16_t>(p.mul_y))
                            : std::uint32_t{p.mul_x} * p.mul_y;
    p.product_in = static_cast<std::uint8_t>(multiply_ticks - 1);
    if (p.product_in == 0) p.product = p.pending_product;
  } else if (p.product_in > 0 && --p.product_in == 0) {
    p.product = p.pending_product;
  }
}

inline std::uint32_t turned_d_bus(const ProcessorState& p, const Decoded& d) {
  const std::uint32_t bus = d_bus(p, d);
  return d.lane == 0 ? bus : base::rotate_right(bus, 8u * d.lane);
}

inline bool carry_in(const ProcessorState& p, const Decoded& d) {
  return d.carry == kCarryZero ? false : d.carry == kCarryOne ? true : (d.carry == kCarryLatched) == p.c;
}

template <class Result>
inline void latch_flags(ProcessorState& p, const Result& result) {
  p.z = result.z;
  p.n = result.n;
  p.c = result.c;
  p.v = result.v;
}

/// A plain ALU operation: RAM[B] or nothing, flags if latched. Returns Y.
inline std::uint32_t execute_plain_alu(ProcessorState& p, const Decoded& d, std::uint32_t r, std::uint32_t s,
                                       bool c0) {
  const AluResult result = plain_alu(d.func, r, s, c0);
  if (d.writes_ram) p.ram[d.b] = result.y;
  if (d.latch) latch_flags(p, result);
  return result.y;
}

inline std::uint32_t execute_any_alu(ProcessorState& p, const Decoded& d, std::uint32_t r, std::uint32_t s,
                                     bool c0) {
  const am2903::Output result =
      am2903::operate({d.dest, d.func, d.i0, d.fill}, {r, s, p.q, c0, p.c, p.divide_sign});
  if (result.ram_written) p.ram[d.b] = result.y;
  p.q = result.q;
  p.divide_sign = result.divide_sign;
  if (d.latch) latch_flags(p, result);
  return result.y;
}

/// Steps 1 to 4: D bus, ALU, Y bus. Returns Y.
inline std::uint32_t execute_data(ProcessorState& p, const Decoded& d) {
  const std::uint32_t bus = d.uses_d ? turned_d_bus(p, d) : 0;
  const std::uint32_t r = d.ea ? bus : p.ram[d.a];
  const std::uint32_t s = d.i0 ? p.q : d.oeb ? bus : p.ram[d.b];
  const bool c0 = carry_in(p, d);
  const std::uint32_t y = d.plain_alu ? execute_plain_alu(p, d, r, s, c0) : execute_any_alu(p, d, r, s, c0);
  if (d.ydst != kYNone || d.dsrc == kDSpadArInc) write_y(p, d, y);
  return y;
}

template <class Port>
inline void start_access(ProcessorState& p, const Decoded& d, Port& port) {
  if (d.busop == kBusRead) port.start_read(p.bus_address, d.busfn);
  if (d.busop == kBusWrite) port.start_write(p.bus_address, p.write_data, d.busfn);
}

/// Executes one word: all of the data sheet's steps 1 to 8. Time is the caller's.
template <class Port>
inline void execute(ProcessorState& p, const Decoded& d, const ProcessorSpec& spec, Port& port) {
  const bool pass = d.seq == am2910::kCONT || condition(p, d.cond, port) != d.pol;
  const std::uint32_t y = execute_data(p, d);
  if ((d.mul | p.product_in) != 0) clock_multiplier(p, d.mul, spec.multiply_ticks);
  start_access(p, d, port);
  if (d.seq == am2910::kCONT) {
    p.pc = (p.pc + 1) & am2910::kAddressMask;
  } else {
    const std::uint16_t direct = d.ydst == kYSeq ? y & am2910::kAddressMask : d.imm;
    p.pc = am2910::step(p, d.seq, pass, p.pc, direct);
  }
  if (d.halt) {
    p.running = false;
    p.interrupt = true;
  }
}

/// execute() by the word's kind, which says what can be left out. `pc` is the caller's copy of p.pc, which is only
/// brought up to date for a kGeneric word.
template <class Port>
inline void execute_fast(ProcessorState& p, const Decoded& d, const ProcessorSpec& spec, Port& port,
                         std::uint16_t& pc) {
  const std::uint16_t next = (pc + 1) & am2910::kAddressMask;
  unsigned mul = kMulNone;
  // Two thirds of all words, told apart by branches: cheaper than one jump through the switch's table for all.
  if (d.kind == Decoded::kAlu) {
    d.alu(p, d);
    pc = next;
    if (p.product_in != 0) clock_multiplier(p, kMulNone, spec.multiply_ticks);
    return;
  }
  if (d.kind == Decoded::kJump) {
    pc = condition(p, d.cond, port) != d.pol ? d.imm : next;
    if (p.product_in != 0) clock_multiplier(p, kMulNone, spec.multiply_ticks);
    return;
  }
  switch (d.kind) {
    case Decoded::kLoop: pc = am2910::step(p, d.seq, true, pc, d.imm); break;
    case Decoded::kAccess:
      start_access(p, d, port);
      pc = next;
      break;
    case Decoded::kMultiply:
      mul = d.mul;
      pc = next;
      break;
    default:
      p.pc = pc;
      execute(p, d, spec, port);
      pc = p.pc;
      return;
  }
  if ((mul | p.product_in) != 0) clock_multiplier(p, mul, spec.multiply_ticks);
}

}  // namespace dendro::bps32
