#include "models/parts/dr64/dr64.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace dendro::dr64
