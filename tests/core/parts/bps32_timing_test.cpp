#include "models/parts/bps32/bps32_timing.h"

#include <gtest/gtest.h>

namespace dendro::bps32 {
namespace {

Decoded word_that(bool reads_bus, bool starts_access = false, bool touches_scratch = false) {
  Decoded word;
  word.reads_bus = reads_bus;
  word.starts_access = starts_access;
  word.touches_scratch = touches_scratch;
  word.holds = reads_bus || starts_access || touches_scratch;
  return word;
}

TEST(Holds, DataAreOutOfReachOneTickBeforeTheyAreReadyAndThereAtIt) {
  Holds holds{ProcessorSpec{}};
  holds.access(false, 14);
  EXPECT_EQ(holds.at(word_that(true), 13).cause, Cause::kData);
  EXPECT_EQ(holds.at(word_that(true), 13).until, 14);
  EXPECT_EQ(holds.at(word_that(true), 14).cause, Cause::kNone);
  EXPECT_EQ(holds.at(word_that(false), 13).cause, Cause::kNone);
}

TEST(Holds, ASecondAccessIsHeldUntilTheFirstIsComplete) {
  Holds holds{ProcessorSpec{}};
  holds.access(true, 11);
  EXPECT_EQ(holds.at(word_that(false, true), 10).cause, Cause::kBus);
  EXPECT_EQ(holds.at(word_that(false, true), 11).cause, Cause::kNone);
  EXPECT_EQ(holds.at(word_that(true), 10).cause, Cause::kNone) << "a write brings no data";
}

TEST(Holds, WithoutSplitAccessesEveryWordIsHeld) {
  ProcessorSpec spec;
  spec.accesses_in_flight = 0;
  Holds holds(spec);
  holds.access(true, 11);
  EXPECT_TRUE(holds.holds_any(10));
  EXPECT_EQ(holds.at(word_that(false), 10).cause, Cause::kBus);
  EXPECT_FALSE(holds.holds_any(11));
}

TEST(Holds, ASlowScratchpadBeginsWhenEverythingElseIsReady) {
  ProcessorSpec spec;
  spec.scratch_ticks = 3;
  Holds holds(spec);
  holds.access(false, 20);
  const Decoded word = word_that(true, false, true);
  EXPECT_EQ(holds.at(word, 18).until, 20);
  EXPECT_EQ(holds.at(word, 20).cause, Cause::kScratch);
  EXPECT_EQ(holds.at(word, 20).until, 22);
  EXPECT_EQ(holds.at(word, 22).cause, Cause::kNone);
  EXPECT_EQ(holds.at(word, 23).until, 25) << "the next word waits anew";
}

TEST(Holds, AStolenTickIsBlamedOnTheHostBeforeAllElse) {
  ProcessorSpec spec;
  spec.steal_ticks = 2;
  spec.taken_branch_ticks = 4;
  Holds holds(spec);
  holds.branch(9);
  holds.steal(9);
  EXPECT_EQ(holds.at(word_that(false), 11).cause, Cause::kHost);
  EXPECT_EQ(holds.at(word_that(false), 12).cause, Cause::kBranch);
  EXPECT_EQ(holds.at(word_that(false), 14).cause, Cause::kNone);
}

}  // namespace
}  // namespace dendro::bps32
