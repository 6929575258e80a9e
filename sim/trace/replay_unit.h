#pragma once

#include <algorithm>
#include <cstdint>

#include "sim/trace/replayer.h"

namespace dendro::trace {

/// What a replayed unit does besides taking records, if it has nothing to do there.
struct ReplayedUnit {
  /// Comes before the record's tick is asked for, which may count from the completion of the record in front.
  void before(const Record&) {}
  /// Checks what is still expected behind the last record.
  void finish() {}
};

/// Replays a trace whose times are ticks of `tick_ps`: Unit(spec, level, replayer) takes one record after another.
template <class Unit, class Spec, class Level>
ReplayResult replay_unit(const Spec& spec, std::int64_t tick_ps, Level level, Reader& reader) {
  Replayer replayer(reader, INT64_MAX / 16 / tick_ps);
  Unit unit(spec, level, replayer);
  std::int64_t first = -1;
  const auto take = [&](const Record& record) {
    unit.before(record);
    const std::int64_t at = replayer.tick_of(record);
    if (first < 0) first = at;
    unit.take(record, at);
  };
  ReplayResult result = replayer.run(take, [&] { unit.finish(); });
  result.cycles = std::max<std::int64_t>(0, replayer.completed() - std::max<std::int64_t>(first, 0));
  return result;
}

}  // namespace dendro::trace
