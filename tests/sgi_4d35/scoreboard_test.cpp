#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

#include "models/parts/r3010/r3010_scoreboard.h"

namespace dendro::r3010 {
namespace {

struct UnderWay {
  std::uint32_t word;
  std::uint64_t start, end;
  Unit unit;
};

/// Registers of an operand, from the encoding and not from Issue.
void add(std::set<unsigned>& set, unsigned reg, bool twice) {
  set.insert(twice ? reg & 30 : reg);
  if (twice) set.insert(reg | 1);
}
std::set<unsigned> written(std::uint32_t word) {
  std::set<unsigned> set;
  const unsigned operation = word & 63, format = word >> 21 & 31;
  if (!exists(format, operation)) return set;
  if (operation >= kCompare) return {kConditionRegister};
  const bool wide = operation == kCvtD || (format == kDouble && operation != kCvtS && operation != kCvtW);
  add(set, word >> 6 & 31, wide);
  return set;
}
std::set<unsigned> touched(std::uint32_t word) {
  std::set<unsigned> set = written(word);
  const unsigned operation = word & 63, format = word >> 21 & 31;
  if (!exists(format, operation)) return set;
  add(set, word >> 11 & 31, format == kDouble);
  if (operation <= kDiv || operation >= kCompare) add(set, word >> 16 & 31, format == kDouble);
  return set;
}

/// The sheet's conditions in clock t, looked up among everything that was ever issued.
bool may_issue(std::uint32_t word, std::uint64_t t, const std::vector<UnderWay>& all, const Timing& timing) {
  const Demand demand = demand_of(word, timing);
  const std::uint64_t last = t + demand.cycles - 1;
  const std::set<unsigned> mine = touched(word);
  for (const UnderWay& o : all) {
    if (o.end > t) {
      if (o.unit == demand.unit) return false;
      for (const unsigned reg : written(o.word))
        if (mine.count(reg)) return false;
    }
    const bool rounds = timing.rounding != 0 && o.unit != Unit::kAdder;
    const std::uint64_t from = o.unit == Unit::kAdder ? o.start : o.end - 1;  // of its time in the adder
    if (o.unit != Unit::kAdder && !rounds) continue;
    const bool adder = demand.unit == Unit::kAdder;
    if (!adder && timing.rounding == 0) continue;
    const std::uint64_t begin = adder ? t : last;
    if (from <= last && begin < o.end) return false;
  }
  return true;
}

/// What take() of the word's kind says.
std::uint64_t taken(Scoreboard& board, std::uint32_t word, const Issue& issue, std::uint64_t now) {
  const auto format = static_cast<Format>(word >> 21 & 31);
  const unsigned operation = word & 63;
  const bool wide = format == kDouble;
  if (operation == kMul) return wide ? board.take<Unit::kMultiplier, 15, 3>(issue, now) : board.take<Unit::kMultiplier, 5, 1>(issue, now);
  if (operation == kDiv) return wide ? board.take<Unit::kDivider, 15, 3>(issue, now) : board.take<Unit::kDivider, 5, 1>(issue, now);
  if (operation >= kCompare) return wide ? board.take<Unit::kAdder, 15, 1>(issue, now) : board.take<Unit::kAdder, 5, 1>(issue, now);
  if (operation <= kSub) return wide ? board.take<Unit::kAdder, 15, 3>(issue, now) : board.take<Unit::kAdder, 5, 1>(issue, now);
  if (operation == kCvtD) return board.take<Unit::kAdder, 1, 3>(issue, now);
  if (operation == kCvtS || operation == kCvtW) return wide ? board.take<Unit::kAdder, 3, 1>(issue, now) : board.take<Unit::kAdder, 1, 1>(issue, now);
  return wide ? board.take<Unit::kAdder, 3, 3>(issue, now) : board.take<Unit::kAdder, 1, 1>(issue, now);
}

TEST(Scoreboard, ReadyTimesAreTheSheetsConditionsInEveryClock) {
  static constexpr unsigned kOperations[] = {kAdd, kSub, kMul, kMul, kDiv, kAbs, kMov, kNeg, kCvtS, kCvtD, kCvtW, kCompare, 17};
  for (std::uint32_t seed = 1; seed <= 300; ++seed) {
    std::mt19937 random(seed);
    const auto draw = [&random](unsigned low, unsigned high) { return low + static_cast<unsigned>(random() % (high - low + 1)); };
    Timing timing;
    timing.add = draw(1, 4), timing.compare = draw(1, 4), timing.move = draw(1, 2);
    timing.multiply_single = draw(1, 6), timing.multiply_double = draw(1, 8);
    timing.divide_single = draw(1, 14), timing.divide_double = draw(1, 20);
    timing.word_to_float = draw(1, 4), timing.rounding = draw(0, 1);
    Scoreboard board(timing);
    std::vector<UnderWay> all;
    std::uint64_t now = 1;
    for (int i = 0; i < 150; ++i) {
      static constexpr Format kFormats[] = {kSingle, kDouble, kDouble, kWord};
      const std::uint32_t word = fp_word(kFormats[draw(0, 3)], kOperations[draw(0, 12)], draw(0, 7), draw(0, 7), draw(0, 7));
      const Issue issue = issue_of(word, timing);
      std::uint64_t t = now;
      while (!may_issue(word, t, all, timing)) ++t;
      ASSERT_EQ(t, board.when(issue, now)) << "seed " << seed << " word " << i;
      if (exists(word >> 21 & 31, word & 63) && draw(0, 1) == 0)
        ASSERT_EQ(t, taken(board, word, issue, now)) << "seed " << seed << " word " << i;
      else
        board.issue(issue, t);
      all.push_back({word, t, t + issue.cycles, issue.unit});
      const unsigned reg = draw(0, 7);
      std::uint64_t ready = t + 1, empty = t + 1;
      for (const UnderWay& o : all) {
        if (written(o.word).count(reg)) ready = std::max(ready, o.end);
        empty = std::max(empty, o.end);
      }
      ASSERT_EQ(ready, board.when_register(reg, t + 1)) << "seed " << seed;
      ASSERT_EQ(empty, board.when_empty(t + 1)) << "seed " << seed;
      now = t + 1 + draw(0, 3);
    }
  }
}

}  // namespace
}  // namespace dendro::r3010
