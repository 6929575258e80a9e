#include "models/machines/pixel_planes/timing.h"

#include <algorithm>

#include "sim/base/check.h"

namespace dendro::pixel_planes {

namespace {

/// An event that has to wait for its clock has it within so many: two sources, each with a period of at least 4 clocks.
constexpr std::int64_t kMostWaiting = 16;

}  // namespace

std::int64_t first_event_ps(std::int64_t interval_ps, std::int64_t tick_ps, std::int64_t clock) {
  const std::int64_t over_ps = std::max<std::int64_t>(0, (clock - 1) * tick_ps);  // due in `clock`: behind this
  return (over_ps / interval_ps + 1) * interval_ps;
}

StolenClocks::StolenClocks(const Spec& spec)
    : tick_ps_(spec.tick_ps),
      refresh_ps_(spec.refresh_interval_ps),
      video_ps_(spec.video_interval_ps),
      next_refresh_ps_(refresh_ps_ > 0 ? refresh_ps_ : INT64_MAX),
      next_video_ps_(video_ps_ > 0 ? video_ps_ : INT64_MAX) {}

void StolenClocks::fill(std::int64_t to) {
  while (filled_ < to) {
    const bool video = next_video_ps_ < next_refresh_ps_;
    std::int64_t& next = video ? next_video_ps_ : next_refresh_ps_;
    if (next == INT64_MAX) {
      filled_ = INT64_MAX;
      return;
    }
    const std::int64_t due = (next + tick_ps_ - 1) / tick_ps_;
    const std::int64_t clock = list_.empty() ? due : std::max(due, list_.back().clock + 1);
    list_.push_back({clock, video});
    next += video ? video_ps_ : refresh_ps_;
    filled_ = clock + 1;
  }
}

std::int64_t StolenClocks::first_free(std::int64_t from) {
  fill(from + 1);
  auto at = std::lower_bound(list_.begin(), list_.end(), from, [](const Stolen& s, std::int64_t c) { return s.clock < c; });
  for (;;) {
    if (at == list_.end()) {
      const std::size_t known = list_.size();
      fill(from + 1);
      if (list_.size() == known) return from;
      at = list_.begin() + static_cast<std::ptrdiff_t>(known);
      continue;
    }
    if (at->clock > from) return from;
    ++from, ++at;
  }
}

std::int64_t StolenClocks::advance(std::int64_t from, std::uint64_t count) {
  std::int64_t to = from + static_cast<std::int64_t>(count);
  fill(to + 1);
  auto at = std::lower_bound(list_.begin(), list_.end(), from, [](const Stolen& s, std::int64_t c) { return s.clock < c; });
  std::size_t index = static_cast<std::size_t>(at - list_.begin());
  while (index < list_.size() && list_[index].clock <= to) {
    ++to, ++index;
    fill(to + 1);
  }
  return to;
}

std::pair<std::uint64_t, std::uint64_t> StolenClocks::count(std::int64_t from, std::int64_t to) {
  std::pair<std::uint64_t, std::uint64_t> counts{0, 0};
  fill(to);
  auto at = std::lower_bound(list_.begin(), list_.end(), from, [](const Stolen& s, std::int64_t c) { return s.clock < c; });
  for (; at != list_.end() && at->clock < to; ++at) ++(at->video ? counts.second : counts.first);
  return counts;
}

void StolenClocks::skip(std::int64_t clock) {
  const std::int64_t from = clock - kMostWaiting;
  if (from <= filled_) return;
  list_.clear();
  if (refresh_ps_ > 0) next_refresh_ps_ = first_event_ps(refresh_ps_, tick_ps_, from);
  if (video_ps_ > 0) next_video_ps_ = first_event_ps(video_ps_, tick_ps_, from);
  filled_ = from;
}

void StolenClocks::forget(std::int64_t before) {
  // The last one stays: the next may have to stand behind it.
  while (list_.size() > 1 && list_[1].clock < before) list_.pop_front();
}

Timing::Timing(const Spec& spec) : spec_(spec), stolen_(spec) {}

std::int64_t Timing::offer_word(std::int64_t host_ps) {
  std::int64_t clock = std::max(host_ps / spec_.tick_ps, last_landed_ + 1);
  const auto depth = static_cast<std::uint64_t>(spec_.fifo_words);
  if (offered_ >= depth) {
    const std::uint64_t leaves_first = offered_ - depth;
    DENDRO_CHECK(leaves_first < taken_, "a command is longer than the FIFO of {} words", spec_.fifo_words);
    const std::size_t index = popped_.size() - static_cast<std::size_t>(taken_ - leaves_first);
    clock = std::max(clock, popped_[index] + 1);
  }
  const std::int64_t first = std::max(host_ps / spec_.tick_ps, last_landed_ + 1);
  fifo_.full_clocks += static_cast<std::uint64_t>(clock - first);
  ++fifo_.words;
  ++offered_;
  last_landed_ = clock;
  landed_.push_back(clock);
  return std::max(host_ps, clock * spec_.tick_ps);
}

/// Clocks between the last command and the moment the next one's first word can be seen.
void Timing::book_gap(std::int64_t visible) {
  const std::int64_t from = controller_free_;
  const std::int64_t drained = std::max(from, std::min(idle_from_, visible));
  controller_.stall_drain += static_cast<std::uint64_t>(drained - from);
  if (visible > drained) controller_.idle += static_cast<std::uint64_t>(visible - drained);
}

CommandTimes Timing::command(unsigned fifo_words, bool expression, std::uint64_t words) {
  DENDRO_CHECK(fifo_words >= 1 && landed_.size() >= fifo_words && words >= 1, "{} {}", fifo_words, landed_.size());
  const std::int64_t visible = landed_.front() + 1;
  std::int64_t pop = std::max(visible, translator_free_) - 1;
  for (unsigned k = 0; k < fifo_words; ++k) {
    pop = std::max(landed_.front() + 1, pop + 1);
    landed_.pop_front();
    popped_.push_back(pop);
    if (popped_.size() > static_cast<std::size_t>(spec_.fifo_words)) popped_.pop_front();
  }
  taken_ += fifo_words;
  ++fifo_.commands;
  const std::int64_t ready = pop + 1 + (expression ? spec_.setup_clocks : 0);
  const std::int64_t wanted = std::max(ready, controller_free_);
  book_gap(std::min(visible, wanted));
  const std::int64_t seen = std::max(visible, controller_free_);
  controller_.stall_translator += static_cast<std::uint64_t>(std::max<std::int64_t>(0, wanted - seen));

  CommandTimes times;
  stolen_.skip(wanted);
  times.taken = stolen_.first_free(wanted);
  times.free = stolen_.advance(times.taken, words - 1) + 1;
  const auto [refresh, video] = stolen_.count(wanted, times.free);
  controller_.stall_refresh += refresh, controller_.stall_video += video;
  controller_.busy += words;
  translator_free_ = times.taken + 1;
  controller_free_ = times.free;
  idle_from_ = stolen_.advance(times.free - 1, static_cast<std::uint64_t>(spec_.latency())) + 1;
  stolen_.forget(times.free);
  return times;
}

std::size_t Timing::words_before_last() const {
  // What has landed by then and leaves later; the last word itself leaves later, too.
  return static_cast<std::size_t>(popped_.end() - std::lower_bound(popped_.begin(), popped_.end(), last_landed_)) - 1;
}

void Timing::finish(std::int64_t end) { book_gap(end); }

}  // namespace dendro::pixel_planes
