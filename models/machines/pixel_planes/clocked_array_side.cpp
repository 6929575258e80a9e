#include "models/machines/pixel_planes/clocked_array_side.h"

#include <algorithm>

namespace dendro::pixel_planes {
namespace {

/// Clocks within which what is due has been taken.
constexpr std::int64_t kMostWaiting = 16;

igc::PlanesSpec planes_of(const Spec& spec) {
  igc::PlanesSpec planes;
  planes.levels_x = static_cast<unsigned>(spec.levels_x()),
  planes.levels_y = static_cast<unsigned>(spec.levels_y());
  planes.memory_bits = static_cast<unsigned>(spec.array.memory_bits);
  planes.ports = static_cast<unsigned>(spec.array.ports);
  planes.masked = spec.tree.masked;
  return planes;
}

}  // namespace

ClockedThieves::ClockedThieves(const Spec& spec)
    : spec_(spec),
      next_refresh_ps_(spec.refresh_interval_ps > 0 ? spec.refresh_interval_ps : INT64_MAX),
      next_video_ps_(spec.video_interval_ps > 0 ? spec.video_interval_ps : INT64_MAX) {}

ClockedCause ClockedThieves::steal(std::int64_t n) {
  const std::int64_t now_ps = n * spec_.tick_ps;
  while (next_refresh_ps_ <= now_ps || next_video_ps_ <= now_ps) {
    const bool refresh = next_refresh_ps_ <= next_video_ps_;
    due_.push_back(refresh ? ClockedCause::kRefresh : ClockedCause::kVideo);
    (refresh ? next_refresh_ps_ : next_video_ps_) +=
        refresh ? spec_.refresh_interval_ps : spec_.video_interval_ps;
  }
  if (due_.empty()) return ClockedCause::kBusy;
  const ClockedCause thief = due_.front();
  due_.pop_front();
  return thief;
}

void ClockedThieves::resume(std::int64_t n) {
  const std::int64_t from = std::max<std::int64_t>(0, n - kMostWaiting);
  const auto next = [&](std::int64_t interval_ps) {
    const std::int64_t passed = std::max<std::int64_t>(0, (from - 1) * spec_.tick_ps) / interval_ps;
    return (passed + 1) * interval_ps;
  };
  due_.clear();
  if (spec_.refresh_interval_ps > 0) next_refresh_ps_ = next(spec_.refresh_interval_ps);
  if (spec_.video_interval_ps > 0) next_video_ps_ = next(spec_.video_interval_ps);
  for (std::int64_t clock = from; clock < n; ++clock) steal(clock);
}

ClockedArraySide::ClockedArraySide(const Spec& spec)
    : feed_(static_cast<unsigned>(spec.levels_x() - 1), static_cast<unsigned>(spec.latency() - 1),
            static_cast<unsigned>(spec.tree.gap_clocks)),
      planes_(planes_of(spec)),
      way_(static_cast<std::size_t>(spec.latency())) {}

bool ClockedArraySide::clock(const igc::ArrayWord* word) {
  OnItsWay& slot = way_[way_at_];
  const OnItsWay arrived = slot;
  slot = {};
  way_at_ = (way_at_ + 1) % way_.size();
  if (word != nullptr) {
    slot = {true, *word};
    ++words_on_their_way_;
  }
  lines_ = feed_.clock();
  obeyed_ = arrived.word;
  planes_.clock(lines_, arrived.word);
  if (arrived.word_sent) --words_on_their_way_;
  return arrived.word_sent;
}

}  // namespace dendro::pixel_planes
