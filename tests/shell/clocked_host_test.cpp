#include "sim/base/error.h"
#include "tests/shell/clocked_rig.h"

namespace dendro::rds3000 {
namespace {

using namespace bps32;
using Ticks = std::vector<std::int64_t>;

const Settings kHaltNow = {{kHalt, 1}};
const Settings kStay = {{kSeq, am2910::kJMAP}, {kImm, 0}};

// Every offset of a request around the edge of tick 50, and the tick that it belongs to.
struct Offset {
  std::int64_t ps, tick;
};
const Offset kOffsets[] = {{-1, 50},      {0, 50},       {1, 51},      {199'998, 51},
                           {199'999, 51}, {200'000, 51}, {200'001, 52}};

TEST(ClockedHost, ARequestBelongsToTheTickEdgeAtOrAfterIt) {
  for (const Offset& o : kOffsets) {
    SCOPED_TRACE(o.ps);
    in_child([&] {
      Rig rig(Rig::quiet());
      std::int64_t written = 0, read = 0;
      rig.simulate([&] {
        rig.at_tick(50, o.ps);
        rig.engine->transfer(true, 0, 7, kFnLores);
        written = now_ps();
        rig.at_tick(150, o.ps);
        EXPECT_EQ(rig.engine->transfer(false, 0, 0, kFnLores), 7u);
        read = now_ps();
      });
      EXPECT_EQ(written, (o.tick + 1) * rig.tick());
      EXPECT_EQ(read, (100 + o.tick + 4) * rig.tick());
    });
  }
}

TEST(ClockedHost, RunTakesEffectAtTheEdgeAtOrAfterTheCommand) {
  for (const Offset& o : kOffsets) {
    SCOPED_TRACE(o.ps);
    in_child([&] {
      Rig rig(Rig::quiet());
      rig.simulate([&] {
        rig.load({word(kHaltNow)});
        rig.at_tick(50, o.ps);
        rig.engine->command(true, false);
        EXPECT_TRUE(rig.engine->running());
        rig.at_tick(60);
      });
      EXPECT_EQ(rig.ticks(), (Ticks{o.tick + 1}));
      ASSERT_EQ(rig.engine->runs().size(), 1u);
      EXPECT_EQ(rig.engine->runs()[0].from, o.tick + 1);
      EXPECT_EQ(rig.engine->runs()[0].to, o.tick + 2);
    });
  }
}

TEST(ClockedHost, NoWordExecutesAfterTheTickOfAHalt) {
  for (const Offset& o : kOffsets) {
    SCOPED_TRACE(o.ps);
    in_child([&] {
      Rig rig(Rig::quiet());
      rig.simulate([&] {
        rig.load({word(kStay)});
        rig.at_tick(29);
        rig.engine->command(true, false);
        rig.at_tick(50, o.ps);
        rig.engine->command(false, false);
        rig.at_tick(60);
        EXPECT_FALSE(rig.engine->interrupt());
        EXPECT_FALSE(rig.engine->running());
      });
      EXPECT_EQ(rig.ticks().size(), static_cast<std::size_t>(o.tick - 30 + 1));
      EXPECT_EQ(rig.ticks().back(), o.tick);
      EXPECT_EQ(rig.engine->runs().back().to, o.tick + 1);
    });
  }
}

TEST(ClockedHost, ContinuousWordsOfATransferTakeATickEach) {
  in_child([] {
    Rig rig(Rig::quiet());
    rig.simulate([&] {
      for (unsigned i = 0; i < 10; ++i) rig.engine->transfer(true, kScratchpad + i, i, 0);
      EXPECT_EQ(now_ps(), 10 * rig.tick());
      for (unsigned i = 0; i < 10; ++i) {
        EXPECT_EQ(rig.engine->transfer(false, kScratchpad + i, 0, 0), i);
      }
      EXPECT_EQ(now_ps(), 30 * rig.tick());
    });
    EXPECT_EQ(rig.engine->bus_counters().host_writes, 10u);
    EXPECT_EQ(rig.engine->bus_counters().host_reads, 10u);
    EXPECT_EQ(rig.engine->bus_counters().busy, 20u);
  });
}

TEST(ClockedHost, AHaltInTickNInterruptsAtTheEdgeOfTheNext) {
  in_child([] {
    Rig rig(Rig::quiet());
    rig.simulate([&] {
      rig.load({word({}), word({}), word(kHaltNow)});
      rig.at_tick(99);
      rig.engine->command(true, false);
      rig.at_tick(103, -1);
      EXPECT_FALSE(rig.engine->interrupt());
      EXPECT_TRUE(rig.engine->running());
      rig.host->wait_for(rig.engine->interrupt_event());
      EXPECT_EQ(now_ps(), 103 * rig.tick());
      EXPECT_TRUE(rig.engine->interrupt());
      EXPECT_FALSE(rig.engine->running());
      rig.engine->clear_interrupt();
      EXPECT_FALSE(rig.engine->interrupt());
    });
    EXPECT_EQ(rig.engine->processor().pc, 3);
  });
}

TEST(ClockedHost, StolenTicksFollowTheGrantAndOnlyForTheProcessorBoard) {
  for (const std::uint32_t address :
       {kScratchpad, kControlStore + 100, kProcessor, kLookUpTable, std::uint32_t{0}}) {
    SCOPED_TRACE(address);
    in_child([&] {
      Spec spec = Rig::quiet();
      spec.processor.steal_ticks = 2;
      Rig rig(spec);
      rig.simulate([&] {
        rig.load({word(kStay)});
        rig.at_tick(99);
        rig.engine->command(true, false);
        rig.at_tick(110);
        rig.engine->transfer(true, address, 0, kFnLores);
        rig.at_tick(120);
        rig.engine->command(false, false);
        rig.at_tick(130);
      });
      const bool steals = address == kScratchpad || address == kControlStore + 100 || address == kProcessor;
      Ticks want;
      for (std::int64_t t = 100; t <= 120; ++t)
        if (!steals || (t != 111 && t != 112)) want.push_back(t);
      EXPECT_EQ(rig.ticks(), want);
      EXPECT_EQ(rig.engine->processor_counters().stall_host, steals ? 2u : 0u);
    });
  }
}

TEST(ClockedHost, AWriteTakesEffectAfterTheWordOfTheSameTick) {
  in_child([] {
    Rig rig(Rig::quiet());
    rig.simulate([&] {
      // Word 0 writes -1 to scratch[0] and latches N; the host's write at the same tick is the last word on
      // both.
      rig.load({word(immediate(0xFFF, kYSpadAr, {{kLatch, 1}})), word({}), word(kHaltNow)});
      rig.at_tick(99);
      rig.engine->command(true, false);
      rig.at_tick(100);
      EXPECT_EQ(rig.engine->transfer(false, kScratchpad, 0, 0), 0xFFFFFFFFu);
      rig.at_tick(110);
      rig.engine->transfer(true, kProcessor, kStatusZ | kStatusHost, 0);
      rig.engine->transfer(true, kScratchpad, 9, 0);
      rig.engine->clear_interrupt();
      rig.engine->command(true, true);
      rig.at_tick(119);
      rig.engine->command(true, false);
      rig.at_tick(120);
      rig.engine->transfer(true, kScratchpad, 5, 0);
      rig.at_tick(130);
    });
    EXPECT_EQ(rig.engine->processor().scratch[0], 5u);
    EXPECT_TRUE(rig.engine->processor().host_flag);
    EXPECT_TRUE(rig.engine->processor().n);
  });
}

TEST(ClockedHost, AStatusWriteOnTheTickOfALatchWins) {
  in_child([] {
    Rig rig(Rig::quiet());
    rig.simulate([&] {
      rig.load({word(immediate(0xFFF, kYNone, {{kLatch, 1}})), word(kHaltNow)});
      rig.at_tick(99);
      rig.engine->command(true, false);
      rig.at_tick(100);
      rig.engine->transfer(true, kProcessor, kStatusZ | kStatusV | (0x123u << 16) | (5u << 28), 0);
      rig.at_tick(110);
    });
    const ProcessorState& p = rig.engine->processor();
    EXPECT_TRUE(p.z && p.v && !p.n && !p.c);
    EXPECT_EQ(p.restart_pc, 0x123);
    EXPECT_EQ(p.restart_page, 5);
  });
}

TEST(ClockedHost, ResetGoesToTheRestartAddressAndKeepsTheRegisters) {
  in_child([] {
    Rig rig(Rig::quiet());
    rig.simulate([&] {
      rig.load({word(immediate(7, kYNone, {{kDest, kRam}, {kB, 2}, {kSeq, am2910::kPUSH}, {kPol, 1}})),
                word({{kHalt, 1}}), word({}), word({}), word({{kHalt, 1}})});
      rig.at_tick(99);
      rig.engine->command(true, false);
      rig.at_tick(110);
      EXPECT_EQ(rig.engine->processor().depth, 1);
      rig.engine->transfer(true, kProcessor, 3u << 16, 0);
      rig.engine->command(true, true);
      rig.at_tick(120);
      EXPECT_EQ(rig.engine->transfer(false, kProcessor, 0, 0), 3u);
      EXPECT_EQ(rig.engine->processor().depth, 0);
      EXPECT_FALSE(rig.engine->running());
      rig.at_tick(129);
      rig.engine->command(true, false);
      rig.at_tick(140);
    });
    EXPECT_EQ(rig.ticks_of(3), (Ticks{130}));
    EXPECT_EQ(rig.ticks_of(2), (Ticks{}));
    EXPECT_EQ(rig.engine->processor().ram[2], 7u);
    EXPECT_EQ(rig.engine->runs().size(), 2u);
  });
}

TEST(ClockedHost, ResetLeavesTheReadInFlightAlone) {
  in_child([] {
    Rig rig(Rig::quiet());
    rig.simulate([&] {
      rig.engine->transfer(true, 0, 0x77, kFnLores);
      rig.load({word({{kBusOp, kBusRead}, {kBusFn, kFnLores}}), word(kStay)});
      rig.at_tick(99);
      rig.engine->command(true, false);
      rig.at_tick(101);
      rig.engine->command(true, true);
      rig.at_tick(120);
    });
    EXPECT_EQ(rig.engine->processor().read_data, 0x77u);
    EXPECT_EQ(rig.engine->bus_counters().processor_reads, 1u);
  });
}

TEST(ClockedHost, AWordWrittenWhileTheProcessorRunsIsWhatTheNextFetchGets) {
  in_child([] {
    Rig rig(Rig::quiet());
    rig.simulate([&] {
      rig.load({word(kStay)});
      rig.at_tick(99);
      rig.engine->command(true, false);
      rig.at_tick(110);
      const std::uint64_t halt = bps32::put(word(kStay), kHalt, 1);
      rig.engine->transfer(true, kControlStore, static_cast<std::uint32_t>(halt), 0);
      rig.at_tick(130);
    });
    // Tick 111 is stolen; the word with the halt executes at 112.
    EXPECT_EQ(rig.ticks().back(), 112);
    EXPECT_TRUE(rig.engine->processor().interrupt);
  });
}

TEST(ClockedHost, CountersDescribeExactlyTheTicksBeforeTheEnd) {
  for (const std::int64_t end : {0, 1, 2, 150}) {
    in_child([&] {
      Rig rig(Rig::quiet());
      rig.simulate(
          [&] {
            if (end < 100) return;
            rig.load({word(kStay)});
            rig.at_tick(99);
            rig.engine->command(true, false);
            rig.at_tick(140);
          },
          end);
      const ProcessorCounters& c = rig.engine->processor_counters();
      EXPECT_EQ(
          c.busy + c.stall_host + c.stall_data + c.stall_bus + c.stall_scratch + c.stall_branch + c.idle,
          static_cast<std::uint64_t>(end));
      if (end == 150) {
        EXPECT_EQ(c.busy, 50u);
        EXPECT_EQ(rig.engine->runs().back().to, 150);
      }
    });
  }
}

TEST(ClockedHost, AProgramThatPassesTheTickLimitIsStoppedWithItsLoopNamed) {
  in_child([] {
    MachineOptions options;
    options.symbols = {{0, "start"}, {1, "head"}, {3, "tail"}};
    options.tick_limit = 1000;
    Rig rig(Rig::quiet(), options);
    rig.simulate([&] {
      rig.load({word({}), word({}), word({}), word({{kSeq, am2910::kJMAP}, {kImm, 2}})});
      rig.at_tick(99);
      rig.engine->command(true, false);
      rig.host->wait_for(rig.engine->interrupt_event());
      EXPECT_EQ(now_ps(), (100 + 1000 + 4096) * rig.tick());
      EXPECT_FALSE(rig.engine->interrupt());
      EXPECT_FALSE(rig.engine->running());
    });
    try {
      std::rethrow_exception(rig.engine->error());
    } catch (const UserError& e) {
      EXPECT_STREQ(e.what(),
                   "the microprogram still runs after the limit of 1000 ticks, in the loop 0x002..0x003 (head + 1)");
    }
  });
}

}  // namespace
}  // namespace dendro::rds3000
