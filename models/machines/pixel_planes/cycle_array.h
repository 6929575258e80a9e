#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "models/machines/pixel_planes/bit_array.h"
#include "models/machines/pixel_planes/timing.h"

namespace dendro::pixel_planes {

/// Tree and pixels at level `cycle`, word by word and exactly, E, C and D included: the tree's bits in closed form, words
/// in the clock in which they take effect. Streams must not spill into each other. Clocks must not go back.
class CycleArray {
 public:
  explicit CycleArray(const Spec& spec);

  /// The next word sent begins a stream with these coefficients.
  void start(std::int64_t a, std::int64_t b, std::int64_t c);
  /// A word goes out in `clock`. Returns the first clock at whose beginning its effect is there; nothing for a stolen clock.
  std::optional<std::int64_t> send(std::int64_t clock, const igc::ArrayWord& word);
  /// The first clock from `clock` on that is not stolen.
  std::int64_t first_free(std::int64_t clock) { return stolen_.first_free(clock); }
  /// The state at the beginning of `clock`.
  void go_to(std::int64_t clock);

  /// As of the last go_to().
  ArrayState& state() { return state_; }

 private:
  struct Sent {
    std::int64_t visible = 0;
    std::size_t stream = 0;  ///< number in streams_
    ArrayStep step;
  };

  void move_position(std::int64_t clock);

  Spec spec_;
  StolenClocks stolen_;
  ArrayState state_;
  std::vector<igc::Command> streams_{1};  ///< before the first: zeros
  std::deque<Sent> sent_;
  bool starts_ = false, begun_ = false;
  std::int64_t last_ = 0;      ///< clock of the last word
  std::int64_t position_ = 0;  ///< of its bit in its stream, leading zeros included
};

}  // namespace dendro::pixel_planes
