#include "models/parts/am2903/am2903_slices.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

#include "models/parts/bps32/bps32_isa.h"

namespace dendro::am2903 {
namespace {

using namespace bps32;
using u32 = std::uint32_t;
using u64 = std::uint64_t;

constexpr unsigned kSeed = 2903;

// Operands that carry far are rare among uniform ones, so half of them are runs of ones and their neighbours.
class Operands {
 public:
  u32 word() {
    const u32 r = static_cast<u32>(random_());
    switch (r & 7) {
      case 0:
        return 0xFFFFFFFFu << (r >> 27);
      case 1:
        return (0xFFFFFFFFu >> (r >> 27)) + ((r >> 3) & 1);
      case 2:
        return 0x80000000u + ((r >> 3) & 3) - 2;
      case 3:
        return ((r >> 3) & 3) - 1;
      default:
        return static_cast<u32>(random_());
    }
  }
  unsigned below(unsigned n) { return static_cast<unsigned>(random_() % n); }
  SliceInputs inputs() {
    SliceInputs in;
    in.r = word();
    in.s = word();
    in.q = word();
    const unsigned bits = below(16);
    in.i0 = (bits & 1) != 0;
    in.carry_in = (bits & 2) != 0;
    in.latched_carry = (bits & 4) != 0;
    in.divide_sign = (bits & 8) != 0;
    return in;
  }

