#include "models/parts/am2910/am2910.h"

#include <gtest/gtest.h>

namespace dendro::am2910 {
namespace {

constexpr std::uint16_t kPc = 0x100, kD = 0x200;

TEST(Am2910, ConditionalJumpsGoToDOnPassAndOnOnFail) {
  for (const unsigned op : {kCJP, kCJV, kCJPP, kCJS}) {
    State s;
    EXPECT_EQ(step(s, op, true, kPc, kD), kD);
    EXPECT_EQ(step(s, op, false, kPc, kD), kPc + 1);
  }
}

TEST(Am2910, ASubroutineReturnsToTheWordAfterItsCall) {
  State s;
  EXPECT_EQ(step(s, kCJS, true, kPc, kD), kD);
  EXPECT_EQ(step(s, kCRTN, true, kD, 0), kPc + 1);
  EXPECT_EQ(s.depth, 0);
}

TEST(Am2910, ALoopOnTheCounterRunsOnceMoreThanItsCount) {
  State s;
  step(s, kLDCT, true, kPc, 3);
  int times = 1;
  while (step(s, kRPCT, true, kPc, kD) == kD) ++times;
  EXPECT_EQ(times, 4);
  EXPECT_EQ(s.counter, 0);
}

TEST(Am2910, PushLoadsTheCounterOnPassOnlyAndRfctPopsAtTheEnd) {
  State s;
  step(s, kPUSH, false, kPc, 5);
  EXPECT_EQ(s.counter, 0);
  s = State();
  step(s, kPUSH, true, kPc, 1);
  EXPECT_EQ(step(s, kRFCT, true, kD, 0), kPc + 1);
  EXPECT_EQ(step(s, kRFCT, true, kD, 0), kD + 1);
  EXPECT_EQ(s.depth, 0);
}

TEST(Am2910, ThreeWayBranchLeavesOnPassOnZeroOrGoesRoundAgain) {
  State s;
  step(s, kPUSH, true, kPc, 1);
  EXPECT_EQ(step(s, kTWB, false, 0x300, kD), kPc + 1);
  EXPECT_EQ(step(s, kTWB, false, 0x300, kD), kD);
  EXPECT_EQ(s.depth, 0);
  step(s, kPUSH, true, kPc, 1);
  EXPECT_EQ(step(s, kTWB, true, 0x300, kD), 0x301);
  EXPECT_EQ(s.depth, 0);
}

TEST(Am2910, AFullStackOverwritesItsTopAndAnEmptyOneStaysEmpty) {
  State s;
  for (std::uint16_t i = 0; i < 6; ++i) step(s, kPUSH, false, 0x10 * i, 0);
  EXPECT_EQ(s.depth, 5);
  EXPECT_EQ(s.stack[4], 0x51);
  EXPECT_EQ(s.stack[3], 0x31);
  for (int i = 0; i < 7; ++i) step(s, kLOOP, true, kPc, 0);
  EXPECT_EQ(s.depth, 0);
}

TEST(Am2910, JumpZeroClearsTheStackAndAddressesWrapAtTwelveBits) {
  State s;
  step(s, kPUSH, false, kPc, 0);
  EXPECT_EQ(step(s, kJZ, true, kPc, kD), 0);
  EXPECT_EQ(s.depth, 0);
  EXPECT_EQ(step(s, kCONT, true, 0xFFF, 0), 0);
}

TEST(Am2910, JrpAndJsrpTakeTheCounterOnFail) {
  State s;
  s.counter = 0x345;
  EXPECT_EQ(step(s, kJRP, false, kPc, kD), 0x345);
  EXPECT_EQ(step(s, kJRP, true, kPc, kD), kD);
  EXPECT_EQ(step(s, kJSRP, false, kPc, kD), 0x345);
  EXPECT_EQ(step(s, kCRTN, true, 0x345, 0), kPc + 1);
}

}  // namespace
}  // namespace dendro::am2910
