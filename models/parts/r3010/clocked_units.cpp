#include "models/parts/r3010/clocked_units.h"

namespace dendro::r3010 {
namespace {

std::uint32_t mask_of(unsigned format, unsigned reg) {
  return format == kDouble ? 3u << (reg & 30) : 1u << reg;
}

std::uint64_t clocks(unsigned n) { return n >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << n) - 1; }

}  // namespace

void ClockedUnits::begin() {
  for (Operation& operation : units_) operation.left -= operation.left != 0;
  adder_ >>= 1;
}

std::uint32_t ClockedUnits::pending() const {
  std::uint32_t registers = 0;
  for (const Operation& operation : units_)
    if (operation.left != 0) registers |= operation.registers;
  return registers;
}

ClockedUnits::Registers ClockedUnits::registers_of(std::uint32_t word) {
  const unsigned format = word >> 21 & 31, operation = word & 63;
  const unsigned ft = word >> 16 & 31, fs = word >> 11 & 31, fd = word >> 6 & 31;
  const bool real = format == kSingle || format == kDouble;
  const std::uint32_t source = mask_of(format, fs);
  switch (operation) {
    case kAdd:
    case kSub:
    case kMul:
    case kDiv:
      if (!real) return {};
      return {source | mask_of(format, ft), mask_of(format, fd), false};
    case kAbs:
    case kMov:
    case kNeg:
      if (!real) return {};
      return {source, mask_of(format, fd), false};
    case kCvtS:
      if (format != kDouble && format != kWord) return {};
      return {source, mask_of(kSingle, fd), false};
    case kCvtD:
      if (format != kSingle && format != kWord) return {};
      return {source, mask_of(kDouble, fd), false};
    case kCvtW:
      if (!real) return {};
      return {source, mask_of(kWord, fd), false};
    default:
      if (!real || operation < kCompare) return {};
      return {source | mask_of(format, ft), 0, true};
  }
}

bool ClockedUnits::may_issue(std::uint32_t word) const {
  const Registers registers = registers_of(word);
  if ((registers.read | registers.written) & pending()) return false;
  const Demand demand = demand_of(word, timing_);
  if (demand.unit == Unit::kAdder)
    return (adder_ & clocks(demand.cycles)) == 0 && !(registers.compares && comparing());
  if (unit(demand.unit).left != 0) return false;
  return timing_.rounding == 0 || (adder_ >> (demand.cycles - 1) & 1) == 0;
}

void ClockedUnits::issue(std::uint32_t word) {
  const Registers registers = registers_of(word);
  const Demand demand = demand_of(word, timing_);
  units_[static_cast<std::size_t>(demand.unit)] = {demand.cycles, registers.written, registers.compares};
  if (demand.unit == Unit::kAdder)
    adder_ |= clocks(demand.cycles);
  else if (timing_.rounding != 0)
    adder_ |= std::uint64_t{1} << (demand.cycles - 1);
}

}  // namespace dendro::r3010
