#include "models/parts/am2903/am2903.h"

#include <gtest/gtest.h>

#include <random>

#include "models/parts/am2903/am2903_slices.h"
#include "models/parts/bps32/bps32_isa.h"

namespace dendro::am2903 {
namespace {

constexpr std::uint64_t kSeed = 29;

TEST(Am2903, WordArithmeticAndTheEightSlicesAgreeOnEveryOperation) {
  std::mt19937_64 random(kSeed);
  const std::uint32_t corners[] = {0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF};
  const auto operand = [&] { return random() % 4 == 0 ? corners[random() % 5] : static_cast<std::uint32_t>(random()); };
  for (int i = 0; i < 2'000'000; ++i) {
    const std::uint64_t bits = random();
    const Control control{static_cast<std::uint8_t>(bits & 15), static_cast<std::uint8_t>(bits >> 4 & 15),
                          (bits >> 8 & 1) != 0, static_cast<std::uint8_t>(bits >> 9 & 3)};
    const Input in{operand(), operand(), operand(), (bits >> 11 & 1) != 0, (bits >> 12 & 1) != 0, (bits >> 13 & 1) != 0};
    const Output word = operate(control, in);
    const SliceOutputs slices = evaluate_slices({in.r, in.s, in.q, control.func, control.dest, control.fill, control.i0,
                                                 in.carry_in, in.latched_carry, in.divide_sign});
    ASSERT_TRUE(word.y == slices.y && word.q == slices.q && word.ram_written == slices.write_ram &&
                word.z == slices.z && word.n == slices.n && word.c == slices.c && word.v == slices.v &&
                word.divide_sign == slices.divide_sign)
        << std::hex << "seed " << kSeed << " func " << int{control.func} << " i0 " << control.i0 << " dest "
        << int{control.dest} << " r " << in.r << " s " << in.s << " q " << in.q;
  }
}

TEST(Am2903, SubtractionLeavesCarrySetWhenThereIsNoBorrow) {
  const Control compare{bps32::kYOnly, bps32::kRMinusS, false, 0};
  EXPECT_TRUE(operate(compare, {5, 5, 0, true, false, false}).c);
  EXPECT_TRUE(operate(compare, {5, 5, 0, true, false, false}).z);
  EXPECT_FALSE(operate(compare, {4, 5, 0, true, false, false}).c);
  EXPECT_TRUE(operate(compare, {0x80000000, 1, 0, true, false, false}).v);
}

}  // namespace
}  // namespace dendro::am2903
