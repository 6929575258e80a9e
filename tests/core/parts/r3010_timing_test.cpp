#include "models/parts/r3010/r3010_timing.h"

#include <gtest/gtest.h>

namespace dendro::r3010 {
namespace {

TEST(R3010Timing, DemandsAreThoseOfTheSheet) {
  struct Row {
    Format format;
    unsigned operation;
    Unit unit;
    unsigned cycles;
  };
  const Row rows[] = {{kSingle, kAdd, Unit::kAdder, 2},         {kDouble, kAdd, Unit::kAdder, 2},
                      {kSingle, kSub, Unit::kAdder, 2},         {kDouble, kSub, Unit::kAdder, 2},
                      {kSingle, kMul, Unit::kMultiplier, 4},    {kDouble, kMul, Unit::kMultiplier, 5},
                      {kSingle, kDiv, Unit::kDivider, 12},      {kDouble, kDiv, Unit::kDivider, 19},
                      {kSingle, kAbs, Unit::kAdder, 1},         {kDouble, kNeg, Unit::kAdder, 1},
                      {kDouble, kMov, Unit::kAdder, 1},         {kSingle, kCvtD, Unit::kAdder, 1},
                      {kDouble, kCvtS, Unit::kAdder, 2},        {kWord, kCvtS, Unit::kAdder, 3},
                      {kWord, kCvtD, Unit::kAdder, 3},          {kSingle, kCvtW, Unit::kAdder, 2},
                      {kDouble, kCvtW, Unit::kAdder, 2},        {kSingle, kCompare, Unit::kAdder, 2},
                      {kDouble, kCompare + 15, Unit::kAdder, 2}};
  for (const Row& row : rows) {
    const Demand demand = demand_of(fp_word(row.format, row.operation, 2, 4, 6), Timing());
    EXPECT_EQ(row.unit, demand.unit) << row.format << " " << row.operation;
    EXPECT_EQ(row.cycles, demand.cycles) << row.format << " " << row.operation;
  }
}

}  // namespace
}  // namespace dendro::r3010
