#include "models/parts/bps32/bps32.h"

namespace dendro::bps32 {
namespace {

bool tests_condition(unsigned seq) {
  switch (seq) {
    case am2910::kCJS:
    case am2910::kCJP:
    case am2910::kPUSH:
    case am2910::kJSRP:
    case am2910::kCJV:
    case am2910::kJRP:
    case am2910::kCRTN:
    case am2910::kCJPP:
    case am2910::kLOOP:
    case am2910::kTWB: return true;
    default: return false;
  }
}

bool told_by_time(unsigned cond) {
  return cond == kBusBusy || cond == kDataReady || cond == kVerticalBlank || cond == kFieldFlag || cond == kHostFlag;
}

Decoded::Kind kind_of(const Decoded& d) {
  const bool multiplies = d.mul == kMulSigned || d.mul == kMulUnsigned;
  // plain_alu first: with a special function the same destination code is a divide step.
  const bool leaves_data =
      d.plain_alu && d.dest == kYOnly && !d.latch && d.ydst == kYNone && d.dsrc != kDSpadArInc;
  const bool goes_on = d.seq == am2910::kCONT;
  if (d.halt || multiplies + d.starts_access > 1) return Decoded::kGeneric;
  if (multiplies) return leaves_data && goes_on ? Decoded::kMultiply : Decoded::kGeneric;
  if (d.starts_access) return leaves_data && goes_on ? Decoded::kAccess : Decoded::kGeneric;
  if (goes_on) return d.plain_alu ? Decoded::kAlu : Decoded::kGeneric;
  if (!leaves_data) return Decoded::kGeneric;
  if (d.seq == am2910::kCJP) return Decoded::kJump;
  return d.seq == am2910::kRFCT || d.seq == am2910::kRPCT ? Decoded::kLoop : Decoded::kGeneric;
}

}  // namespace

Decoded decode(std::uint64_t word) {
  Decoded d;
  const auto byte = [word](const Field& f) { return static_cast<std::uint8_t>(get(word, f)); };
  d.imm = static_cast<std::uint16_t>(get(word, kImm));
  d.seq = byte(kSeq);
  d.cond = byte(kCond);
  d.pol = byte(kPol) != 0;
  d.dest = byte(kDest);
  d.func = byte(kFunc);
  d.i0 = byte(kI0) != 0;
  d.a = byte(kA);
  d.b = byte(kB);
  d.ea = byte(kEa) != 0;
  d.oeb = byte(kOeb) != 0;
  d.lane = byte(kLane);
  d.carry = byte(kCarry);
  d.fill = byte(kFill);
  d.dsrc = byte(kDsrc);
  d.ydst = byte(kYdst);
  d.busop = byte(kBusOp);
  d.busfn = byte(kBusFn);
  d.mul = byte(kMul);
  d.latch = byte(kLatch) != 0;
  d.halt = byte(kHalt) != 0;

  const auto is_spad = [](unsigned code, unsigned first) { return code >= first && code < first + 3; };
  d.uses_d = d.ea || (d.oeb && !d.i0);
  d.plain_alu = (d.func != kSpecial || d.i0) &&
                (d.dest == kRam || d.dest == kRamAlso || d.dest == kYOnly);
  d.writes_ram = d.dest != kYOnly;
  d.reads_bus = d.dsrc == kDBus;
  d.starts_access = d.busop == kBusRead || d.busop == kBusWrite;
  d.touches_scratch = is_spad(d.dsrc, kDSpad) || is_spad(d.ydst, kYSpad);
  d.reads_time = tests_condition(d.seq) && told_by_time(d.cond);
  d.holds = d.reads_bus || d.starts_access || d.touches_scratch || d.reads_time;
  d.kind = kind_of(d);
  if (d.kind == Decoded::kAlu) d.alu = alu_handler(d);
  return d;
}

ProcessorState power_on(const ProcessorSpec& spec) {
  ProcessorState state;
  state.scratch.assign(spec.scratch_words, 0);
  state.control.assign(spec.control_store_words, 0);
  return state;
}

}  // namespace dendro::bps32
