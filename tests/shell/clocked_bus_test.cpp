#include "tests/shell/clocked_rig.h"

namespace dendro::rds3000 {
namespace {

using namespace bps32;
using Ticks = std::vector<std::int64_t>;

const Settings kHaltNow = {{kHalt, 1}};

// A lores access to pixel (0, 0), whose address the bus register holds after power-on.
std::uint64_t access(unsigned op, Settings more = {}) {
  more.insert(more.end(), {{kBusOp, op}, {kBusFn, kFnLores}});
  return word(more);
}
std::uint64_t take_data(unsigned reg) {
  return word({{kDsrc, kDBus}, {kEa, 1}, {kFunc, kPassR}, {kDest, kRam}, {kB, reg}});
}

TEST(ClockedBus, DataOfAReadAreUsableFourTicksAfterItsGrant) {
  in_child([] {
    Rig rig(Rig::quiet());
    rig.simulate([&] {
      rig.engine->transfer(true, 0, 0xABCDEF, kFnLores);
      rig.run({access(kBusRead), take_data(3), word(kHaltNow)}, 100);
    });
    EXPECT_EQ(rig.ticks(), (Ticks{0, 4, 5}));
    EXPECT_EQ(rig.engine->processor().ram[3], 0xABCDEFu);
    EXPECT_EQ(rig.engine->processor_counters().stall_data, 3u);
    EXPECT_EQ(rig.engine->processor_counters().stall_bus, 0u);
    EXPECT_EQ(rig.engine->bus_counters().processor_reads, 1u);
  });
}

TEST(ClockedBus, WordsThatDoNotTouchTheReadRunMeanwhile) {
  in_child([] {
    Rig rig(Rig::quiet());
    rig.simulate([&] {
      rig.run({access(kBusRead), word({}), word({}), word({}), take_data(3), word(kHaltNow)}, 100);
    });
    EXPECT_EQ(rig.ticks(), (Ticks{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(rig.engine->processor_counters().stall_data, 0u);
  });
}

TEST(ClockedBus, ASecondAccessWaitsForTheFirst) {
  in_child([] {
    Rig rig(Rig::quiet());
    rig.simulate([&] { rig.run({access(kBusRead), access(kBusWrite), word(kHaltNow)}, 100); });
    EXPECT_EQ(rig.ticks(), (Ticks{0, 4, 5}));
    EXPECT_EQ(rig.engine->processor_counters().stall_bus, 3u);
    EXPECT_EQ(rig.engine->processor_counters().stall_data, 0u);
  });
}

TEST(ClockedBus, AWordThatReadsDataAndStartsAnAccessBlamesTheDataFirst) {
  in_child([] {
    Rig rig(Rig::quiet());
    rig.simulate([&] {
      rig.run({access(kBusRead), access(kBusRead, {{kDsrc, kDBus}}), word(kHaltNow)}, 100);
    });
    EXPECT_EQ(rig.ticks(), (Ticks{0, 4, 5}));
    EXPECT_EQ(rig.engine->processor_counters().stall_data, 3u);
    EXPECT_EQ(rig.engine->processor_counters().stall_bus, 0u);
  });
}

TEST(ClockedBus, WritesToOneCardFollowEveryTwoTicks) {
  in_child([] {
    Rig rig(Rig::quiet());
    rig.simulate([&] {
      rig.run({access(kBusWrite), access(kBusWrite), access(kBusWrite), word(kHaltNow)}, 100);
    });
    // Granted at 0, 2 and 4; a word starts its access when the one before is complete.
    EXPECT_EQ(rig.ticks(), (Ticks{0, 1, 3, 4}));
    EXPECT_EQ(rig.engine->memory_counters().wait_ticks, 2u);
    EXPECT_EQ(rig.engine->memory_counters().writes, 3u);
    EXPECT_EQ(rig.engine->memory_counters().busy_access, 3u * 3u * 2u);
  });
}

TEST(ClockedBus, WritesToDifferentCardsFollowEveryTick) {
  in_child([] {
    Rig rig(Rig::quiet());
    const auto to_card = [](unsigned card) {
      return word(immediate(card << 6, kYBusY, {{kBusOp, kBusWrite}, {kBusFn, kFnWord}}));
    };
    rig.simulate([&] { rig.run({to_card(0), to_card(1), to_card(2), to_card(0), word(kHaltNow)}, 100); });
    EXPECT_EQ(rig.ticks(), (Ticks{0, 1, 2, 3, 4}));
    EXPECT_EQ(rig.engine->memory_counters().wait_ticks, 0u);
  });
}

TEST(ClockedBus, AMaskedWriteKeepsItsCardLonger) {
  in_child([] {
    Spec spec = Rig::quiet();
    spec.memory.masked_write_extra_ticks = 3;
    Rig rig(spec);
    rig.simulate([&] {
      rig.engine->transfer(true, 0, 0xFF, kFnMaskLores);
      rig.run({access(kBusWrite), access(kBusWrite), word({}), access(kBusWrite), word(kHaltNow)}, 100);
    });
    // Granted at 0, 5 and 10.
    EXPECT_EQ(rig.ticks(), (Ticks{0, 1, 2, 6, 7}));
    EXPECT_EQ(rig.engine->memory_counters().masked_writes, 3u);
  });
}

TEST(ClockedBus, WithoutSplitAccessesTheNextWordWaits) {
  in_child([] {
    Spec spec = Rig::quiet();
    spec.processor.accesses_in_flight = 0;
    Rig rig(spec);
    rig.simulate([&] {
      rig.run({access(kBusRead), word({}), access(kBusWrite), word({}), word(kHaltNow)}, 100);
    });
    EXPECT_EQ(rig.ticks(), (Ticks{0, 4, 5, 6, 7}));
    EXPECT_EQ(rig.engine->processor_counters().stall_bus, 3u);
  });
}

TEST(ClockedBus, ArbitrationDelaysTheGrant) {
  in_child([] {
    Spec spec = Rig::quiet();
    spec.bus.arbitration_ticks = 1;
    Rig rig(spec);
    rig.simulate([&] {
      rig.run({access(kBusRead), take_data(1), access(kBusWrite), access(kBusWrite), word(kHaltNow)}, 100);
    });
    EXPECT_EQ(rig.ticks(), (Ticks{0, 5, 6, 8, 9}));
  });
}

TEST(ClockedBus, OtherDevicesAnswerAfterTheirOwnReadTime) {
  in_child([] {
    Rig rig(Rig::quiet());
    rig.simulate([&] {
      rig.engine->transfer(true, kLookUpTable, 0x12345678, 0);
      rig.run({word(immediate(0x830 << 0, kYNone)),
               word({{kDsrc, kDImm}, {kImm, 0x830}, {kEa, 1}, {kFunc, kPassR}, {kDest, kRam}, {kB, 1}}),
               // 0x830 as a number is negative in 12 bits; bits 23-12 of the address come from two shifts by
               // the Y fields.
               word({{kA, 1}, {kFunc, kPassR}, {kDest, kLslRam}, {kB, 1}}),
               word({{kA, 1}, {kFunc, kPassR}, {kDest, kLslRam}, {kB, 1}, {kYdst, kYBusY}}),
               word({{kBusOp, kBusRead}}), take_data(2), word(kHaltNow)},
              100);
    });
    EXPECT_EQ(rig.ticks(), (Ticks{0, 1, 2, 3, 4, 6, 7}));
    EXPECT_EQ(rig.engine->processor().bus_address, kLookUpTable);
    EXPECT_EQ(rig.engine->processor().ram[2], 0x12345678u);
  });
}

TEST(ClockedBus, TheProcessorGoesBeforeTheHostOnTheSameTick) {
  in_child([] {
    Rig rig(Rig::quiet());
    std::int64_t done = 0;
    rig.simulate([&] {
      rig.load(
          {word({}), word({}), access(kBusWrite), word({}), word({}), word({}), word({}), word(kHaltNow)});
      rig.at_tick(99);
      rig.origin = 100;
      rig.engine->command(true, false);
      rig.at_tick(102);
      rig.engine->transfer(true, 0, 0x55, kFnLores);
      done = now_ps();
      rig.at_tick(120);
    });
    EXPECT_EQ(rig.ticks_of(2), (Ticks{2}));
    // The processor's write holds the bus in 102 and the cards in 102 and 103; the host's is granted at 104.
    EXPECT_EQ(done, 105 * rig.tick());
    EXPECT_EQ(rig.engine->memory().lores(0, 0), 0x55u);
    EXPECT_EQ(rig.engine->memory_counters().wait_ticks, 1u);
    EXPECT_EQ(rig.engine->bus_counters().busy, 16u + 1u + 2u);
  });
}

TEST(ClockedBus, AHostAccessThatWaitsForItsCardsHoldsTheBus) {
  in_child([] {
    Spec spec = Rig::quiet();
    spec.memory.card_busy_ticks = 5;
    Rig rig(spec);
    rig.simulate([&] {
      rig.load({access(kBusWrite), word({}), word({}), word({{kBusOp, kBusWrite}, {kBusFn, 1}}),
                access(kBusWrite), word({}), word(kHaltNow)});
      rig.at_tick(99);
      rig.origin = 100;
      rig.engine->command(true, false);
      rig.at_tick(101);
      rig.engine->transfer(false, 0, 0, kFnLores);
      EXPECT_EQ(now_ps(), 109 * rig.tick());
      rig.at_tick(130);
    });
    // The host holds the bus from 101 to its grant at 105; the access of word 3, to nowhere, is granted at
    // 106.
    EXPECT_EQ(rig.ticks(), (Ticks{0, 1, 2, 3, 7, 8, 9}));
    EXPECT_EQ(rig.engine->processor_counters().stall_bus, 3u);
  });
}

TEST(ClockedBus, ConditionsSeeTheAccessOfTheirOwnTick) {
  in_child([] {
    Rig rig(Rig::quiet());
    const auto loop_while_busy = word({{kSeq, am2910::kCJP}, {kCond, kBusBusy}, {kImm, 1}});
    const auto loop_while_reading = word({{kSeq, am2910::kCJP}, {kCond, kDataReady}, {kPol, 1}, {kImm, 3}});
    rig.simulate([&] {
      rig.run({access(kBusWrite), loop_while_busy, access(kBusRead), loop_while_reading, word(kHaltNow)},
              100);
    });
    // The write is complete at 1, so its loop runs once. The read is granted at 2, complete at 6.
    EXPECT_EQ(rig.ticks(), (Ticks{0, 1, 2, 3, 4, 5, 6, 7}));
    EXPECT_TRUE(rig.engine->time_dependent());
  });
}

TEST(ClockedBus, AConditionThatNoBranchUsesIsNotTimeDependent) {
  in_child([] {
    Rig rig(Rig::quiet());
    rig.simulate([&] { rig.run({word({{kCond, kBusBusy}}), word(kHaltNow)}, 100); });
    EXPECT_FALSE(rig.engine->time_dependent());
  });
}

}  // namespace
}  // namespace dendro::rds3000
