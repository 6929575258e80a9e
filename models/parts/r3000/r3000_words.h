#pragma once

#include "models/parts/r3000/r3000.h"

/// Words that are more than a line: coprocessors, multiplier.
namespace dendro::r3000 {

template <class Port, class Timing>
bool Core<Port, Timing>::coprocessor1() {
  if (s_.status & kStatusCu1) return true;
  fault_ = {};
  fault_.code = kCpu;
  fault_.coprocessor = 1;
  return false;
}

template <class Port, class Timing>
void Core<Port, Timing>::fpu_line() {
  const unsigned line = 1u << spec_.fpu_interrupt;
  s_.lines = static_cast<std::uint8_t>(s_.fpu.interrupting() ? s_.lines | line : s_.lines & ~line);
}

/// False: the R3010 interrupts this word.
template <class Port, class Timing>
bool Core<Port, Timing>::control_to_fpu(std::uint32_t value) {
  s_.fpu.control = value & r3010::kControlWritable;
  fpu_line();
  fault_ = {};
  return !s_.fpu.interrupting() || !interrupt_due(s_);
}

template <class Port, class Timing>
bool Core<Port, Timing>::execute_fp(const Decoded& d) {
  const r3010::Outcome outcome = r3010::execute(s_.fpu, d.imm);
  if (outcome == r3010::Outcome::kDone) return true;
  fault_ = {};
  fpu_line();
  return !interrupt_due(s_);
}

template <class Port, class Timing>
void Core<Port, Timing>::multiply_divide(Op op, std::uint32_t a, std::uint32_t b) {
  if (op == Op::kMult || op == Op::kMultu) {
    const std::uint64_t product =
        op == Op::kMultu ? std::uint64_t{a} * b
                           : static_cast<std::uint64_t>(std::int64_t{static_cast<std::int32_t>(a)} *
                                                        static_cast<std::int32_t>(b));
    s_.hi = static_cast<std::uint32_t>(product >> 32);
    s_.lo = static_cast<std::uint32_t>(product);
    return;
  }
  if (b == 0) {  // no exception; what the restoring divider leaves. ASSUMED DEV-114
    s_.lo = op == Op::kDiv && static_cast<std::int32_t>(a) < 0 ? 1 : 0xFFFFFFFF;
    s_.hi = a;
  } else if (op == Op::kDivu) {
    s_.lo = a / b;
    s_.hi = a % b;
  } else if (a == 0x80000000 && b == 0xFFFFFFFF) {
    s_.lo = a;
    s_.hi = 0;
  } else {
    s_.lo = static_cast<std::uint32_t>(static_cast<std::int32_t>(a) / static_cast<std::int32_t>(b));
    s_.hi = static_cast<std::uint32_t>(static_cast<std::int32_t>(a) % static_cast<std::int32_t>(b));
  }
}

/// mtc0 and the operations of coprocessor 0.
template <class Port, class Timing>
bool Core<Port, Timing>::execute_cp0(const Decoded& d) {
  if (s_.user() && !(s_.status & kStatusCu0)) {
    fault_ = {};
    fault_.code = kCpu;
    return false;
  }
  const auto drop = [this](std::uint32_t hi) {
    for (Maps& maps : maps_)
      maps.read[hi >> 12 & (kMappings - 1)] = maps.write[hi >> 12 & (kMappings - 1)] = Mapping();
    for (auto& fetches : fetches_) fetches[hi >> 12 & (kMappings - 1)] = FetchMapping();
  };
  switch (d.op) {
    case Op::kMtc0: {
      const std::uint32_t status = s_.status, hi = s_.entry_hi;
      write_cp0(s_, d.rd, s_.r[d.rt]);
      if (((s_.status ^ status) & kStatusIsc) || ((s_.entry_hi ^ hi) & kHiAsid)) forget_maps();
      break;
    }
    case Op::kTlbwi:
    case Op::kTlbwr: {
      const unsigned index = d.op == Op::kTlbwi ? s_.index >> 8 & 63 : random_of(s_);
      drop(s_.tlb[index].hi);
      tlb_write(s_, index);
      drop(s_.tlb[index].hi);
      break;
    }
    case Op::kTlbr:
      tlb_read(s_);
      break;
    case Op::kTlbp:
      tlb_probe(s_);
      break;
    default:
      return_from_exception(s_);
      break;
  }
  if (d.op == Op::kTlbr) forget_maps();  // it may bring another address space
  refetch_ = true;
  leave_ = d.op == Op::kMtc0 || d.op == Op::kRfe;
  return true;
}

}  // namespace dendro::r3000
