#include "models/machines/machine.h"

namespace dendro {

const char* level_name(Level level) {
  switch (level) {
    case Level::kFunction: return "function";
    case Level::kEstimate: return "estimate";
    case Level::kCycle: return "cycle";
    default: return "clocked";
  }
}

trace::VcdWindow vcd_window(const MachineOptions& options, std::int64_t tick_ps) {
  const auto ps = [tick_ps](std::int64_t ticks) { return ticks > INT64_MAX / tick_ps ? INT64_MAX : ticks * tick_ps; };
  return {ps(options.vcd_from), ps(options.vcd_to), options.vcd_units};
}

}  // namespace dendro
