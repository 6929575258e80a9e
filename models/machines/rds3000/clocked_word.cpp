#include "models/machines/rds3000/clocked_processor.h"
#include "models/machines/rds3000/rds3000_map.h"
#include "sim/base/bits.h"

namespace dendro::rds3000 {
namespace {

using namespace bps32;

std::uint32_t product_of(std::uint16_t x, std::uint16_t y, bool is_signed) {
  if (!is_signed) return std::uint32_t{x} * y;
  return static_cast<std::uint32_t>(std::int32_t{static_cast<std::int16_t>(x)} *
                                    static_cast<std::int16_t>(y));
}

}  // namespace

std::uint32_t ClockedProcessor::d_bus(const Word& w) const {
  const ProcessorState& p = state_;
  switch (w.dsrc) {
    case kDBus:
      return p.read_data;
    case kDSpad:
      return p.scratch[scratch_index(w.imm)];
    case kDSpadAr:
    case kDSpadArInc:
      return p.scratch[scratch_index(p.sar)];
    case kDProduct:
      return p.product;
    case kDProductHi:
      return static_cast<std::uint32_t>(base::sign_extend(p.product >> 16, 16));
    case kDProductLo:
      return p.product & 0xFFFF;
    case kDImm:
      return static_cast<std::uint32_t>(base::sign_extend(w.imm, 12));
    case kDCounter:
      return p.counter;
    case kDStatus:
      return std::uint32_t{p.z} * kStatusZ | std::uint32_t{p.n} * kStatusN | std::uint32_t{p.c} * kStatusC |
             std::uint32_t{p.v} * kStatusV | std::uint32_t{p.host_flag} * kStatusHost;
    case kDBusAddress:
      return p.bus_address;
    case kDSar:
      return p.sar;
    default:
      return 0;
  }
}

bool ClockedProcessor::condition(unsigned cond, const ClockedSignals& in) const {
  const ProcessorState& p = state_;
  switch (cond) {
    case kAlways:
      return true;
    case kZero:
      return p.z;
    case kNegative:
      return p.n;
    case kCarrySet:
      return p.c;
    case kOverflow:
      return p.v;
    case kLess:
      return p.n != p.v;
    case kLessEqual:
      return p.z || p.n != p.v;
    case kQ0:
      return (p.q & 1) != 0;
    case kCounterZero:
      return p.counter == 0;
    case kBusBusy:
      return in.access_in_flight;
    case kDataReady:
      return !in.read_under_way;
    case kProductReady:
      return p.product_in == 0;
    case kVerticalBlank:
      return in.vertical_blank;
    case kFieldFlag:
      return in.field;
    case kHostFlag:
      return p.host_flag;
    default:
      return p.z || !p.c;  // kLowerEqual
  }
}

bool ClockedProcessor::carry_in(unsigned select) const {
  switch (select) {
    case kCarryZero:
      return false;
    case kCarryOne:
      return true;
    case kCarryLatched:
      return state_.c;
    default:
      return !state_.c;
  }
}

void ClockedProcessor::execute(const Word& w, std::int64_t n, const ClockedSignals& in) {
  ProcessorState& p = state_;
  const std::uint32_t d = base::rotate_right(d_bus(w), w.shift);
  am2903::SliceInputs alu;
  alu.r = w.ea ? d : p.ram[w.a];
  alu.s = w.i0 ? p.q : w.oeb ? d : p.ram[w.b];
  alu.q = p.q;
  alu.func = w.func;
  alu.dest = w.dest;
  alu.fill = w.fill;
  alu.i0 = w.i0;
  alu.carry_in = carry_in(w.carry);
  alu.latched_carry = p.c;
  alu.divide_sign = p.divide_sign;
  const am2903::SliceOutputs out = am2903::evaluate_slices(alu);
  const bool pass = condition(w.cond, in) != w.pol;
  const std::uint16_t direct = w.ydst == kYSeq ? out.y & am2910::kAddressMask : w.imm;

  if (out.write_ram) p.ram[w.b] = out.y;
  p.q = out.q;
  p.divide_sign = out.divide_sign;
  if (w.latch) {
    p.z = out.z;
    p.n = out.n;
    p.c = out.c;
    p.v = out.v;
  }
  write_y(w, out.y);
  multiplier(w);

  effects_.f = out.f;
  effects_.y = out.y;
  effects_.request = w.starts_access;
  if (w.starts_access) effects_.access = {w.writes, p.bus_address, p.write_data, w.busfn};
  const auto following = static_cast<std::uint16_t>((p.pc + 1) & am2910::kAddressMask);
  p.pc = sequence(w.seq, pass, direct);
  if (p.pc != following) branch_through_ = n + spec_.taken_branch_ticks;
  effects_.halted = w.halt;
  if (w.halt) p.running = false;
  scratch_started_ = false;
}

void ClockedProcessor::write_y(const Word& w, std::uint32_t y) {
  ProcessorState& p = state_;
  const std::uint16_t old_sar = p.sar;
  if (w.dsrc == kDSpadArInc || w.ydst == kYSpadArInc)
    p.sar = static_cast<std::uint16_t>((old_sar + 1) & 0x1FFF);
  switch (w.ydst) {
    case kYBusX:
      p.bus_address = (p.bus_address & 0xFFFC00) | (y & 0x3FF);
      break;
    case kYBusY:
      p.bus_address = (p.bus_address & 0x3FF) | ((y & 0x3FFF) << 10);
      break;
    case kYBusAddress:
      p.bus_address = y & kAddressMask;
      break;
    case kYBusData:
      p.write_data = y;
      break;
    case kYSpad:
      p.scratch[scratch_index(w.imm)] = y;
      break;
    case kYSpadAr:
    case kYSpadArInc:
      p.scratch[scratch_index(old_sar)] = y;
      break;
    case kYSar:
      p.sar = y & 0x1FFF;
      break;
    case kYMulX:
      p.mul_x = static_cast<std::uint16_t>(y);
      break;
    case kYMulXHi:
      p.mul_x = static_cast<std::uint16_t>(y >> 16);
      break;
    case kYMulY:
      p.mul_y = static_cast<std::uint16_t>(y);
      break;
    case kYStatus:
      p.z = (y & kStatusZ) != 0;
      p.n = (y & kStatusN) != 0;
      p.c = (y & kStatusC) != 0;
      p.v = (y & kStatusV) != 0;
      break;
    default:
      break;
  }
}

void ClockedProcessor::multiplier(const Word& w) {
  ProcessorState& p = state_;
  if (w.mul == kMulSigned || w.mul == kMulUnsigned) {
    p.pending_product = product_of(p.mul_x, p.mul_y, w.mul == kMulSigned);
    p.product_in = static_cast<std::uint8_t>(spec_.multiply_ticks);
  }
  // Counted at the end of the word: with one word to go, the next one sees the product.
  if (p.product_in != 0 && --p.product_in == 0) p.product = p.pending_product;
}

void ClockedProcessor::push(std::uint16_t address) {
  if (state_.depth < state_.stack.size()) ++state_.depth;
  state_.stack[state_.depth - 1u] = address;
}

std::uint16_t ClockedProcessor::sequence(unsigned op, bool pass, std::uint16_t direct) {
  ProcessorState& p = state_;
  const auto next = static_cast<std::uint16_t>((p.pc + 1) & am2910::kAddressMask);
  const std::uint16_t r = p.counter, stack_top = top();
  const auto count_down = [&p, r] { p.counter = static_cast<std::uint16_t>(r - 1); };
  switch (op) {
    case am2910::kJZ:
      p.depth = 0;
      return 0;
    case am2910::kCJS:
      if (pass) push(next);
      return pass ? direct : next;
    case am2910::kJMAP:
      return direct;
    case am2910::kCJP:
    case am2910::kCJV:
      return pass ? direct : next;
    case am2910::kPUSH:
      push(next);
      if (pass) p.counter = direct;
      return next;
    case am2910::kJSRP:
      push(next);
      return pass ? direct : r;
    case am2910::kJRP:
      return pass ? direct : r;
    case am2910::kRFCT:
      if (r != 0) {
        count_down();
        return stack_top;
      }
      pop();
      return next;
    case am2910::kRPCT:
      if (r == 0) return next;
      count_down();
      return direct;
    case am2910::kCRTN:
      if (!pass) return next;
      pop();
      return stack_top;
    case am2910::kCJPP:
      if (!pass) return next;
      pop();
      return direct;
    case am2910::kLDCT:
      p.counter = direct;
      return next;
    case am2910::kLOOP:
      if (!pass) return stack_top;
      pop();
      return next;
    case am2910::kTWB:
      if (r != 0) count_down();
      if (!pass && r != 0) return stack_top;
      pop();
      return pass ? next : direct;
    default:
      return next;  // CONT
  }
}

}  // namespace dendro::rds3000
