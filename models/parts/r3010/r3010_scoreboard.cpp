#include "models/parts/r3010/r3010_scoreboard.h"

namespace dendro::r3010 {
namespace {

/// The one or two registers of an operand.
void operand(std::uint8_t* regs, unsigned reg, bool twice) {
  regs[0] = static_cast<std::uint8_t>(twice ? reg & 30 : reg);
  if (twice) regs[1] = static_cast<std::uint8_t>(reg | 1);
}

bool result_is_double(unsigned format, unsigned operation) {
  if (operation == kCvtD) return true;
  return format == kDouble && operation != kCvtS && operation != kCvtW;
}

}  // namespace

Issue issue_of(std::uint32_t word, const Timing& timing) {
  const unsigned format = word >> 21 & 31, operation = word & 63;
  const Demand demand = demand_of(word, timing);
  Issue o = {{kNoRegister, kNoRegister, kNoRegister, kNoRegister},
             {kNoRegister, kNoRegister},
             demand.unit,
             demand.cycles};
  if (!exists(format, operation)) return o;
  const bool compare = operation >= kCompare;
  operand(o.reads, word >> 11 & 31, format == kDouble);
  if (operation <= kDiv || compare) operand(o.reads + 2, word >> 16 & 31, format == kDouble);
  if (compare)
    o.writes[0] = kConditionRegister;
  else
    operand(o.writes, word >> 6 & 31, result_is_double(format, operation));
  return o;
}

}  // namespace dendro::r3010
