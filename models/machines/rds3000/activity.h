#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "models/machines/rds3000/rds3000_state.h"

namespace dendro::rds3000 {

/// The counters of an engine's units before a tick. An access is booked whole where it is granted; at `cycle`, where
/// it asks.
struct Standing {
  std::int64_t tick = 0;
  ProcessorCounters processor;
  BusCounters bus;
  MemoryCounters memory;
};

/// Standings at equal distances. Nobody knows how long a run will be, so the distance doubles whenever there are too
/// many.
class ActivityLog {
 public:
  /// Keeps fewer than `most` standings, which is even.
  explicit ActivityLog(std::size_t most) : most_(most) {}

  /// The tick before which the next standing is to be taken.
  std::int64_t next() const { return next_; }

  void take(const ProcessorCounters& processor, const BusCounters& bus, const MemoryCounters& memory) {
    standings_.push_back({next_, processor, bus, memory});
    if (standings_.size() == most_) halve();
    next_ = standings_.back().tick + distance_;
  }

  const std::vector<Standing>& standings() const { return standings_; }

 private:
  static constexpr std::int64_t kFirstDistance = 256;

  void halve() {
    std::vector<Standing> kept;
    for (std::size_t i = 1; i < standings_.size(); i += 2) kept.push_back(standings_[i]);
    standings_ = std::move(kept);
    distance_ *= 2;
  }

  std::size_t most_;
  std::int64_t distance_ = kFirstDistance, next_ = kFirstDistance;
  std::vector<Standing> standings_;
};

}  // namespace dendro::rds3000
