#include "models/parts/r3010/r3010_timing.h"

namespace dendro::r3010 {

Demand demand_of(std::uint32_t word, const Timing& timing) {
  const unsigned format = word >> 21 & 31, operation = word & 63;
  const bool twice = format == kDouble;
  const auto demand = [](Unit unit, unsigned cycles) {
    return Demand{unit, static_cast<std::uint8_t>(cycles)};
  };
  switch (operation) {
    case kAdd:
    case kSub:
      return demand(Unit::kAdder, timing.add);
    case kMul:
      return demand(Unit::kMultiplier, twice ? timing.multiply_double : timing.multiply_single);
    case kDiv:
      return demand(Unit::kDivider, twice ? timing.divide_double : timing.divide_single);
    case kCvtS:
      return demand(Unit::kAdder, format == kWord ? timing.word_to_float : timing.double_to_single);
    case kCvtD:
      return demand(Unit::kAdder, format == kWord ? timing.word_to_float : timing.single_to_double);
    case kCvtW:
      return demand(Unit::kAdder, timing.float_to_word);
    default:
      return demand(Unit::kAdder, operation >= kCompare ? timing.compare : timing.move);
  }
}

}  // namespace dendro::r3010
