#include <random>

#include "tests/shell/clocked_rig.h"

namespace dendro::rds3000 {
namespace {

using namespace bps32;
using Ticks = std::vector<std::int64_t>;

const Settings kHaltNow = {{kHalt, 1}};

// RAM[reg] := scratch[address].
std::uint64_t load(unsigned reg, unsigned address) {
  return word({{kDsrc, kDSpad}, {kImm, address}, {kEa, 1}, {kFunc, kPassR}, {kDest, kRam}, {kB, reg}});
}
std::uint64_t to_register(unsigned reg, unsigned dsrc) {
  return word({{kDsrc, dsrc}, {kEa, 1}, {kFunc, kPassR}, {kDest, kRam}, {kB, reg}});
}

TEST(ClockedProcessor, AProductIsThereTwoWordsAfterItsStart) {
  in_child([] {
    Rig rig(Rig::quiet());
    rig.simulate([&] {
      rig.run({word(immediate(0xFFD, kYMulX)), word(immediate(5, kYMulY, {{kMul, kMulSigned}})),
               to_register(1, kDProduct), to_register(2, kDProduct), to_register(3, kDProductHi),
               to_register(4, kDProductLo), word(kHaltNow)},
              100);
    });
    const auto& ram = rig.engine->processor().ram;
    EXPECT_EQ(ram[1], 0u);
    EXPECT_EQ(ram[2], static_cast<std::uint32_t>(-15));
    EXPECT_EQ(ram[3], 0xFFFFFFFFu);
    EXPECT_EQ(ram[4], 0xFFF1u);
  });
}

TEST(ClockedProcessor, MultiplierTimeIsCountedInWordsNotTicks) {
  in_child([] {
    Rig rig(Rig::quiet());
    rig.simulate([&] {
      rig.run({word(immediate(3, kYMulX, {{kBusOp, kBusRead}, {kBusFn, kFnLores}})),
               word(immediate(5, kYMulY, {{kMul, kMulUnsigned}})),
               // Held for the read: two ticks pass, but it is the first word after the start.
               word({{kDsrc, kDBus}, {kSeq, am2910::kCJP}, {kCond, kProductReady}, {kImm, 4}}),
               to_register(1, kDProduct), word(kHaltNow)},
              100);
    });
    EXPECT_EQ(rig.ticks(), (Ticks{0, 1, 4, 5, 6}));
    EXPECT_EQ(rig.engine->processor().ram[1], 15u);
    EXPECT_FALSE(rig.engine->time_dependent());
  });
}

TEST(ClockedProcessor, AStartAbandonsTheProductUnderWay) {
  in_child([] {
    Rig rig(Rig::quiet());
    rig.simulate([&] {
      rig.run({word(immediate(3, kYMulX)), word(immediate(5, kYMulY, {{kMul, kMulUnsigned}})),
               word(immediate(7, kYMulY, {{kMul, kMulUnsigned}})), to_register(1, kDProduct),
               to_register(2, kDProduct), word(kHaltNow)},
              100);
    });
    EXPECT_EQ(rig.engine->processor().ram[1], 0u);
    EXPECT_EQ(rig.engine->processor().ram[2], 21u);
  });
}

TEST(ClockedProcessor, ATakenBranchCostsItsTicksAndAFallThroughNothing) {
  for (const int cost : {0, 1, 3}) {
    SCOPED_TRACE(cost);
    in_child([&] {
      Spec spec = Rig::quiet();
      spec.processor.taken_branch_ticks = cost;
      Rig rig(spec);
      rig.simulate([&] {
        rig.run({word({{kSeq, am2910::kJMAP}, {kImm, 3}}), word({}), word({}),
                 word({{kSeq, am2910::kCJP}, {kPol, 1}, {kImm, 0}}), word({{kSeq, am2910::kJMAP}, {kImm, 5}}),
                 word(kHaltNow)},
                100);
      });
      // The jump from 4 to 5 goes where the counter would have gone.
      EXPECT_EQ(rig.ticks(), (Ticks{0, 1 + cost, 2 + cost, 3 + cost}));
      EXPECT_EQ(rig.engine->processor_counters().stall_branch, static_cast<std::uint64_t>(cost));
    });
  }
}

TEST(ClockedProcessor, ASlowScratchpadHoldsTheWordsThatUseIt) {
  in_child([] {
    Spec spec = Rig::quiet();
    spec.processor.scratch_ticks = 2;
    Rig rig(spec);
    rig.simulate([&] {
      rig.run(
          {word({}), load(1, 0), word(immediate(5, kYSpadAr)), word({{kBusOp, kBusRead}, {kBusFn, kFnLores}}),
           // The scratchpad starts when the read is there.
           word({{kDsrc, kDBus}, {kYdst, kYSpadAr}}), word(kHaltNow)},
          100);
    });
    EXPECT_EQ(rig.ticks(), (Ticks{0, 2, 4, 5, 10, 11}));
    EXPECT_EQ(rig.engine->processor_counters().stall_scratch, 3u);
    EXPECT_EQ(rig.engine->processor_counters().stall_data, 3u);
  });
}

TEST(ClockedProcessor, SourceAndDestinationShareTheOldScratchAddressAndStepItOnce) {
  in_child([] {
    Rig rig(Rig::quiet());
    rig.simulate([&] {
      for (unsigned i = 0; i < 4; ++i) rig.engine->transfer(true, kScratchpad + i, 10 * i, 0);
      const Settings move = {
          {kDsrc, kDSpadArInc}, {kYdst, kYSpadArInc}, {kEa, 1}, {kFunc, kPassR}, {kCarry, kCarryOne}};
      rig.run({word(immediate(1, kYSar)), word(move), word(move),
               word({{kDsrc, kDSpadArInc}, {kYdst, kYSar}, {kEa, 1}, {kFunc, kPassR}}), word(kHaltNow)},
              100);
    });
    EXPECT_EQ(rig.engine->processor().scratch[1], 11u);
    EXPECT_EQ(rig.engine->processor().scratch[2], 21u);
    EXPECT_EQ(rig.engine->processor().sar, 30);
  });
}

TEST(ClockedProcessor, ABranchSeesTheFlagsOfAnEarlierWord) {
  in_child([] {
    Rig rig(Rig::quiet());
    rig.simulate([&] {
      // Word 0 latches Z and branches on it at once: not taken. Word 1 branches on it: taken.
      rig.run({word({{kLatch, 1}, {kSeq, am2910::kCJP}, {kCond, kZero}, {kImm, 9}}),
               word({{kSeq, am2910::kCJP}, {kCond, kZero}, {kImm, 3}}), word(kHaltNow), word(kHaltNow)},
              100);
    });
    EXPECT_EQ(rig.ticks_of(3), (Ticks{2}));
  });
}

TEST(ClockedProcessor, SubroutinesAndCountedLoopsReturnWhereTheySay) {
  in_child([] {
    Rig rig(Rig::quiet());
    rig.simulate([&] {
      rig.run(
          {word({{kSeq, am2910::kLDCT}, {kImm, 2}}), word({{kSeq, am2910::kCJS}, {kImm, 5}}),
           word({{kSeq, am2910::kRPCT}, {kImm, 1}}), word(kHaltNow), word({}), word({{kSeq, am2910::kCRTN}})},
          100);
    });
    EXPECT_EQ(rig.ticks_of(1), (Ticks{1, 4, 7}));
    EXPECT_EQ(rig.ticks_of(5), (Ticks{2, 5, 8}));
    EXPECT_EQ(rig.ticks_of(3), (Ticks{10}));
    EXPECT_EQ(rig.engine->processor().depth, 0);
  });
}

TEST(ClockedProcessor, TheDirectInputCanComeFromTheYBus) {
  in_child([] {
    Rig rig(Rig::quiet());
    rig.simulate([&] {
      rig.engine->transfer(true, kScratchpad + 2, 0xABC003, 0);
      rig.run({load(1, 2), word({{kSeq, am2910::kJMAP}, {kImm, 9}, {kA, 1}, {kFunc, kPassR}, {kYdst, kYSeq}}),
               word(kHaltNow), word(kHaltNow)},
              100);
    });
    EXPECT_EQ(rig.ticks_of(3), (Ticks{2}));
  });
}

TEST(ClockedProcessor, AMultiplyRoutineOfSpecialStepsGivesTheSignedProduct) {
  static constexpr unsigned kSeed = 16;
  in_child([] {
    std::mt19937 random(kSeed);
    Rig rig(Rig::quiet());
    constexpr unsigned kPairs = 50;
    std::vector<std::uint32_t> x(kPairs), y(kPairs);
    std::vector<std::uint64_t> products(kPairs);
    const auto step = [](unsigned dest, Settings more = {}) {
      more.insert(more.end(), {{kFunc, kSpecial}, {kI0, 0}, {kDest, dest}, {kA, 1}, {kB, 2}});
      return word(more);
    };
    rig.simulate([&] {
      rig.load(
          {load(1, 0), word({{kDsrc, kDSpad}, {kImm, 1}, {kEa, 1}, {kFunc, kPassR}, {kDest, kQ}}),
           word({{kFunc, kFZero}, {kDest, kRam}, {kB, 2}, {kSeq, am2910::kLDCT}, {kImm, 30}}),
           step(2, {{kSeq, am2910::kRPCT}, {kImm, 3}}),
           // The last step's carry is Q0, which no carry select offers: two words, and a branch between them.
           word({{kSeq, am2910::kCJP}, {kCond, kQ0}, {kImm, 7}}), step(6, {{kCarry, kCarryZero}}),
           word({{kHalt, 1}}), step(6, {{kCarry, kCarryOne}}), word({{kHalt, 1}})});
      for (unsigned i = 0; i < kPairs; ++i) {
        x[i] = i == 0 ? 0x80000000u : static_cast<std::uint32_t>(random());
        y[i] = i < 2 ? 0x80000000u : static_cast<std::uint32_t>(random());
        rig.engine->transfer(true, kScratchpad, x[i], 0);
        rig.engine->transfer(true, kScratchpad + 1, y[i], 0);
        rig.engine->command(true, true);
        rig.at_tick(now_ps() / rig.tick() + 2);
        rig.engine->command(true, false);
        rig.host->wait_for(rig.engine->interrupt_event());
        rig.engine->clear_interrupt();
        products[i] = (std::uint64_t{rig.engine->processor().ram[2]} << 32) | rig.engine->processor().q;
        const RunInterval& run = rig.engine->runs().back();
        EXPECT_EQ(run.to - run.from, 3 + 31 + 3);
      }
    });
    for (unsigned i = 0; i < kPairs; ++i) {
      const std::int64_t want =
          std::int64_t{static_cast<std::int32_t>(x[i])} * static_cast<std::int32_t>(y[i]);
      EXPECT_EQ(products[i], static_cast<std::uint64_t>(want)) << x[i] << " * " << y[i] << " seed " << kSeed;
    }
  });
}

}  // namespace
}  // namespace dendro::rds3000
