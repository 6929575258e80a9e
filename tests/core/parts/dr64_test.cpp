#include "models/parts/dr64/dr64.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

#include "models/parts/bps32/bps32_isa.h"
#include "models/parts/dr64/dr64_timing.h"

namespace dendro::dr64 {
namespace {

using bps32::kFnHires;
using bps32::kFnLores;
using bps32::kFnMaskLores;
using bps32::kFnWord;

std::uint32_t lores_address(unsigned x, unsigned y, unsigned bank = 0) { return bank << 20 | y << 11 | x << 1; }
std::uint32_t hires_address(unsigned x, unsigned y) { return y << 10 | x; }
std::uint32_t word_address(unsigned card, unsigned plane, unsigned x, unsigned y) {
  return card << 16 | plane << 15 | y << 6 | x / 8;
}

TEST(Dr64, ALoresPixelHasEightBitsOfEachCard) {
  Core memory({3, 1});
  memory.write(lores_address(5, 7), 0xAB123456, kFnLores);
  EXPECT_EQ(memory.read(lores_address(5, 7), kFnLores), 0x123456u);
  Core four({4, 1});
  four.write(lores_address(5, 7), 0xAB123456, kFnLores);
  EXPECT_EQ(four.read(lores_address(5, 7), kFnLores), 0xAB123456u);
}

TEST(Dr64, AMemoryWordHoldsHalfAByteOfEightPixelsOfOneCard) {
  Core memory({3, 1});
  for (unsigned x = 0; x < 8; ++x) memory.write(lores_address(16 + x, 3), (0x10u * x | 1) << 8, kFnLores);
  EXPECT_EQ(memory.read(word_address(1, 1, 16, 3), kFnWord), 0x76543210u);
  EXPECT_EQ(memory.read(word_address(1, 0, 16, 3), kFnWord), 0x11111111u);
  EXPECT_EQ(memory.read(word_address(0, 0, 16, 3), kFnWord), 0u);
  memory.write(word_address(2, 0, 16, 3), 0x0000000A, kFnWord);
  EXPECT_EQ(memory.read(lores_address(16, 3), kFnLores), 0x0A0100u);
}

TEST(Dr64, ALoresPixelIsFourHiresPixelsInARow) {
  Core memory({3, 1});
  memory.write(lores_address(300, 10), 0x0000F1, kFnLores);  // card 0: plane 0 = 1, plane 1 = F
  const unsigned hy = 2 * 10 + 1, hx = 4 * (300 - 256);
  EXPECT_EQ(memory.read(hires_address(hx, hy), kFnHires), 0xC0u);
  for (unsigned k = 1; k < 4; ++k) EXPECT_EQ(memory.read(hires_address(hx + k, hy), kFnHires), 0x80u);
  memory.write(hires_address(hx + 1, hy), 0x40, kFnHires);
  EXPECT_EQ(memory.read(lores_address(300, 10), kFnLores), 0xD3u);
}

TEST(Dr64, EveryHiresPixelIsABitOfItsOwn) {
  Core memory({3, 1});
  for (unsigned y = 0; y < 1024; ++y)
    for (unsigned x = 0; x < 1024; ++x) memory.write(hires_address(x, y), (x * 7 + y * 5) % 4 << 6, kFnHires);
  for (unsigned y = 0; y < 1024; ++y)
    for (unsigned x = 0; x < 1024; ++x)
      ASSERT_EQ(memory.read(hires_address(x, y), kFnHires), (x * 7 + y * 5) % 4 << 6) << x << "," << y;
}

TEST(Dr64, AWriteMaskProtectsTheBitsThatAreOff) {
  Core memory({3, 1});
  memory.write(lores_address(1, 1), 0x555555, kFnLores);
  memory.write(0, 0x000FFF, kFnMaskLores);
  EXPECT_TRUE(memory.probe(lores_address(1, 1), kFnLores, true).masked);
  EXPECT_FALSE(memory.probe(lores_address(1, 1), kFnLores, false).masked);
  memory.write(lores_address(1, 1), 0xAAAAAA, kFnLores);
  EXPECT_EQ(memory.read(lores_address(1, 1), kFnLores), 0x555AAAu);
}

TEST(Dr64, TheSecondBankOfA48BitBufferIsASecondPixelWord) {
  Core memory({3, 2});
  memory.write(lores_address(9, 9, 0), 0x111111, kFnLores);
  memory.write(lores_address(9, 9, 1), 0x222222, kFnLores);
  EXPECT_EQ(memory.read(lores_address(9, 9, 0), kFnLores), 0x111111u);
  EXPECT_EQ(memory.read(lores_address(9, 9, 1), kFnLores), 0x222222u);
  EXPECT_EQ(memory.probe(lores_address(9, 9, 1), kFnLores, false).cards, 0x38u);
  EXPECT_FALSE(memory.probe(lores_address(9, 9, 2), kFnLores, false).answered);
}

TEST(Dr64Timing, ACardIsBusyForItsCycleAndFreeOnTheNextTick) {
  Spec spec;
  Timing timing(spec, 200000);
  const Work one{true, 1, false}, other{true, 2, false}, all{true, 7, false};
  EXPECT_EQ(timing.grant(10, one, true), 10);
  EXPECT_EQ(timing.grant(11, other, true), 11);
  EXPECT_EQ(timing.grant(11, one, true), 12);
  EXPECT_EQ(timing.grant(12, all, true), 14);
}

TEST(Dr64Timing, RefreshTakesEveryCardBeforeAnAccessOfTheSameTick) {
  Spec spec;
  spec.refresh_interval_ps = 2000000;  // every ten ticks
  Timing timing(spec, 200000);
  const Work all{true, 7, false};
  EXPECT_EQ(timing.grant(9, all, false), 9);
  EXPECT_EQ(timing.grant(20, all, false), 22);
  EXPECT_EQ(timing.counters().refreshes, 6u);
}

/// Cards with refreshes and fetches that often wait for accesses, and a seeded stream of accesses.
struct Busy {
  Spec spec;
  static constexpr std::int64_t kTick = 200000;

