#pragma once

#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "models/machines/pixel_planes/pixel_planes_spec.h"
#include "models/machines/pixel_planes/pixel_planes_state.h"

namespace dendro::pixel_planes {

/// The first event of a period of `interval_ps` > 0, counted from one period on, that is due in clock `clock` or later.
std::int64_t first_event_ps(std::int64_t interval_ps, std::int64_t tick_ps, std::int64_t clock);

/// The clocks that refresh and video take from the array, in order. Questions must not go back in time.
class StolenClocks {
 public:
  explicit StolenClocks(const Spec& spec);

  struct Stolen {
    std::int64_t clock = 0;
    bool video = false;
  };

  /// The first clock from `from` on that is not stolen.
  std::int64_t first_free(std::int64_t from);
  /// The clock that lies `count` free clocks behind the free clock `from`.
  std::int64_t advance(std::int64_t from, std::uint64_t count);
  /// Stolen clocks in [from, to), refresh and video.
  std::pair<std::uint64_t, std::uint64_t> count(std::int64_t from, std::int64_t to);
  /// Clocks before this are not asked for any more.
  void skip(std::int64_t clock);
  /// The same, for a clock that is not far ahead of those asked for.
  void forget(std::int64_t before);

 private:
  void fill(std::int64_t to);

  std::int64_t tick_ps_, refresh_ps_, video_ps_;
  std::int64_t next_refresh_ps_, next_video_ps_;
  std::int64_t filled_ = 0;  ///< every stolen clock before this is in the list
  std::deque<Stolen> list_;
};

/// When a command is in the controller.
struct CommandTimes {
  std::int64_t taken = 0;  ///< clock of its first word
  std::int64_t free = 0;   ///< clock behind its last word
};

/// Clocks of FIFO, translator and controller in closed form, by the rules of models/parts/igc/README.md.
class Timing {
 public:
  explicit Timing(const Spec& spec);

  /// A word is offered at `host_ps`; returns when the host can go on.
  std::int64_t offer_word(std::int64_t host_ps);
  /// All words of a command have been offered: it sends `words` words.
  CommandTimes command(unsigned fifo_words, bool expression, std::uint64_t words);
  /// First clock at which the machine is idle, if nothing more is offered.
  std::int64_t idle_from() const { return idle_from_; }
  /// Words in the FIFO at the beginning of the clock in which the last command's last word lands.
  std::size_t words_before_last() const;
  /// The run ends at this clock; closes the counters.
  void finish(std::int64_t end);

  const ControllerCounters& controller() const { return controller_; }
  const FifoCounters& fifo() const { return fifo_; }

 private:
  void book_gap(std::int64_t visible);

  Spec spec_;
  StolenClocks stolen_;
  std::deque<std::int64_t> landed_;   ///< clocks of the words not yet belonging to a command
  std::deque<std::int64_t> popped_;   ///< clock in which each of the last fifo_words words left
  std::int64_t last_landed_ = -1;
  std::int64_t translator_free_ = 0;  ///< from this clock on
  std::int64_t controller_free_ = 0;
  std::int64_t idle_from_ = 0;
  std::uint64_t offered_ = 0, taken_ = 0;  ///< words
  ControllerCounters controller_;
  FifoCounters fifo_;
};

}  // namespace dendro::pixel_planes
