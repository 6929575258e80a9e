#include "models/machines/sgi_4d35/clocked_pipeline.h"

namespace dendro::sgi_4d35 {

using r3000::Op;

namespace {

std::int32_t s32(std::uint32_t value) { return static_cast<std::int32_t>(value); }

bool of_cp0(Op op) { return op == Op::kMfc0 || op == Op::kBc0f || op == Op::kBc0t || changes_cp0(op); }

bool of_cp1(Op op) {
  return op == Op::kBc1f || op == Op::kBc1t || op == Op::kMfc1 || op == Op::kCfc1 || op == Op::kLwc1 ||
         op == Op::kSwc1 || (op >= Op::kMtc1 && op <= Op::kFp);
}

void raise(ClockedSlot& a, unsigned code, unsigned coprocessor = 0) {
  a.faulting = true;
  a.fault = {};
  a.fault.code = code;
  a.fault.coprocessor = coprocessor;
}

}  // namespace

/// Register `reg` for a word in RD: what the older words have made of it.
std::uint32_t ClockedPipeline::operand(unsigned reg) const {
  if (reg == 0 || reg == r3000::kNowhere) return 0;
  if (alu_->live && !alu_->faulting && !alu_->late && alu_->destination == reg) return alu_->result;
  if (mem_->live && mem_->destination == reg) return mem_->result;
  if (wb_->live && wb_->destination == reg) return wb_->result;
  return state_.r[reg];
}

ClockedCause ClockedPipeline::look_at_alu() {
  ClockedSlot& a = *alu_;
  if (!a.live) return kHolds;
  if (!a.in_alu) {
    a.in_alu = true;
    allow(a);
  }
  if (a.faulting) return kHolds;
  const ClockedCause wait = wait_of(a);
  if (wait == kHolds) compute(a);
  return wait;
}

/// Interrupts, and what the mode does not allow.
void ClockedPipeline::allow(ClockedSlot& a) {
  if (interrupt_due(state_)) {
    raise(a, r3000::kInt);
    a.interrupted = true;
  } else if (a.faulting) {
    return;  // it could not be fetched
  } else if (of_cp1(a.d.op) && !(state_.status & r3000::kStatusCu1)) {
    raise(a, r3000::kCpu, 1);
  } else if (of_cp0(a.d.op) && !cp0_allowed(state_)) {
    raise(a, r3000::kCpu, 0);
  }
}

ClockedCause ClockedPipeline::wait_of(const ClockedSlot& a) const {
  const auto fp = [](bool waits) { return waits ? ClockedCause::kFp : kHolds; };
  switch (a.d.op) {
    case Op::kMult:
    case Op::kMultu:
    case Op::kDiv:
    case Op::kDivu:
    case Op::kMfhi:
    case Op::kMthi:
    case Op::kMflo:
    case Op::kMtlo:
      return multiplier_left_ != 0 ? ClockedCause::kMultiplyDivide : kHolds;
    case Op::kFp:
      return fp(!units_.may_issue(a.word));
    case Op::kLwc1:
    case Op::kSwc1:
      return fp(units_.under_way(a.d.rt));
    case Op::kMtc1:
      return fp(units_.under_way(a.d.rd));
    case Op::kMfc1:
      return fp(units_.under_way(a.d.imm));
    case Op::kBc1f:
    case Op::kBc1t:
      return fp(units_.comparing());
    case Op::kCfc1:
    case Op::kCtc1:
      return fp(!units_.idle());
    default:
      return kHolds;
  }
}

/// The result that is forwarded, the branch, and the faults that need nothing else.
void ClockedPipeline::compute(ClockedSlot& a) const {
  const std::uint32_t x = a.a, y = a.b, imm = a.d.imm;
  switch (a.d.op) {
    case Op::kSll:
      a.result = y << imm;
      return;
    case Op::kSrl:
      a.result = y >> imm;
      return;
    case Op::kSra:
      a.result = static_cast<std::uint32_t>(s32(y) >> imm);
      return;
    case Op::kSllv:
      a.result = y << (x & 31);
      return;
    case Op::kSrlv:
      a.result = y >> (x & 31);
      return;
    case Op::kSrav:
      a.result = static_cast<std::uint32_t>(s32(y) >> (x & 31));
      return;
    case Op::kAdd:
      if (__builtin_add_overflow(s32(x), s32(y), reinterpret_cast<std::int32_t*>(&a.result)))
        raise(a, r3000::kOv);
      return;
    case Op::kAddi:
      if (__builtin_add_overflow(s32(x), s32(imm), reinterpret_cast<std::int32_t*>(&a.result)))
        raise(a, r3000::kOv);
      return;
    case Op::kSub:
      if (__builtin_sub_overflow(s32(x), s32(y), reinterpret_cast<std::int32_t*>(&a.result)))
        raise(a, r3000::kOv);
      return;
    case Op::kAddu:
      a.result = x + y;
      return;
    case Op::kSubu:
      a.result = x - y;
      return;
    case Op::kAddiu:
      a.result = x + imm;
      return;
    case Op::kAnd:
      a.result = x & y;
      return;
    case Op::kOr:
      a.result = x | y;
      return;
    case Op::kXor:
      a.result = x ^ y;
      return;
    case Op::kNor:
      a.result = ~(x | y);
      return;
    case Op::kAndi:
      a.result = x & imm;
      return;
    case Op::kOri:
      a.result = x | imm;
      return;
    case Op::kXori:
      a.result = x ^ imm;
      return;
    case Op::kLui:
      a.result = imm;
      return;
    case Op::kSlt:
      a.result = s32(x) < s32(y);
      return;
    case Op::kSltu:
      a.result = x < y;
      return;
    case Op::kSlti:
      a.result = s32(x) < s32(imm);
      return;
    case Op::kSltiu:
      a.result = x < imm;
      return;
    case Op::kMfhi:
      a.result = state_.hi;
      return;
    case Op::kMflo:
      a.result = state_.lo;
      return;
    case Op::kSyscall:
      raise(a, r3000::kSys);
      return;
    case Op::kBreak:
      raise(a, r3000::kBp);
      return;
    case Op::kCopUnusable:
      raise(a, r3000::kCpu, a.d.rd);
      return;
    case Op::kReserved:
      raise(a, r3000::kRi);
      return;
    default:
      if (is_branch(a.d.op)) compute_branch(a);
      return;
  }
}

void ClockedPipeline::compute_branch(ClockedSlot& a) const {
  const std::int32_t x = s32(a.a);
  a.target = a.pc + a.d.imm;
  a.result = a.pc + 8;
  switch (a.d.op) {
    case Op::kJ:
    case Op::kJal:
      a.taken = true;
      a.target = ((a.pc + 4) & 0xF0000000) | a.d.imm;
      return;
    case Op::kJr:
    case Op::kJalr:
      a.taken = true;
      a.target = a.a;
      return;
    case Op::kBeq:
      a.taken = a.a == a.b;
      return;
    case Op::kBne:
      a.taken = a.a != a.b;
      return;
    case Op::kBlez:
      a.taken = x <= 0;
      return;
    case Op::kBgtz:
      a.taken = x > 0;
      return;
    case Op::kBltz:
    case Op::kBltzal:
      a.taken = x < 0;
      return;
    case Op::kBgez:
    case Op::kBgezal:
      a.taken = x >= 0;
      return;
    case Op::kBc1f:
    case Op::kBc1t:
      a.taken = state_.fpu.condition() == (a.d.op == Op::kBc1t);
      return;
    default:  // coprocessor 0's condition input is not connected and reads 0
      a.taken = a.d.op == Op::kBc0f;
      return;
  }
}

/// What a word changes when it leaves ALU: HI, LO, coprocessors.
void ClockedPipeline::leave_alu() {
  ClockedSlot& a = *alu_;
  if (!a.live || a.faulting) return;
  switch (a.d.op) {
    case Op::kMult:
    case Op::kMultu:
    case Op::kDiv:
    case Op::kDivu:
      multiply_divide(a);
      return;
    case Op::kMthi:
      state_.hi = a.a;
      return;
    case Op::kMtlo:
      state_.lo = a.a;
      return;
    case Op::kMfc0:
      a.result = read_cp0(state_, spec_.processor, a.d.imm, random_of(state_));
      return;
    case Op::kMfc1:
      a.result = state_.fpu.r[a.d.imm];
      return;
    case Op::kCfc1:
      a.result = r3010::read_control(state_.fpu, a.d.imm);
      return;
    case Op::kSwc1:
      a.b = state_.fpu.r[a.d.rt];
      return;
    case Op::kMtc1:
      state_.fpu.r[a.d.rd] = a.b;
      return;
    case Op::kCtc1:
      if (a.d.rd == 31) control_to_fpu(a);
      return;
    case Op::kFp:
      execute_fp(a);
      return;
    default:
      if (changes_cp0(a.d.op)) apply_cp0(state_, a.d, a.b);
      return;
  }
}

void ClockedPipeline::multiply_divide(const ClockedSlot& a) {
  const bool is_signed = a.d.op == Op::kMult || a.d.op == Op::kDiv;
  const auto wide = [is_signed](std::uint32_t v) {
    return is_signed ? std::int64_t{s32(v)} : std::int64_t{v};
  };
  if (a.d.op == Op::kMult || a.d.op == Op::kMultu) {
    multiplier_left_ = spec_.pipeline.multiply_cycles;
    const std::uint64_t product =
        static_cast<std::uint64_t>(wide(a.a)) * static_cast<std::uint64_t>(wide(a.b));
    state_.lo = static_cast<std::uint32_t>(product);
    state_.hi = static_cast<std::uint32_t>(product >> 32);
    return;
  }
  multiplier_left_ = spec_.pipeline.divide_cycles;
  if (a.b == 0) {  // ASSUMED DEV-114
    state_.lo = wide(a.a) < 0 ? 1 : 0xFFFFFFFF;
    state_.hi = a.a;
    return;
  }
  state_.lo = static_cast<std::uint32_t>(wide(a.a) / wide(a.b));
  state_.hi = static_cast<std::uint32_t>(wide(a.a) % wide(a.b));
}

void ClockedPipeline::pull_line() {
  const unsigned line = 1u << spec_.processor.fpu_interrupt;
  state_.lines =
      static_cast<std::uint8_t>(state_.fpu.interrupting() ? state_.lines | line : state_.lines & ~line);
}

void ClockedPipeline::execute_fp(ClockedSlot& a) {
  if (r3010::execute(state_.fpu, a.word) == r3010::Outcome::kInterrupt) {
    pull_line();
    if (interrupt_due(state_)) return raise(a, r3000::kInt);
  }
  units_.issue(a.word);
}

void ClockedPipeline::control_to_fpu(ClockedSlot& a) {
  state_.fpu.control = a.b & r3010::kControlWritable;
  pull_line();
  if (state_.fpu.interrupting() && interrupt_due(state_)) raise(a, r3000::kInt);
}

}  // namespace dendro::sgi_4d35
