#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "models/machines/machine.h"
#include "models/machines/pixel_planes/pixel_planes_spec.h"
#include "models/machines/pixel_planes/pixel_planes_state.h"
#include "models/machines/pixel_planes/timing.h"
#include "models/parts/igc/igc.h"

namespace dendro::pixel_planes {

/// FIFO, translator, controller, tree and pixels at one level, without a host. Clocks do not go back. Throws UserError
/// for what the machine refuses.
class CommandUnit {
 public:
  virtual ~CommandUnit() = default;

  /// Stands idle before clock `clock`. First call.
  virtual void begin(std::int64_t clock, const igc::ControllerState& controller, const std::vector<Plane>& memory) = 0;
  /// A word is offered in `clock`. Returns the clock in which it lands.
  virtual std::int64_t offer(std::int64_t clock, std::uint32_t word) = 0;
  /// Words in the FIFO at the beginning of the clock in which the last word of a command landed. Right after that.
  virtual std::size_t words_before() const = 0;
  /// Half of a word of the control store is written in `clock`.
  virtual void store(std::int64_t clock, std::uint32_t address, std::uint32_t value) = 0;
  virtual bool busy(std::int64_t clock) = 0;
  /// A command has some of its words.
  virtual bool lacks_words() const = 0;
  /// The first clock from `clock` on at which it is idle; it stands there then. No command lacks words.
  virtual std::int64_t idle_from(std::int64_t clock) = 0;
  /// Goes on until so many commands are done: no more than have been offered whole.
  virtual void finish(std::size_t commands) = 0;
  /// Clocks of the commands that are done by now, in order.
  virtual const std::vector<CommandTimes>& done() const = 0;
  /// Of an idle unit.
  virtual Plane plane(unsigned bit) = 0;
};

std::unique_ptr<CommandUnit> make_command_unit(const Spec& spec, Level level);

}  // namespace dendro::pixel_planes
