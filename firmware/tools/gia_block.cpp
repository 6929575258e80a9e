#include "firmware/tools/gia_block.h"

#include <algorithm>

namespace dendro::tools {
namespace {

using namespace bps32;

enum State : unsigned {
  kQReg = kStateQ,
  kDivideSign,
  kFlags,
  kSar,
  kMulOperandX,
  kMulOperandY,
  kBusAddressX,
  kBusAddressY,
  kBusData,
  kCounterReg,
};

constexpr std::uint64_t bit(unsigned state) { return std::uint64_t{1} << state; }
constexpr std::uint64_t field_mask(const Field& f) { return put(0, f, ~0u); }

std::uint64_t sequencer_mask() { return field_mask(kSeq) | field_mask(kCond) | field_mask(kPol); }
std::uint64_t bus_mask() { return field_mask(kBusOp) | field_mask(kBusFn); }

bool uses_r(std::uint64_t w) {
  const unsigned f = get(w, kFunc);
  if (f == kSpecial) return !get(w, kI0);
  return f != kPassS && f != kNotS && f != kFZero;
}
bool uses_s(std::uint64_t w) {
  const unsigned f = get(w, kFunc);
  if (f == kSpecial) return !get(w, kI0);
  return f != kPassR && f != kNotR && f != kFZero;
}

void add_alu_function(std::uint64_t w, Operation& o) {
  if (uses_r(w) && !get(w, kEa)) o.reads |= bit(get(w, kA));
  if (uses_s(w) && get(w, kI0)) o.reads |= bit(kQReg);
  if (uses_s(w) && !get(w, kI0) && !get(w, kOeb)) o.reads |= bit(get(w, kB));
  const unsigned dest = get(w, kDest);
  if (get(w, kCarry) >= kCarryLatched || get(w, kFill) == kFillCarry) o.reads |= bit(kFlags);
  if (writes_ram(w)) o.writes |= bit(get(w, kB));
  if (get(w, kFunc) == kSpecial && !get(w, kI0)) {
    o.reads |= bit(kQReg) | bit(kDivideSign);
    if (dest != 4 && dest != 5) o.writes |= bit(kQReg);
    if (dest >= 10) o.writes |= bit(kDivideSign);
    o.shown = o.writes & 0xFFFF;
    return;
  }
  const bool shifts_q = dest == kAsrBoth || dest == kLsrBoth || dest == kAslBoth || dest == kLslBoth ||
                        dest == kQRight || dest == kQLeft;
  if (shifts_q) o.reads |= bit(kQReg);
  if (shifts_q || dest == kQ || dest == kRamQ) o.writes |= bit(kQReg);
  o.shown = o.writes & 0xFFFF;
  if (dest == kQ || dest == kRamQ) o.shown |= bit(kQReg);
}

void add_bus_source(std::uint64_t w, Operation& o) {
  switch (get(w, kDsrc)) {
    case kDBus:
      o.data = true;
      break;
    case kDSpad:
      o.scratch_read = static_cast<int>(get(w, kImm));
      break;
    case kDSpadAr:
    case kDSpadArInc:
      o.scratch_read = kAnyScratch;
      o.reads |= bit(kSar);
      if (get(w, kDsrc) == kDSpadArInc) o.writes |= bit(kSar);
      break;
    case kDProduct:
    case kDProductHi:
    case kDProductLo:
      o.product = true;
      break;
    case kDCounter:
      o.reads |= bit(kCounterReg);
      break;
    case kDStatus:
      o.reads |= bit(kFlags);
      break;
    case kDBusAddress:
      o.reads |= bit(kBusAddressX) | bit(kBusAddressY);
      break;
    case kDSar:
      o.reads |= bit(kSar);
      break;
    default:
      break;
  }
}

void add_y_destination(std::uint64_t w, Operation& o) {
  switch (get(w, kYdst)) {
    case kYBusX:
      o.writes |= bit(kBusAddressX);
      break;
    case kYBusY:
      o.writes |= bit(kBusAddressY);
      break;
    case kYBusAddress:
      o.writes |= bit(kBusAddressX) | bit(kBusAddressY);
      break;
    case kYBusData:
      o.writes |= bit(kBusData);
      break;
    case kYSpad:
      o.scratch_write = static_cast<int>(get(w, kImm));
      break;
    case kYSpadAr:
    case kYSpadArInc:
      o.scratch_write = kAnyScratch;
      o.reads |= bit(kSar);
      if (get(w, kYdst) == kYSpadArInc) o.writes |= bit(kSar);
      break;
    case kYSar:
      o.writes |= bit(kSar);
      break;
    case kYMulX:
    case kYMulXHi:
      o.writes |= bit(kMulOperandX);
      break;
    case kYMulY:
      o.writes |= bit(kMulOperandY);
      break;
    default:
      break;
  }
  if (latches_flags(w)) o.writes |= bit(kFlags);
}

/// The register or Q that the ALU part only moves to Y, or -1.
int plain_move(std::uint64_t w) {
  const bool plain = get(w, kDest) == kYOnly && get(w, kCarry) == kCarryZero && get(w, kDsrc) == kDNone &&
                     !get(w, kLatch) && get(w, kYdst) != kYNone;
  if (!plain) return -1;
  const unsigned f = get(w, kFunc);
  if (f == kPassS && get(w, kI0)) return kStateQ;
  if (f == kPassS && !get(w, kOeb)) return static_cast<int>(get(w, kB));
  if (f == kPassR && !get(w, kEa)) return static_cast<int>(get(w, kA));
  return -1;
}

void add_alu(std::uint64_t w, Operation& o) {
  add_alu_function(w, o);
  add_bus_source(w, o);
  add_y_destination(w, o);
  o.passes = plain_move(w);
  o.mask |= alu_mask();
  const unsigned d = get(w, kDsrc);
  if (d == kDSpad || d == kDImm || get(w, kYdst) == kYSpad) o.mask |= field_mask(kImm);
}

void add_multiply(Operation& o) {
  o.mask |= field_mask(kMul);
  o.starts = true;
  o.late_reads |= bit(kMulOperandX) | bit(kMulOperandY);
}

void add_bus(std::uint64_t w, Operation& o) {
  o.mask |= bus_mask();
  o.bus_read = get(w, kBusOp) == kBusRead;
  o.bus_write = get(w, kBusOp) == kBusWrite;
  o.late_reads |= bit(kBusAddressX) | bit(kBusAddressY);
  if (o.bus_write) o.late_reads |= bit(kBusData);
}

void add_sequencer(std::uint64_t w, Operation& o) {
  o.mask |= sequencer_mask() | field_mask(kHalt);
  o.last = ends_block(w);
  if (uses_sequencer_input(w) && get(w, kYdst) != kYSeq) o.mask |= field_mask(kImm);
  const unsigned seq = get(w, kSeq);
  const unsigned cond = get(w, kCond);
  if (uses_condition(w) && tests_flags(cond)) o.reads |= bit(kFlags);
  if (uses_condition(w) && cond == kQ0) o.reads |= bit(kQReg);
  if (uses_condition(w) && cond == kCounterZero) o.reads |= bit(kCounterReg);
  const bool counts = seq == am2910::kRFCT || seq == am2910::kRPCT || seq == am2910::kTWB;
  if (counts || seq == am2910::kJSRP || seq == am2910::kJRP) o.reads |= bit(kCounterReg);
  if (counts || seq == am2910::kLDCT || seq == am2910::kPUSH) o.writes |= bit(kCounterReg);
}

/// True when the parts must stay one: the sequencer sees what another part of the word changes, or needs its
/// Y.
bool glued(std::uint64_t w, bool has_alu) {
  const bool sequencer = get(w, kSeq) != am2910::kCONT;
  if (!sequencer) return false;
  if (get(w, kYdst) == kYSeq && uses_sequencer_input(w)) return true;
  if (!uses_condition(w)) return false;
  const unsigned cond = get(w, kCond);
  if (tests_flags(cond) && latches_flags(w)) return true;
  if (cond == kQ0 && has_alu) return true;
  if (cond == kProductReady && starts_multiply(w)) return true;
  return (cond == kBusBusy || cond == kDataReady) && (get(w, kBusOp) != kBusIdle || get(w, kDsrc) == kDBus);
}

void append(const Micro& m, std::uint64_t w, int order, Operation o, std::vector<Operation>& all) {
  o.bits = m.word & o.mask;
  if (o.mask & field_mask(kImm)) o.imm = m.imm;
  o.line = m.line;
  o.order = order;
  (void)w;
  all.push_back(o);
}

}  // namespace

std::uint64_t alu_mask() {
  std::uint64_t mask = 0;
  for (const Field& f : {kDest, kFunc, kI0, kA, kB, kEa, kOeb, kLane, kCarry, kFill, kDsrc, kYdst, kLatch}) {
    mask |= field_mask(f);
  }
  return mask;
}

void split(const Micro& micro, std::uint64_t word, int order, std::vector<Operation>& all) {
  const bool has_alu = ((word ^ nop()) & alu_mask()) != 0;
  const bool has_bus = get(word, kBusOp) != kBusIdle;
  const bool has_multiply = starts_multiply(word);
  const bool has_sequencer = get(word, kSeq) != am2910::kCONT || get(word, kHalt);
  if (glued(word, has_alu)) {
    Operation o;
    if (has_alu) add_alu(word, o);
    if (has_multiply) add_multiply(o);
    if (has_bus) add_bus(word, o);
    add_sequencer(word, o);
    return append(micro, word, order, o, all);
  }
  const auto part = [&](bool there, auto add) {
    if (!there) return;
    Operation o;
    add(o);
    append(micro, word, order, o, all);
  };
  part(has_alu, [&](Operation& o) { add_alu(word, o); });
  part(has_multiply, [&](Operation& o) { add_multiply(o); });
  part(has_bus, [&](Operation& o) { add_bus(word, o); });
  part(has_sequencer, [&](Operation& o) { add_sequencer(word, o); });
}

int distance(const Operation& i, const Operation& j, int multiply_ticks) {
  int d = -1;
  const auto need = [&](bool there, int words) {
    if (there) d = std::max(d, words);
  };
  need(i.writes & j.reads, 1);
  need(i.writes & j.late_reads, 0);
  need(i.reads & j.writes, 0);
  need(i.late_reads & j.writes, 1);
  need(i.writes & j.writes, 1);
  need(i.starts && (j.product || j.starts), multiply_ticks);
  need(i.product && j.starts, 0);
  const bool i_bus = i.bus_read || i.bus_write;
  need(i_bus && (j.bus_read || j.bus_write), 1);
  need(i.bus_read && j.data, 1);
  need(i.data && j.bus_read, 0);
  const auto meet = [](int a, int b) {
    return a >= 0 && b >= 0 && (a == b || a == kAnyScratch || b == kAnyScratch);
  };
  need(meet(i.scratch_write, j.scratch_read), 1);
  need(meet(i.scratch_write, j.scratch_write), 1);
  need(meet(i.scratch_read, j.scratch_write), 0);
  need(j.last, 0);
  return d;
}

bool can_join(const Operation& source, const Operation& move, int multiply_ticks) {
  if (move.passes < 0 || !(source.shown & bit(static_cast<unsigned>(move.passes)))) return false;
  if ((source.mask & alu_mask()) == 0 || get(source.bits, kYdst) != kYNone) return false;
  Operation rest = move;
  rest.reads &= ~bit(static_cast<unsigned>(move.passes));
  return distance(source, rest, multiply_ticks) <= 0;
}

}  // namespace dendro::tools
