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

}  // namespace dendro
