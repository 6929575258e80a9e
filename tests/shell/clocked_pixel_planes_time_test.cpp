#include "sim/base/error.h"
#include "tests/shell/clocked_pixel_planes_rig.h"

namespace dendro::pixel_planes {
namespace {

using igc::MicroWord;

void expect_counters(const Rig& rig, const ControllerCounters& want) {
  const ControllerCounters& c = rig.engine->controller_counters();
  EXPECT_EQ(c.busy, want.busy);
  EXPECT_EQ(c.stall_refresh, want.stall_refresh);
  EXPECT_EQ(c.stall_video, want.stall_video);
  EXPECT_EQ(c.stall_translator, want.stall_translator);
  EXPECT_EQ(c.stall_drain, want.stall_drain);
  EXPECT_EQ(c.idle, want.idle);
  EXPECT_EQ(rig.total(), static_cast<std::uint64_t>(rig.engine->clocks()));
}

// The word is offered at 4 ticks, lands in clock 4, is taken in clock 5 and goes out as an idle word in clock
// 6, which takes effect in clock 18.
TEST(ClockedPixelPlanesTime, ARegisterWriteIsOneWordBehindTheClockOfItsHeader) {
  in_child([] {
    Rig rig(small());
    rig.engine->simulate([&](HostPort& host) { host.write(kFifo, register_write(1, 2), 0); });
    EXPECT_EQ(rig.engine->clocks(), 19);
    expect_counters(rig, {1, 0, 0, 1, 12, 5});
  });
}

// The program's word takes 8 clocks to load, the command's words land in 12, 16, 20, 24; the last is taken in
// clock 25.
TEST(ClockedPixelPlanesTime, AnExpressionIsSetUpBehindItsLastWord) {
  for (const int setup : {0, 1, 4, 16}) {
    in_child([setup] {
      Spec spec = small();
      spec.setup_clocks = setup;
      Rig rig(spec);
      MicroWord end;
      end.end = true;
      rig.engine->simulate([&](HostPort& host) {
        rig.load(host, {end});
        rig.send(host, plane_command(0, 0, 0, 0));
      });
      EXPECT_EQ(rig.engine->clocks(), 26 + setup + 12 + 1);
      expect_counters(rig, {1, 0, 0, static_cast<std::uint64_t>(13 + setup), 12, 13});
    });
  }
}

TEST(ClockedPixelPlanesTime, CommandsThatWaitFollowEachOtherWithoutAGap) {
  in_child([] {
    Rig rig(small());
    rig.engine->simulate([&](HostPort& host) {
      rig.load(host, store_program(10));
      rig.send(host, plane_command(0, 1, 1, 1));
      rig.send(host, plane_command(0, 1, 1, 1));
      host.wait_interrupt();
      rig.load(host, store_program(10, 60));
      for (int i = 0; i < 3; ++i) rig.send(host, plane_command(0, 1, 1, 1));
    });
    // 60 idle words, 1, 10, 1: longer than the 21 clocks that the next command needs, so there is no waiting
    // between.
    const std::uint64_t each = 72;
    EXPECT_EQ(rig.engine->controller_counters().busy, 3 * each + 2 * 12);
    EXPECT_EQ(rig.engine->fifo_counters().commands, 5u);
    EXPECT_EQ(rig.engine->fifo_counters().words, 20u);
    EXPECT_EQ(rig.engine->fifo_counters().full_clocks, 0u);
  });
}

TEST(ClockedPixelPlanesTime, StolenClocksStopControllerTreeAndArrayButNotTheTranslator) {
  for (const bool steals : {false, true}) {
    in_child([steals] {
      Spec spec = small();
      // Refresh in clocks 20, 40, 60, ...; video events at 20.0, 40.0 too, so it takes clocks 21, 41, ...
      if (steals) spec.refresh_interval_ps = spec.video_interval_ps = 20 * spec.tick_ps;
      Rig rig(spec);
      rig.engine->simulate([&](HostPort& host) {
        rig.load(host, store_program(16));
        rig.send(host, plane_command(0, 3, -5, 100));
      });
      // 10 words of program and 4 of the command take 56 clocks; the last is taken in clock 57, ready in 62.
      // 18 words and 12 clocks of tree: without stealing idle from clock 92.
      EXPECT_EQ(rig.engine->clocks(), steals ? 92 + 2 : 92);
      const ControllerCounters& c = rig.engine->controller_counters();
      EXPECT_EQ(c.busy, 18u);
      EXPECT_EQ(c.stall_refresh, 0u);
      for (unsigned x = 0; x < 64; x += 9)
        for (unsigned y = 0; y < 64; y += 7)
          ASSERT_EQ(rig.number(x, y, 0, 16), 3 * static_cast<int>(x) - 5 * static_cast<int>(y) + 100);
    });
  }
}

TEST(ClockedPixelPlanesTime, AStolenClockIsAStallOfItsThiefOnlyWhileACommandRunsOrIsReady) {
  in_child([] {
    Spec spec = small();
    spec.refresh_interval_ps = 7 * spec.tick_ps;
    spec.video_interval_ps = 5 * spec.tick_ps;
    Rig rig(spec);
    rig.engine->simulate([&](HostPort& host) {
      rig.load(host, store_program(16, 40));
      rig.send(host, plane_command(0, 3, -5, 100));
      host.compute({600, 0, 0});
    });
    // Ready in clock 40 * 8 + 40 + 56 + 1 + 5 = 382 and then 58 words: counted by hand with the rule of
    // stolen clocks.
    std::int64_t next_refresh = 7, next_video = 5, sent = 0, refresh = 0, video = 0;
    std::vector<char> queue;
    for (std::int64_t n = 0; sent < 58; ++n) {
      while (next_refresh <= n || next_video <= n) {
        const bool first = next_refresh <= next_video;
        queue.push_back(first ? 'r' : 'v');
        (first ? next_refresh : next_video) += first ? 7 : 5;
      }
      const char thief = queue.empty() ? ' ' : queue.front();
      if (!queue.empty()) queue.erase(queue.begin());
      if (n < 382) continue;
      sent += thief == ' ', refresh += thief == 'r', video += thief == 'v';
    }
    EXPECT_EQ(rig.engine->controller_counters().busy, 58u);
    EXPECT_EQ(rig.engine->controller_counters().stall_refresh, static_cast<std::uint64_t>(refresh));
    EXPECT_EQ(rig.engine->controller_counters().stall_video, static_cast<std::uint64_t>(video));
    EXPECT_GT(refresh, 0);
    EXPECT_GT(video, 0);
  });
}

TEST(ClockedPixelPlanesTime, AFullFifoHoldsTheHostUntilTheClockInWhichItsWordLands) {
  in_child([] {
    Spec spec = small();
    spec.fifo_words = 1;
    spec.host.word_ps = 1;
    std::vector<std::int64_t> after;
    Rig rig(spec);
    rig.engine->simulate([&](HostPort& host) {
      for (int i = 0; i < 5; ++i) {
        host.write(kFifo, register_write(1, 2), 0);
        after.push_back(now_ps());
      }
    });
    // Lands in 0; taken in 1, so room at the beginning of 2; the translator holds its command until it is
    // taken in 2 and takes the next header in 3: one word in two clocks. In the other clock it is full.
    EXPECT_EQ(after, (std::vector<std::int64_t>{1, 200000, 400000, 600000, 800000}));
    EXPECT_EQ(rig.engine->fifo_counters().full_clocks, 4u);
  });
}

TEST(ClockedPixelPlanesTime, OneWordLandsInAClock) {
  in_child([] {
    Spec spec = small();
    spec.host.word_ps = 1;
    std::vector<std::int64_t> after;
    Rig rig(spec);
    rig.engine->simulate([&](HostPort& host) {
      for (int i = 0; i < 4; ++i) {
        host.write(kFifo, register_write(1, 2), 0);
        after.push_back(now_ps());
      }
    });
    EXPECT_EQ(after, (std::vector<std::int64_t>{1, 100000, 200000, 300000}));
    EXPECT_EQ(rig.engine->fifo_counters().full_clocks, 0u);
  });
}

TEST(ClockedPixelPlanesTime, TheInterruptComesBehindIdleOrBehindTheCall) {
  in_child([] {
    Spec spec = small();
    spec.host.interrupt_ps = 123;
    Rig rig(spec);
    std::vector<std::int64_t> after;
    rig.engine->simulate([&](HostPort& host) {
      host.wait_interrupt();
      after.push_back(now_ps());
      host.write(kFifo, register_write(1, 2), 0);
      EXPECT_EQ(host.read(kStatus, 0), 1u);
      host.wait_interrupt();
      after.push_back(now_ps());
      EXPECT_EQ(host.read(kStatus, 0), 0u);
      host.compute({100, 0, 0});
      const std::int64_t called = now_ps();
      host.wait_interrupt();
      after.push_back(now_ps() - called);
    });
    EXPECT_EQ(after, (std::vector<std::int64_t>{123, 19 * 100000 + 123, 123}));
  });
}

// Every picosecond of a clock as the time of the call, the last one included, in which the engine works the
// clock out.
TEST(ClockedPixelPlanesTime, ItDoesNotMatterInWhichPicosecondOfAClockTheHostCalls) {
  for (const std::int64_t offset : {0, 1, 50000, 99998, 99999}) {
    in_child([offset] {
      Spec spec = small();
      spec.host.word_ps = 1;
      spec.host.interrupt_ps = 1;
      spec.host.flop_ps = 1;
      Rig rig(spec);
      rig.engine->simulate([&](HostPort& host) {
        host.compute({static_cast<std::uint64_t>(1000000 + offset - 1), 0, 0});
        host.write(kFifo, register_write(1, 2), 0);
        EXPECT_EQ(now_ps(), 1000000 + offset);
        host.wait_interrupt();
        // Lands in 10, taken in 11, sent in 12, takes effect in 24.
        EXPECT_EQ(now_ps(), 2500001);
        host.compute({static_cast<std::uint64_t>(499999 + offset), 0, 0});
        host.wait_interrupt();
        EXPECT_EQ(now_ps(), 3000001 + offset);
      });
      EXPECT_EQ(rig.engine->clocks(), 31);
    });
  }
}

TEST(ClockedPixelPlanesTime, ARunOfAHostThatDoesNothingTakesNoTime) {
  in_child([] {
    Rig rig(small());
    rig.engine->simulate([](HostPort&) {});
    EXPECT_EQ(rig.engine->clocks(), 0);
  });
}

TEST(ClockedPixelPlanesTime, WhatCannotEndEndsWithOneClearLine) {
  const auto fails = [](const MachineOptions& options, const std::function<void(HostPort&)>& program) {
    in_child([&] {
      Rig rig(small(), options);
      EXPECT_THROW(rig.engine->simulate(program), UserError);
    });
  };
  igc::Header h;
  h.constant = true;
  fails({}, [&](HostPort& host) { host.write(kFifo, igc::pack(h), 0); });
  fails({}, [&](HostPort& host) {
    host.write(kFifo, igc::pack(h), 0);
    host.wait_interrupt();
  });
  MachineOptions limited;
  limited.tick_limit = 5000;
  fails(limited, [&](HostPort& host) {  // a store of zeros has no word that ends
    host.write(kFifo, igc::pack(igc::Header()), 0);
    host.wait_interrupt();
  });
  fails({}, [&](HostPort& host) {
    MicroWord none;
    none.loop = igc::LoopCount::kGuard;
    none.loop_end = none.end = true;
    const std::uint64_t word = igc::pack(none);
    host.write(0, static_cast<std::uint32_t>(word), 0);
    host.write(1, static_cast<std::uint32_t>(word >> 32), 0);
    host.write(kFifo, igc::pack(igc::Header()), 0);
  });
  fails({}, [](HostPort&) { throw UserError("wrong scene"); });
}

}  // namespace
}  // namespace dendro::pixel_planes
