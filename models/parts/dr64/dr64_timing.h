#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "models/parts/dr64/dr64.h"
#include "models/parts/dr64/dr64_counters.h"
#include "models/parts/video/video_timing.h"

namespace dendro::dr64 {

/// When the cards are granted: accesses, refreshes and video fetches in one order of time, without events.
/// Ask in order of time: every request must lie after the grant before it.
class Timing {
 public:
  Timing(const Spec& spec, std::int64_t tick_ps)
      : spec_(spec), tick_ps_(tick_ps), cards_(spec.cards()) {
    next_refresh();
    aim();
  }

  /// Replaces the video fetches from here on.
  void set_fetches(const video::FetchCursor& cursor) {
    fetches_ = cursor;
    aim();
  }

  /// The tick at which an access that asks at tick `request` gets all cards of `work`.
  std::int64_t grant(std::int64_t request, const Work& work, bool write) {
    const std::int64_t granted = wait_for(request, work.cards);
    const int busy = spec_.card_busy_ticks + (work.masked ? spec_.masked_write_extra_ticks : 0);
    unsigned taken = 0;
    for (unsigned card = 0; card < cards_; ++card) {
      if ((work.cards >> card & 1) == 0) continue;
      free_at_[card] = granted + busy;
      ++taken;
    }
    counters_.busy_access += static_cast<unsigned>(busy) * taken;
    counters_.wait_ticks += static_cast<std::uint64_t>(granted - request);
    (write ? counters_.writes : counters_.reads) += 1;
    counters_.masked_writes += work.masked;
    return granted;
  }

  /// Lets every event before tick `end` take its cards, now or as soon as they are free.
  void catch_up(std::int64_t end) {
    while (next_event_ < end) serve(video::kNever);
  }

  /// Serves what is granted before tick `end`, and counts no more: for the end of a run.
  void settle(std::int64_t end) {
    while (next_event_ < end) serve(end);
  }

  const Counters& counters() const { return counters_; }

  /// The counters that a run would have which ended at tick `at`. Every later request must be at `at` - 1 or after.
  Counters counters_before(std::int64_t at) {
    // Events that every card takes before `at` count whatever comes later: served here, they are not served again
    // for the next question.
    while (next_event_ < at && *std::max_element(free_at_.begin(), free_at_.begin() + cards_) < at) serve(video::kNever);
    Timing rest = *this;
    rest.settle(at);
    return rest.counters_;
  }

  /// All that later grants depend on, next to the Spec: for a trace that begins in the middle.
  struct Standing {
    std::array<std::int64_t, 8> free_at{};                ///< tick from which each card is free
    std::int64_t next_refresh_ps = 0, next_fetch_ps = 0;  ///< times of the next events not served yet
  };
  /// The standing before tick `at`.
  Standing standing(std::int64_t at) const {
    Timing settled = *this;
    settled.settle(at);
    return {settled.free_at_, settled.refresh_ps_, settled.fetches_.time_ps()};
  }
  /// Goes on from a standing; set_fetches() brings the fetches.
  void resume(const Standing& standing) {
    free_at_ = standing.free_at;
    refresh_ps_ = standing.next_refresh_ps - spec_.refresh_interval_ps;
    next_refresh();
    aim();
  }

 private:
  std::int64_t wait_for(std::int64_t request, std::uint32_t cards) {
    for (;;) {
      std::int64_t free = request;
      for (unsigned card = 0; card < cards_; ++card)
        if (cards >> card & 1) free = std::max(free, free_at_[card]);
      if (__builtin_expect(next_event_ > free, 1)) return free;
      serve(video::kNever);
    }
  }

  // Takes every card for the next event; grants at or after `end` are not counted.
  void serve(std::int64_t end) {
    const bool refresh = refresh_tick_ <= fetches_.tick();
    const int busy = refresh ? spec_.card_busy_ticks : spec_.fetch_ticks;
    unsigned counted = 0;
    for (unsigned card = 0; card < cards_; ++card) {
      const std::int64_t start = std::max(free_at_[card], next_event_);
      free_at_[card] = start + busy;
      counted += start < end;
    }
    if (refresh) {
      counters_.refreshes += counted;
      counters_.busy_refresh += static_cast<unsigned>(busy) * counted;
      next_refresh();
    } else {
      counters_.fetches += counted;
      counters_.busy_video += static_cast<unsigned>(busy) * counted;
      fetches_.advance();
    }
    aim();
  }

  void next_refresh() {
    if (spec_.refresh_interval_ps == 0) return;
    refresh_ps_ += spec_.refresh_interval_ps;
    refresh_tick_ = (refresh_ps_ + tick_ps_ - 1) / tick_ps_;
  }

  void aim() { next_event_ = std::min(refresh_tick_, fetches_.tick()); }

  Spec spec_;
  std::int64_t tick_ps_;
  unsigned cards_;
  std::array<std::int64_t, 8> free_at_{};
  video::FetchCursor fetches_;
  std::int64_t refresh_ps_ = 0, refresh_tick_ = video::kNever;
  std::int64_t next_event_ = video::kNever;
  Counters counters_;
};

}  // namespace dendro::dr64