  Busy() {
    spec.card_busy_ticks = 7;
    spec.fetch_ticks = 3;
    spec.refresh_interval_ps = 11 * kTick + 70000;
  }
  Timing timing() const {
    Timing timing(spec, kTick);
    timing.set_fetches({raster(), 0, 0, kTick});
    return timing;
  }
  static video::Raster raster() {
    video::Raster raster;
    raster.line_ps = 97 * kTick + 30000;
    raster.field_lines = 5;
    raster.blank_lines = 1;
    raster.fetches_per_line = 4;
    raster.fetch_period_ps = 13 * kTick;
    return raster;
  }
  /// Calls between(tick) before every access, tick never after the access's request.
  template <class Between>
  static std::vector<std::int64_t> drive(Timing& timing, unsigned seed, const Between& between) {
    std::mt19937 random(seed);
    std::vector<std::int64_t> granted;
    std::int64_t at = 0;
    for (int i = 0; i < 300; ++i) {
      at += 1 + random() % 12;
      between(at);
      at = timing.grant(at, {true, 1u + static_cast<unsigned>(random() % 7), random() % 4 == 0}, random() % 2 == 0);
      granted.push_back(at);
    }
    return granted;
  }
};

std::array<std::uint64_t, 6> numbers(const Counters& c) {
  return {c.busy_access, c.busy_video, c.busy_refresh, c.fetches, c.refreshes, c.wait_ticks};
}

TEST(Dr64Timing, CatchingUpInTheMiddleLosesNoCount) {
  const Busy busy;
  for (unsigned seed = 0; seed < 20; ++seed) {
    Timing plain = busy.timing(), caught = busy.timing(), settled = busy.timing();
    const auto grants = Busy::drive(plain, seed, [](std::int64_t) {});
    EXPECT_EQ(grants, Busy::drive(caught, seed, [&](std::int64_t tick) { caught.catch_up(tick); }));
    EXPECT_EQ(grants, Busy::drive(settled, seed, [&](std::int64_t tick) { settled.settle(tick); }));
    for (Timing* timing : {&plain, &caught, &settled}) timing->settle(grants.back() + 40);
    EXPECT_EQ(numbers(plain.counters()), numbers(caught.counters()));
    EXPECT_GT(plain.counters().busy_video + plain.counters().busy_refresh,
              settled.counters().busy_video + settled.counters().busy_refresh)
        << "settle() is for the end of a run alone";
  }
}

TEST(Dr64Timing, TheCountersBeforeATickAreThoseOfARunThatEndsThereAndAskingChangesNothing) {
  const Busy busy;
  for (unsigned seed = 0; seed < 20; ++seed) {
    Timing plain = busy.timing(), asked = busy.timing();
    const auto grants = Busy::drive(plain, seed, [](std::int64_t) {});
    EXPECT_EQ(grants, Busy::drive(asked, seed, [&](std::int64_t tick) {
                Timing ends = asked;
                ends.settle(tick);
                EXPECT_EQ(numbers(ends.counters()), numbers(asked.counters_before(tick)));
              }));
    for (Timing* timing : {&plain, &asked}) timing->settle(grants.back() + 40);
    EXPECT_EQ(numbers(plain.counters()), numbers(asked.counters()));
  }
}

}  // namespace
}  // namespace dendro::dr64
