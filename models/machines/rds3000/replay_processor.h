#pragma once

#include <cstdint>
#include <memory>

#include "models/machines/rds3000/rds3000_spec.h"
#include "models/machines/rds3000/rds3000_state.h"
#include "models/parts/video/video_timing.h"

namespace dendro::rds3000 {

/// What the bus will answer to the next access.
struct Answer {
  std::uint32_t data = 0;
  std::int64_t takes = 1;  ///< ticks from the word that starts the access to its completion
};

/// An access that the processor started.
struct Started {
  bool seen = false, write = false;
  std::uint32_t address = 0, data = 0;
  unsigned function = 0;
  std::int64_t tick = 0;
};

/// The processor without its machine, at one level.
class ProcessorUnit {
 public:
  virtual ~ProcessorUnit() = default;
  /// Stands before `tick`, with nothing under way. First call, but for display().
  virtual void load(const ProcessorState& state, std::int64_t tick) = 0;
  /// Lives through the ticks before `end`, or until it halts, or until it has started an access. An access without
  /// an answer is told and not carried out: nothing may be asked of the unit after that.
  virtual Started run(std::int64_t end, const Answer* answer) = 0;
  /// The host reaches its board at the end of `tick`, the last that run() has lived through.
  virtual std::uint32_t host_access(std::int64_t tick, bool write, std::uint32_t address, std::uint32_t data) = 0;
  /// The interface's command at `tick`, likewise: run, reset, or neither, which halts.
  virtual void command(std::int64_t tick, bool run, bool reset) = 0;
  /// Blanking and field after `tick`.
  virtual void display(std::int64_t tick, const video::Phase& phase) = 0;
  virtual const ProcessorState& state() const = 0;
  /// The first tick not lived through, while it runs; else the one after the last.
  virtual std::int64_t now() const = 0;
};

std::unique_ptr<ProcessorUnit> make_cycle_unit(const Spec& spec);
std::unique_ptr<ProcessorUnit> make_clocked_unit(const Spec& spec);

}  // namespace dendro::rds3000
