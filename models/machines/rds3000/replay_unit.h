#pragma once

#include <algorithm>
#include <cstdint>

#include "models/machines/machine.h"
#include "models/machines/rds3000/rds3000_spec.h"
#include "sim/trace/replayer.h"

namespace dendro::rds3000 {

/// Replays a trace whose times are ticks: Unit(spec, level, replayer) takes one record after another.
template <class Unit>
trace::ReplayResult replay_unit(const Spec& spec, Level level, trace::Reader& trace) {
  trace::Replayer replayer(trace, INT64_MAX / 16 / spec.processor.tick_ps);
  Unit unit(spec, level, replayer);
  std::int64_t first = -1;
  trace::ReplayResult result = replayer.run([&](const trace::Record& record) {
    const std::int64_t at = replayer.tick_of(record);
    if (first < 0) first = at;
    unit.take(record, at);
  });
  result.cycles = std::max<std::int64_t>(0, replayer.completed() - std::max<std::int64_t>(first, 0));
  return result;
}

}  // namespace dendro::rds3000
