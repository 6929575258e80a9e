#pragma once

#include <array>
#include <cstdint>

#include "models/parts/r3010/r3010_timing.h"

namespace dendro::r3010 {

/// Adder, multiplier and divider, a clock at a time: each holds one operation and counts its clocks down.
/// What words wait for: README.md, chapter Time.
class ClockedUnits {
 public:
  explicit ClockedUnits(const Timing& timing) : timing_(timing) {}

  /// The state moves on into the next clock.
  void begin();
  /// Whether an arithmetic word may issue in this clock.
  bool may_issue(std::uint32_t word) const;
  void issue(std::uint32_t word);

  bool under_way(unsigned reg) const { return pending() >> reg & 1; }
  bool comparing() const { return unit(Unit::kAdder).compares && unit(Unit::kAdder).left != 0; }
  bool idle() const { return (units_[0].left | units_[1].left | units_[2].left) == 0; }
  unsigned left(Unit which) const { return unit(which).left; }

 private:
  struct Operation {
    unsigned left = 0;            ///< clocks, this one included
    std::uint32_t registers = 0;  ///< that get its result
    bool compares = false;
  };
  /// The registers of a word as bit masks; none for a word that does not exist.
  struct Registers {
    std::uint32_t read = 0, written = 0;
    bool compares = false;
  };
  static Registers registers_of(std::uint32_t word);
  const Operation& unit(Unit which) const { return units_[static_cast<std::size_t>(which)]; }
  std::uint32_t pending() const;

  Timing timing_;
  std::array<Operation, 3> units_;
  std::uint64_t adder_ = 0;  ///< bit i: something has the adder i clocks from now
};

}  // namespace dendro::r3010
