#pragma once

#include <algorithm>
#include <cstdint>

#include "models/parts/r3010/r3010_timing.h"

namespace dendro::r3010 {

/// What an arithmetic word asks for, worked out once: registers, unit, clocks.
struct Issue {
  std::uint8_t reads[4];   ///< a register each; kNoRegister where there is none
  std::uint8_t writes[2];  ///< the condition counts as one
  Unit unit;
  std::uint8_t cycles;
};

constexpr unsigned kNoRegister = 32, kConditionRegister = 33;

Issue issue_of(std::uint32_t word, const Timing& timing);

/// Units and registers of the R3010 in absolute clocks. A word that is in the R3000's ALU stage from clock
/// `now` on issues in the clock that is returned. Rules: README.md, chapter Time.
class Scoreboard {
 public:
  explicit Scoreboard(const Timing& timing) : rounding_(timing.rounding != 0) {}

  /// The clock in which the word could issue.
  std::uint64_t when(const Issue& o, std::uint64_t now) const {
    std::uint64_t t = std::max(now, unit_free_[static_cast<unsigned>(o.unit)]);
    for (const std::uint8_t reg : o.reads) t = std::max(t, ready_[reg]);
    for (const std::uint8_t reg : o.writes) t = std::max(t, ready_[reg]);
    return rounding_ ? clear_of_rounding(o, t) : t;
  }
  /// It issues in clock `t`.
  void issue(const Issue& o, std::uint64_t t) {
    const std::uint64_t end = t + o.cycles;
    unit_free_[static_cast<unsigned>(o.unit)] = end;
    ready_[o.writes[0]] = ready_[o.writes[1]] = end;
    ready_[kNoRegister] = 0;
    if (rounding_ && o.unit != Unit::kAdder) rounds_[o.unit == Unit::kDivider] = end - 1;
  }
  /// when() and issue() in one, for words of one kind: bit i of kReads and kWrites says that operand i counts.
  template <Unit kUnit, unsigned kReads, unsigned kWrites>
  std::uint64_t take(const Issue& o, std::uint64_t now) {
    constexpr auto unit = static_cast<unsigned>(kUnit);
    std::uint64_t t = std::max(now, unit_free_[unit]);
    for (unsigned i = 0; i < 4; ++i)
      if (kReads >> i & 1) t = std::max(t, ready_[o.reads[i]]);
    for (unsigned i = 0; i < 2; ++i)
      if (kWrites >> i & 1) t = std::max(t, ready_[o.writes[i]]);
    if (rounding_ && (kUnit != Unit::kAdder || std::max(rounds_[0], rounds_[1]) >= t)) t = clear_of_rounding(o, t);
    const std::uint64_t end = t + o.cycles;
    unit_free_[unit] = end;
    for (unsigned i = 0; i < 2; ++i)
      if (kWrites >> i & 1) ready_[o.writes[i]] = end;
    if (kUnit != Unit::kAdder && rounding_) rounds_[kUnit == Unit::kDivider] = end - 1;
    return t;
  }
  /// It could have issued before `now`, and the pipeline stood: when it can from `now` on. Only the clocks in which
  /// another unit rounds can come in between.
  std::uint64_t when_still(const Issue& o, std::uint64_t now) const {
    return rounding_ ? clear_of_rounding(o, now) : now;
  }
  /// A move that reads or writes a register; kConditionRegister for a branch on the condition.
  std::uint64_t when_register(unsigned reg, std::uint64_t now) const { return std::max(now, ready_[reg]); }
  /// Nothing is under way in any unit.
  std::uint64_t when_empty(std::uint64_t now) const {
    return std::max(std::max(now, unit_free_[0]), std::max(unit_free_[1], unit_free_[2]));
  }

 private:
  std::uint64_t clear_of_rounding(const Issue& o, std::uint64_t t) const {
    if (o.unit == Unit::kAdder) {
      for (bool moved = true; moved;) {
        moved = false;
        for (const std::uint64_t clock : rounds_)
          if (clock >= t && clock < t + o.cycles) t = clock + 1, moved = true;
      }
      return t;
    }
    const std::uint64_t other = rounds_[o.unit != Unit::kDivider];
    while (t + o.cycles - 1 < unit_free_[0] || t + o.cycles - 1 == other) ++t;
    return t;
  }

  bool rounding_;
  std::uint64_t ready_[34] = {};
  std::uint64_t unit_free_[3] = {};
  std::uint64_t rounds_[2] = {};  ///< clock in which the multiplier, the divider takes the adder; 0: none
};

}  // namespace dendro::r3010
