#include "tests/shell/clocked_rig.h"

namespace dendro::rds3000 {
namespace {

using namespace bps32;
using Ticks = std::vector<std::int64_t>;

const Settings kHaltNow = {{kHalt, 1}};
const Settings kRead = {{kBusOp, kBusRead}, {kBusFn, kFnLores}};
const Settings kTake = {{kDsrc, kDBus}};

// Mode 0 at a phase that puts the first fetch of the first active line at `fetch_ps`.
Spec fetch_at(std::int64_t fetch_ps) {
  Spec spec;
  spec.video.mode = video::DisplayMode::kLores30;
  const video::Raster r =
      video::raster_of(video::power_on(spec.video.mode), spec.video, spec.memory.fetch_bits);
  spec.video.phase_ps = r.blank_lines * r.line_ps + r.horizontal_blank_ps - fetch_ps;
  return spec;
}

// Ticks from the word with the read to the word that takes the data, when a read starts in tick `read`.
std::int64_t read_takes(const Spec& spec, std::int64_t read) {
  int link[2];
  EXPECT_EQ(pipe(link), 0);
  in_child([&] {
    Rig rig(spec);
    rig.simulate([&] { rig.run({word(kRead), word(kTake), word(kHaltNow)}, read); });
    const std::int64_t took = rig.ticks_of(1).at(0);
    EXPECT_EQ(write(link[1], &took, sizeof took), static_cast<ssize_t>(sizeof took));
  });
  std::int64_t took = -1;
  close(link[1]);
  EXPECT_EQ(::read(link[0], &took, sizeof took), static_cast<ssize_t>(sizeof took));
  close(link[0]);
  return took;
}

TEST(ClockedMemory, AFetchTakesItsCardsAtTheFirstTickEdgeAtOrAfterIt) {
  // Due between edges 99 and 100, on edge 100, and just after it.
  for (const auto& [fetch_ps, tick] : {std::pair<std::int64_t, std::int64_t>{99 * 200'000 + 1, 100},
                                       {100 * 200'000, 100},
                                       {100 * 200'000 + 1, 101}}) {
    SCOPED_TRACE(fetch_ps);
    const Spec spec = fetch_at(fetch_ps);
    EXPECT_EQ(read_takes(spec, tick - 3), 4);
    EXPECT_EQ(read_takes(spec, tick - 1), 4);  // the cards are taken first, the fetch waits
    EXPECT_EQ(read_takes(spec, tick), 6);      // the fetch goes first
    EXPECT_EQ(read_takes(spec, tick + 1), 5);
    EXPECT_EQ(read_takes(spec, tick + 2), 4);
  }
}

TEST(ClockedMemory, AFetchThatFoundItsCardsBusyIsServedWhenTheyAreFree) {
  in_child([] {
    // The read holds the cards in 99 and 100, the fetch due at 100 in 101 and 102; the second read starts at
    // 103.
    Rig rig(fetch_at(100 * 200'000));
    rig.simulate([&] { rig.run({word({}), word(kRead), word(kTake), word(kHaltNow)}, 98, 3); });
    const Spec& spec = rig.spec;
    EXPECT_EQ(rig.ticks(), (Ticks{0, 1, 5, 6}));
    EXPECT_EQ(rig.engine->memory_counters().fetches, 3u);
    EXPECT_EQ(rig.engine->memory_counters().busy_video, 3u * static_cast<unsigned>(spec.memory.fetch_ticks));
  });
}

TEST(ClockedMemory, RefreshIsServedBeforeAFetchOfTheSameTick) {
  Spec spec = fetch_at(100 * 200'000);
  spec.memory.refresh_interval_ps = 100 * 200'000;
  spec.memory.card_busy_ticks = 3;
  // 3 ticks of refresh, 2 of the fetch, then the read.
  EXPECT_EQ(read_takes(spec, 100), 4 + 5);
  for (const std::int64_t end : {100, 101, 103, 104}) {
    SCOPED_TRACE(end);
    in_child([&] {
      Rig rig(spec);
      rig.simulate([&] { rig.at_tick(end); }, end);
      EXPECT_EQ(rig.engine->memory_counters().refreshes, end > 100 ? 3u : 0u);
      EXPECT_EQ(rig.engine->memory_counters().fetches, end > 103 ? 3u : 0u);
    });
  }
}

TEST(ClockedMemory, EventsAreServedInTheOrderOfTheirTicks) {
  Spec spec = fetch_at(99 * 200'000);
  spec.memory.refresh_interval_ps = 100 * 200'000;
  spec.memory.card_busy_ticks = 4;
  // The read of tick 98 holds the cards to 101: the fetch of 99 comes at 102, the refresh of 100 at 104.
  for (const std::int64_t end : {102, 103, 104, 105}) {
    SCOPED_TRACE(end);
    in_child([&] {
      Rig rig(spec);
      rig.simulate(
          [&] {
            rig.at_tick(98);
            rig.engine->transfer(false, 0, 0, kFnLores);
            rig.at_tick(end);
          },
          end);
      EXPECT_EQ(rig.engine->memory_counters().fetches, end > 102 ? 3u : 0u);
      EXPECT_EQ(rig.engine->memory_counters().refreshes, end > 104 ? 3u : 0u);
    });
  }
}

TEST(ClockedMemory, AFetchOfNoTicksHoldsNothingUp) {
  Spec spec = fetch_at(100 * 200'000);
  spec.memory.fetch_ticks = 0;
  EXPECT_EQ(read_takes(spec, 100), 4);
  in_child([&] {
    Rig rig(spec);
    rig.simulate([&] { rig.at_tick(101); });
    EXPECT_EQ(rig.engine->memory_counters().fetches, 3u);
    EXPECT_EQ(rig.engine->memory_counters().busy_video, 0u);
  });
}

TEST(ClockedMemory, FetchesOfALineAndOfAFrameAreAsManyAsTheRasterHas) {
  in_child([] {
    Rig rig(fetch_at(0));
    const video::Raster r =
        video::raster_of(video::power_on(rig.spec.video.mode), rig.spec.video, rig.spec.memory.fetch_bits);
    const std::int64_t tick = rig.tick(), period = (r.fetch_period_ps + tick - 1) / tick;
    std::uint64_t before_next_line = 0;
    rig.simulate([&] {
      rig.at_tick((r.fetches_per_line - 1) * r.fetch_period_ps / tick + period);
      before_next_line = rig.engine->memory_counters().fetches;
      rig.at_tick((2 * r.field_ps() + tick - 1) / tick);
    });
    EXPECT_EQ(before_next_line, static_cast<std::uint64_t>(3 * r.fetches_per_line));
    EXPECT_EQ(rig.engine->memory_counters().fetches,
              static_cast<std::uint64_t>(3 * 2 * (r.field_lines - r.blank_lines) * r.fetches_per_line));
  });
}

// A program that stays in words 0 while the condition holds, and the tick in which it leaves.
std::int64_t leaves_at(Rig& rig, Cond cond, bool while_false, std::int64_t from) {
  std::int64_t left = -1;
  rig.simulate([&] {
    rig.run({word({{kSeq, am2910::kCJP}, {kCond, cond}, {kPol, while_false}, {kImm, 0}}), word(kHaltNow)},
            from);
  });
  left = rig.engine->runs().at(0).to - 2;
  return left;
}

TEST(ClockedMemory, VerticalBlankEndsWithItsLastLine) {
  in_child([] {
    // The phase is not a whole number of ticks: the flag is that of the edge's own time.
    const std::int64_t phase = 1'000'001;
    Spec spec;
    spec.video.phase_ps = phase;
    const video::Raster r =
        video::raster_of(video::power_on(spec.video.mode), spec.video, spec.memory.fetch_bits);
    Rig rig(spec);
    const std::int64_t first_active = (r.blank_lines * r.line_ps - phase + rig.tick() - 1) / rig.tick();
    EXPECT_EQ(leaves_at(rig, kVerticalBlank, false, 100), first_active);
    EXPECT_TRUE(rig.engine->time_dependent());
  });
}

TEST(ClockedMemory, TheFieldFlagTurnsWithTheField) {
  in_child([] {
    Spec spec;
    const video::Raster r =
        video::raster_of(video::power_on(spec.video.mode), spec.video, spec.memory.fetch_bits);
    Rig rig(spec);
    EXPECT_EQ(leaves_at(rig, kFieldFlag, true, 100), (r.field_ps() + rig.tick() - 1) / rig.tick());
  });
}

TEST(ClockedMemory, ABlankedDisplayIsAlwaysInVerticalBlankAndFetchesNothing) {
  in_child([] {
    Rig rig(Rig::quiet());
    EXPECT_EQ(leaves_at(rig, kVerticalBlank, true, 100), 100);
    EXPECT_EQ(rig.engine->memory_counters().fetches, 0u);
  });
}

TEST(ClockedMemory, AWriteToTheDisplayRateRestartsTheFrameAtItsGrant) {
  in_child([] {
    Spec spec;
    video::State registers = video::power_on(spec.video.mode);
    const video::Raster old = video::raster_of(registers, spec.video, spec.memory.fetch_bits);
    registers.fbc[4] = 144u | (1144u << 16);
    const video::Raster r = video::raster_of(registers, spec.video, spec.memory.fetch_bits);
    ASSERT_NE(old.line_ps, r.line_ps);
    Rig rig(spec);
    std::int64_t left = 0;
    rig.simulate([&] {
      rig.at_tick(37);
      rig.engine->transfer(true, kFbc + 4, registers.fbc[4], 0);
      rig.run({word({{kSeq, am2910::kCJP}, {kCond, kVerticalBlank}, {kImm, 0}}), word(kHaltNow)}, 100);
      left = rig.engine->runs().at(0).to - 2;
    });
    EXPECT_EQ(left, 37 + (r.blank_lines * r.line_ps + rig.tick() - 1) / rig.tick());
    EXPECT_EQ(rig.engine->video().fbc[4], registers.fbc[4]);
  });
}

}  // namespace
}  // namespace dendro::rds3000
