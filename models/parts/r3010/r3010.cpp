#include "models/parts/r3010/r3010.h"

namespace dendro::r3010 {
namespace {

std::uint64_t read(const State& s, Format format, unsigned reg) {
  if (format != kDouble) return s.r[reg];
  return std::uint64_t{s.r[reg | 1]} << 32 | s.r[reg & 30];
}

void write(State& s, Format format, unsigned reg, std::uint64_t bits) {
  if (format == kDouble) {
    s.r[reg & 30] = static_cast<std::uint32_t>(bits);
    s.r[reg | 1] = static_cast<std::uint32_t>(bits >> 32);
  } else {
    s.r[reg] = static_cast<std::uint32_t>(bits);
  }
}

/// Cause, and flags unless one of the exceptions interrupts.
Outcome finish(State& s, unsigned exceptions) {
  if (exceptions & kUnimplemented) exceptions = kUnimplemented;
  s.control = (s.control & ~(63u << kCauseShift)) | exceptions << kCauseShift;
  if (exceptions == 0) return Outcome::kDone;
  if (s.interrupting()) return Outcome::kInterrupt;
  s.control |= exceptions << kFlagShift;
  return Outcome::kDone;
}

}  // namespace

bool exists(unsigned format, unsigned operation) {
  if (format == kWord) return operation == kCvtS || operation == kCvtD;
  if (format != kSingle && format != kDouble) return false;
  if (operation >= kCompare) return true;
  if (operation == kCvtS) return format == kDouble;
  if (operation == kCvtD) return format == kSingle;
  return operation <= kDiv || (operation >= kAbs && operation <= kNeg) || operation == kCvtW;
}

std::uint32_t read_control(const State& s, unsigned reg) {
  return reg == 31 ? s.control : reg == 0 ? kRevision : 0;
}

Outcome execute(State& s, std::uint32_t word) {
  const unsigned code = word >> 21 & 31, operation = word & 63;
  if (!exists(code, operation)) return finish(s, kUnimplemented);
  const auto format = static_cast<Format>(code);
  const unsigned ft = word >> 16 & 31, fs = word >> 11 & 31, fd = word >> 6 & 31;
  if (operation >= kCompare) {
    const Result result = soft_compare(operation & 15, format, read(s, format, fs), read(s, format, ft));
    const Outcome outcome = finish(s, result.exceptions);
    if (outcome == Outcome::kDone) s.control = (s.control & ~kCondition) | (result.bits ? kCondition : 0);
    return outcome;
  }
  const std::uint64_t b = operation <= kDiv ? read(s, format, ft) : 0;
  const Result result = compute(static_cast<Operation>(operation), format, read(s, format, fs), b,
                                static_cast<Rounding>(s.control & 3));
  if (operation == kMov) {  // not arithmetic: the cause field stays
    write(s, format, fd, result.bits);
    return Outcome::kDone;
  }
  const Outcome outcome = finish(s, result.exceptions);
  if (outcome == Outcome::kDone) {
    const Format to = operation == kCvtS   ? kSingle
                      : operation == kCvtD ? kDouble
                      : operation == kCvtW ? kWord
                                           : format;
    write(s, to, fd, result.bits);
  }
  return outcome;
}

}  // namespace dendro::r3010
