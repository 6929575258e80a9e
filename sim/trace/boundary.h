#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace dendro::trace {

/// One operation of a boundary: what may stand in its records.
struct Op {
  std::string name;
  std::size_t least = 0, most = 0;        ///< values before the arrow
  std::vector<std::string> keys;          ///< before the arrow
  bool checks_time = false, checks_data = false;
  std::vector<std::string> checked_keys;  ///< after the arrow
  std::vector<std::string> singles = {};  ///< of the keys before the arrow, those that may have a point
};

/// Where a unit can be cut out of its machine.
struct Boundary {
  std::string name;  ///< of the unit in the statistics: "rds3000.frame_memory"
  std::vector<Op> ops;

  const Op* find(const std::string& op) const {
    for (const Op& candidate : ops)
      if (candidate.name == op) return &candidate;
    return nullptr;
  }
};

/// What a replay found.
struct ReplayResult {
  std::int64_t transactions = 0;          ///< records driven
  std::int64_t cycles = 0;                ///< ticks of the trace, from its first to the last that the unit lived through
  std::optional<std::string> difference;  ///< the first: "FILE:LINE: what"; none: the unit does what the trace says
};

}  // namespace dendro::trace
