#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "models/machines/pixel_planes/device.h"
#include "models/machines/pixel_planes/timing.h"

namespace dendro::pixel_planes {

/// What stands behind the host at level `cycle`: commands are carried out when their last word is offered, and their
/// clocks follow in closed form. Times must not go back.
class CycleBoard {
 public:
  explicit CycleBoard(const Spec& spec) : spec_(spec), device_(spec, true), timing_(spec) {}

  /// A word that was offered to the FIFO.
  struct Offered {
    std::int64_t host_ps = 0;          ///< the host goes on
    std::optional<Device::Done> done;  ///< the command that it made whole
    CommandTimes times;                ///< of that
  };

  /// Throws what Device::write() throws.
  Offered offer(std::int64_t host_ps, std::uint32_t word);
  /// Writes something else than the FIFO. Throws UserError for a word of the control store that a command still runs.
  void write(std::int64_t host_ps, std::uint32_t address, std::uint32_t value);
  /// The status as the host reads it.
  bool busy(std::int64_t host_ps) const;
  /// Words of a command have been offered, but not all.
  bool lacks_words() const { return command_words_ > 0; }

  Device& device() { return device_; }
  const Device& device() const { return device_; }
  Timing& timing() { return timing_; }
  const Timing& timing() const { return timing_; }

 private:
  /// Words of the control store that a command runs, [entry, entry + words), until clock `free`.
  struct InUse {
    unsigned entry = 0, words = 0;
    std::int64_t free = 0;
  };

  void check_not_in_use(std::int64_t host_ps, std::uint32_t address);

  Spec spec_;
  Device device_;
  Timing timing_;
  unsigned command_words_ = 0;  ///< offered of the command that is not whole yet
  std::deque<InUse> in_use_;    ///< by commands offered, in order; those that have ended are dropped now and then
};

}  // namespace dendro::pixel_planes
