#pragma once

#include <cstdint>
#include <deque>
#include <memory>

#include "models/machines/pixel_planes/cycle_board.h"
#include "sim/trace/trace_file.h"

namespace dendro::pixel_planes {

/// Writes down what passes one boundary of the cycle machine, in the order of time. The window opens with the first
/// access of the host in it that finds the machine idle, and closes between two commands. Ticks are clocks.
class Recorder {
 public:
  Recorder(trace::Writer& out, const Spec& spec, CycleBoard& board) : out_(out), spec_(spec), board_(board) {}
  virtual ~Recorder() = default;

  /// The host writes in `tick`; the board has not seen it yet.
  void before(std::int64_t tick);
  /// A word was offered to the FIFO in `tick` and landed in clock `landed`.
  virtual void word(std::int64_t /*tick*/, std::uint32_t /*value*/, std::int64_t /*landed*/) {}
  /// The last word made this command whole; it has been carried out.
  virtual void command(const Device::Done& done, const CommandTimes& times) = 0;
  virtual void write(std::int64_t /*tick*/, std::uint32_t /*address*/, std::uint32_t /*value*/) {}
  void status(std::int64_t tick, std::uint32_t value);
  /// The host begins to wait for an idle machine.
  void wait(std::int64_t tick);
  /// The run ends at this clock.
  void end(std::int64_t tick);

 protected:
  bool active() const { return begun_ && !ended_; }
  virtual void write_state(std::int64_t tick) = 0;
  virtual void write_end(std::int64_t tick, bool of_run) = 0;
  virtual void seen_status(std::int64_t /*tick*/, std::uint32_t /*value*/) {}
  virtual void seen_wait(std::int64_t /*tick*/) {}

  trace::Writer& out_;
  Spec spec_;
  CycleBoard& board_;

 private:
  bool begun_ = false, ended_ = false;
};

/// The recorder of the writer's boundary.
std::unique_ptr<Recorder> make_recorder(trace::Writer& out, const Spec& spec, CycleBoard& board);

}  // namespace dendro::pixel_planes
