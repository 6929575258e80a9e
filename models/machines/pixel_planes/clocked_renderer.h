#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "models/machines/pixel_planes/clocked_array_side.h"
#include "models/machines/pixel_planes/clocked_front.h"
#include "models/machines/pixel_planes/pixel_planes_spec.h"
#include "models/machines/pixel_planes/pixel_planes_state.h"

namespace dendro::pixel_planes {

/// FIFO, translator, controller, tree and array of one renderer, one clock at a time.
class ClockedRenderer {
 public:
  explicit ClockedRenderer(const Spec& spec);

  /// Clock n, which `thief` takes (kBusy: nobody does). What the clock was used for.
  ClockedCause clock(std::int64_t n, ClockedCause thief);
  /// Before clock(n): what stays to be seen of the state at the clock's beginning.
  void begin(std::int64_t n);

  /// The command of the controller in the last clock; null: it had none.
  const igc::Header* at_work() const { return at_work_ ? &header_ : nullptr; }
  /// The last clock ended a copy.
  bool copied() const { return copied_; }
  const igc::Command& command() const { return controller_.command(); }
  /// Why a command cannot be run; the run ends.
  const std::string& error() const { return error_; }

  void land(std::uint32_t word, std::int64_t n);
  /// Is there room for a word in clock n, when `next` is the first clock that has not been worked out?
  bool room_at(std::int64_t n, std::int64_t next) const;
  bool can_land_in(std::int64_t n) const { return last_landed_ < n; }
  std::size_t fifo_words() const { return fifo_.size(); }
  bool has_room() const { return fifo_.size() < static_cast<std::size_t>(spec_.fifo_words); }
  void store(std::int64_t clock, std::uint32_t index, std::uint32_t value) { writes_.push_back({clock, index, value}); }
  std::uint32_t load(std::uint32_t index) const;

  bool idle_now() const { return fifo_.empty() && behind_fifo_idle(); }
  /// At the beginning of the last clock; what landed in it counts.
  bool idle_before() const { return idle_before_ && fifo_.empty(); }
  bool cannot_become_idle() const;

  ControllerCounters counters;
  FifoCounters fifo_counters;

  // For waveforms.
  std::size_t fifo_before() const { return fifo_before_; }
  bool was_idle() const { return idle_before_; }
  const ClockedTranslator& translator() const { return translator_; }
  const ClockedController& controller() const { return controller_; }
  ClockedController& controller() { return controller_; }  ///< to be given a state before the first clock
  ClockedArraySide& array() { return array_; }

 private:
  struct Write {
    std::int64_t clock = 0;
    std::uint32_t index = 0, value = 0;
  };

  ClockedCause cause_of(std::int64_t n, ClockedCause thief) const;
  void count(ClockedCause cause);
  void move_array(bool ready);
  void take();
  bool behind_fifo_idle() const;

  Spec spec_;
  ClockedFifo fifo_;
  ClockedTranslator translator_;
  ClockedController controller_;
  ClockedArraySide array_;
  std::deque<Write> writes_;
  std::int64_t last_landed_ = -1;
  bool idle_before_ = true;      ///< at the beginning of the last clock
  std::size_t fifo_before_ = 0;  ///< words there then
  bool at_work_ = false, copied_ = false;
  igc::Header header_;
  std::string error_;
};

/// Tiles as they were when they were copied, a word of 32 bits after another.
class ClockedFrame {
 public:
  explicit ClockedFrame(const Spec& spec) : spec_(spec) {}

  void copy(unsigned column, unsigned row, igc::ClockedPlanes& planes);
  std::uint32_t peek(std::uint32_t pixel, unsigned low) const;

 private:
  Spec spec_;
  std::map<std::pair<unsigned, unsigned>, std::vector<std::uint32_t>> tiles_;
};

}  // namespace dendro::pixel_planes