 private:
  std::mt19937_64 random_{kSeed};
};

struct Plain {
  u32 f = 0;
  bool c = false, v = false;
};

Plain plain_sum(u32 a, u32 b, bool carry) {
  const u64 sum = u64{a} + b + carry;
  const std::int64_t exact =
      std::int64_t{static_cast<std::int32_t>(a)} + static_cast<std::int32_t>(b) + carry;
  return {static_cast<u32>(sum), (sum >> 32) != 0, exact != static_cast<std::int32_t>(exact)};
}

Plain plain_function(const SliceInputs& in) {
  const u32 r = in.r, s = in.s;
  switch (in.func) {
    case 0x0:
      return {0xFFFFFFFF};
    case 0x1:
      return plain_sum(s, ~r, in.carry_in);
    case 0x2:
      return plain_sum(r, ~s, in.carry_in);
    case 0x3:
      return plain_sum(r, s, in.carry_in);
    case 0x4:
      return plain_sum(s, 0, in.carry_in);
    case 0x5:
      return plain_sum(~s, 0, in.carry_in);
    case 0x6:
      return plain_sum(r, 0, in.carry_in);
    case 0x7:
      return plain_sum(~r, 0, in.carry_in);
    case 0x8:
      return {0};
    case 0x9:
      return {s & ~r};
    case 0xA:
      return {(r & s) | (~r & ~s)};
    case 0xB:
      return {(r & ~s) | (~r & s)};
    case 0xC:
      return {r & s};
    case 0xD:
      return {~r & ~s};
    case 0xE:
      return {~r | ~s};
    default:
      return {r | s};
  }
}

// The columns of the fill table: what codes 1 and 2 stand for.
u32 fill_of(const SliceInputs& in, u32 one, u32 rotate) {
  const u32 choices[4] = {0, one, rotate, in.latched_carry};
  return choices[in.fill];
}

struct Places {
  u32 y, q;
  bool write_ram;
};

Places plain_destination(const SliceInputs& in, u32 f) {
  const u32 f31 = f >> 31, q31 = in.q >> 31, f0 = f & 1, q0 = in.q & 1;
  const u32 right = fill_of(in, f31, f0), right_both = fill_of(in, f31, q0), left = fill_of(in, 1, f31);
  const u32 keep = f31 << 31;
  switch (in.dest) {
    case 0x0:
      return {keep | (right << 30) | ((f & 0x7FFFFFFE) >> 1), in.q, true};
    case 0x1:
      return {(right << 31) | (f >> 1), in.q, true};
    case 0x2:
      return {keep | (right_both << 30) | ((f & 0x7FFFFFFE) >> 1), (f0 << 31) | (in.q >> 1), true};
    case 0x3:
      return {(right_both << 31) | (f >> 1), (f0 << 31) | (in.q >> 1), true};
    case 0x4:
      return {f, in.q, true};
    case 0x5:
      return {f, (fill_of(in, q31, q0) << 31) | (in.q >> 1), false};
    case 0x6:
      return {f, f, false};
    case 0x7:
      return {f, f, true};
    case 0x8:
      return {keep | ((f & 0x3FFFFFFF) * 2) | left, in.q, true};
    case 0x9:
      return {f * 2 + left, in.q, true};
    case 0xA:
      return {keep | ((f & 0x3FFFFFFF) * 2) | q31, in.q * 2 + left, true};
    case 0xB:
      return {f * 2 + q31, in.q * 2 + left, true};
    case 0xC:
      return {f, in.q, false};
    case 0xD:
      return {f, in.q * 2 + fill_of(in, 1, q31), false};
    case 0xE:
      return {0u - right, in.q, true};
    default:
      return {f, in.q, true};
  }
}

TEST(Am2903Slices, LookAheadAcrossTheSlicesIsAddition) {
  RecordProperty("seed", static_cast<int>(kSeed));
  Operands operands;
  for (int i = 0; i < 2'000'000; ++i) {
    const u32 a = operands.word(), b = operands.word();
    const bool carry = (i & 1) != 0;
    const SliceSum got = look_ahead_sum(a, b, carry);
    const Plain want = plain_sum(a, b, carry);
    ASSERT_TRUE(got.f == want.f && got.carry == want.c && got.overflow == want.v)
        << std::hex << a << " + " << b << " + " << carry << " seed " << kSeed;
  }
}

TEST(Am2903Slices, EveryFunctionDestinationAndFillGivesThePlainResult) {
  Operands operands;
  for (int i = 0; i < 6'000'000; ++i) {
    SliceInputs in = operands.inputs();
    in.func = static_cast<std::uint8_t>(operands.below(16));
    in.dest = static_cast<std::uint8_t>(operands.below(16));
    in.fill = static_cast<std::uint8_t>(operands.below(4));
    if (in.func == kSpecial) in.i0 = true;
    const SliceOutputs got = evaluate_slices(in);
    const Plain f = plain_function(in);
    const Places want = plain_destination(in, f.f);
    ASSERT_TRUE(got.f == f.f && got.y == want.y && got.q == want.q && got.write_ram == want.write_ram &&
                got.c == f.c && got.v == f.v && got.n == (f.f >> 31) && got.z == (want.y == 0) &&
                got.divide_sign == in.divide_sign)
        << std::hex << "func " << +in.func << " dest " << +in.dest << " fill " << +in.fill << " r " << in.r
        << " s " << in.s << " q " << in.q << " seed " << kSeed;
  }
}

SliceOutputs special(unsigned dest, u32 r, u32 s, u32 q, bool carry, bool divide_sign = false) {
  SliceInputs in;
  in.func = kSpecial;
  in.dest = static_cast<std::uint8_t>(dest);
  in.r = r;
  in.s = s;
  in.q = q;
  in.carry_in = carry;
  in.divide_sign = divide_sign;
  return evaluate_slices(in);
}

TEST(Am2903Slices, IncrementSignMagnitudeAndNormaliseFollowTheirRows) {
  Operands operands;
  for (int i = 0; i < 1'000'000; ++i) {
    const SliceInputs in = operands.inputs();
    const u32 s = in.s, q = in.q, r = in.r;
    const SliceOutputs up = special(4, r, s, q, in.carry_in);
    ASSERT_EQ(up.y, s + 1 + in.carry_in);
    ASSERT_EQ(up.q, q);

    // Magnitude and sign of a negative number, and back: with a carry of one it is its own inverse.
    const bool negative = (s >> 31) != 0;
    const SliceOutputs magnitude = special(5, r, s, q, negative);
    ASSERT_EQ(magnitude.y, !negative ? s : s == 0x80000000u ? 0u : (0u - s) | 0x80000000u) << std::hex << s;
    if (s != 0x80000000u) {
      ASSERT_EQ(special(5, r, magnitude.y, q, negative).y, s);
    }

    const SliceOutputs one = special(8, r, s, q, in.carry_in);
    ASSERT_TRUE(one.y == s + in.carry_in && one.q == 2 * q && one.z == (q == 0) && one.n == (q >> 31) &&
                one.c == (((q >> 31) ^ (q >> 30)) & 1) && one.v == (((q >> 30) ^ (q >> 29)) & 1));

    const u32 f = s + in.carry_in;
    const SliceOutputs two = special(0xA, r, s, q, in.carry_in);
    ASSERT_EQ(two.y, 2 * f + (q >> 31));
    ASSERT_TRUE(two.n == (f >> 31) && two.c == (((f >> 31) ^ (f >> 30)) & 1) &&
                two.v == (((f >> 30) ^ (f >> 29)) & 1));
    ASSERT_EQ(two.z, f == 0 && q == 0);
    ASSERT_EQ(two.divide_sign, (r >> 31) == (f >> 31));
    ASSERT_EQ(two.q, 2 * q + two.divide_sign);
  }
}

TEST(Am2903Slices, ReservedSpecialFunctionsWriteNothing) {
  Operands operands;
  for (const unsigned dest : {0x1u, 0x3u, 0x7u, 0x9u, 0xBu, 0xDu, 0xFu}) {
    const SliceInputs in = operands.inputs();
    const SliceOutputs out = special(dest, in.r, in.s, in.q, true, true);
    EXPECT_TRUE(!out.write_ram && out.q == in.q && out.divide_sign && out.y == 0 && out.z && !out.n &&
                !out.c && !out.v)
        << dest;
  }
}

TEST(Am2903Slices, ThirtyTwoUnsignedStepsMultiplyExactly) {
  Operands operands;
  for (int i = 0; i < 100'000; ++i) {
    const u32 x = operands.word(), y = operands.word();
    u32 high = 0, low = y;
    for (int step = 0; step < 32; ++step) {
      const SliceOutputs out = special(0, x, high, low, false);
      high = out.y;
      low = out.q;
    }
    ASSERT_EQ((u64{high} << 32) | low, u64{x} * y) << "seed " << kSeed;
  }
}

// `last_carry` is the carry of the last step, as a function of Q0 before it.
template <class Carry>
u64 signed_product(u32 x, u32 y, const Carry& last_carry) {
  u32 high = 0, low = y;
  for (int step = 0; step < 31; ++step) {
    const SliceOutputs out = special(2, x, high, low, false);
    high = out.y;
    low = out.q;
  }
  const SliceOutputs out = special(6, x, high, low, last_carry((low & 1) != 0));
  return (u64{out.y} << 32) | out.q;
}

TEST(Am2903Slices, ThirtyTwoSignedStepsMultiplyExactlyWhenTheLastCarryIsQ0) {
  Operands operands;
  for (int i = 0; i < 100'000; ++i) {
    const u32 x = operands.word(), y = operands.word();
    const auto want =
        static_cast<u64>(std::int64_t{static_cast<std::int32_t>(x)} * static_cast<std::int32_t>(y));
    ASSERT_EQ(signed_product(x, y, [](bool q0) { return q0; }), want)
        << std::hex << x << " " << y << " seed " << kSeed;
  }
}

struct Division {
  std::int32_t quotient, remainder;
};

// Quotient and remainder of (high, low) by r as the three divide functions form them. The carry follows the
// divide sign, so that S - R and S + R are exact. The quotient is that of the remainder with the divisor's
// sign.
Division divide(u32 high, u32 low, u32 r) {
  SliceOutputs out = special(0xA, r, high, low, false);
  for (int step = 0; step < 31; ++step) out = special(0xC, r, out.y, out.q, out.divide_sign, out.divide_sign);
  out = special(0xE, r, out.y, out.q, out.divide_sign, out.divide_sign);
  u32 remainder = out.y, quotient = out.q;
  // A last digit of 0 stands for a remainder on the wrong side of zero.
  if (!out.divide_sign) remainder += r;
  // Zero counts as positive, which for a negative divisor is the wrong side.
  if (remainder == r) {
    remainder = 0;
    ++quotient;
  }
  return {static_cast<std::int32_t>(quotient), static_cast<std::int32_t>(remainder)};
}

TEST(Am2903Slices, TheDivideFunctionsAndTheirCorrectionGiveExactQuotients) {
  Operands operands;
  int divided = 0;
  while (divided < 200'000) {
    const auto r = static_cast<std::int32_t>(operands.word());
    std::int64_t n = static_cast<std::int32_t>(operands.word());
    if ((divided & 1) != 0) n = n * static_cast<std::int32_t>(operands.word()) / 2;
    if (r == 0) continue;
    const std::int64_t magnitude = n < 0 ? -n : n, divisor = r < 0 ? -std::int64_t{r} : r;
    if (magnitude >= (divisor << 31) - divisor) continue;
    std::int64_t quotient = n / r, remainder = n % r;
    if (remainder != 0 && (remainder < 0) != (r < 0)) {
      remainder += r;
      --quotient;
    }
    const Division got =
        divide(static_cast<u32>(static_cast<u64>(n) >> 32), static_cast<u32>(n), static_cast<u32>(r));
    ASSERT_EQ(got.quotient, quotient) << n << " / " << r << " seed " << kSeed;
    ASSERT_EQ(got.remainder, remainder) << n << " / " << r << " seed " << kSeed;
    ++divided;
  }
}

}  // namespace
}  // namespace dendro::am2903
