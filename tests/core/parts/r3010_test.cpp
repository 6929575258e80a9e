#include "models/parts/r3010/r3010.h"

#include <gtest/gtest.h>

#include <cfenv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace dendro::r3010 {
namespace {

std::uint64_t bits(double value) {
  std::uint64_t b;
  std::memcpy(&b, &value, 8);
  return b;
}
std::uint64_t bits(float value) {
  std::uint32_t b;
  std::memcpy(&b, &value, 4);
  return b;
}

constexpr std::uint64_t kQuiet = 0x7FF7FFFFFFFFFFFF, kSignaling = 0x7FF8000000000001;

/// Around every edge of a format, both signs.
std::vector<std::uint64_t> corners(Format format) {
  const unsigned fraction = format == kDouble ? 52 : 23, exponent_bits = format == kDouble ? 11 : 8;
  const std::uint64_t top = (std::uint64_t{1} << exponent_bits) - 1, bias = top / 2;
  const std::uint64_t ones = (std::uint64_t{1} << fraction) - 1;
  std::vector<std::uint64_t> list;
  for (const std::uint64_t e :
       {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{2}, bias - fraction - 1, bias - fraction, bias - 1,
        bias, bias + 1, bias + 30, bias + 31, bias + fraction, bias + fraction + 1, top - 2, top - 1, top})
    for (const std::uint64_t f : {std::uint64_t{0}, std::uint64_t{1}, ones / 2, ones / 2 + 1, ones - 1, ones})
      for (const std::uint64_t sign : {0, 1})
        list.push_back(sign << (fraction + exponent_bits) | e << fraction | f);
  return list;
}

constexpr Rounding kModes[] = {kNearest, kZero, kUp, kDown};
constexpr Operation kTwo[] = {kAdd, kSub, kMul, kDiv}, kOne[] = {kAbs, kMov, kNeg, kCvtS, kCvtD, kCvtW};

void expect_same(Operation operation, Format format, std::uint64_t a, std::uint64_t b, Rounding rounding) {
  const Result soft = soft_compute(operation, format, a, b, rounding),
               fast = compute(operation, format, a, b, rounding);
  if (!(soft == fast))
    ADD_FAILURE() << std::hex << "operation " << operation << " format " << format << " a " << a << " b " << b
                  << " rounding " << rounding << ": soft " << soft.bits << "/" << soft.exceptions << " fast "
                  << fast.bits << "/" << fast.exceptions;
}

/// What the host says, as a second opinion on the soft path: value and exceptions, nothing for what the part
/// does not do.
template <class Real>
Result host(Operation operation, Real a, Real b, Rounding rounding) {
  static const int kHostModes[] = {FE_TONEAREST, FE_TOWARDZERO, FE_UPWARD, FE_DOWNWARD};
  std::fesetround(kHostModes[rounding]);
  std::feclearexcept(FE_ALL_EXCEPT);
  volatile Real x = a, y = b, z = 0;
  if (operation == kAdd) z = x + y;
  if (operation == kSub) z = x - y;
  if (operation == kMul) z = x * y;
  if (operation == kDiv) z = x / y;
  const int flags = std::fetestexcept(FE_ALL_EXCEPT);
  std::fesetround(FE_TONEAREST);
  return {bits(Real(z)), (flags & FE_INEXACT ? kInexact : 0u) | (flags & FE_OVERFLOW ? kOverflow : 0u) |
                             (flags & FE_DIVBYZERO ? kDivideByZero : 0u) |
                             (flags & FE_INVALID ? kInvalid : 0u)};
}

template <class Real>
void expect_host(Operation operation, Format format, std::uint64_t a, std::uint64_t b, Rounding rounding) {
  Real x, y;
  std::memcpy(&x, &a, sizeof x);
  std::memcpy(&y, &b, sizeof y);
  if (std::isnan(x) || std::isnan(y)) return;  // the two disagree on what a NaN looks like
  const Result soft = soft_compute(operation, format, a, b, rounding),
               other = host(operation, x, y, rounding);
  const auto subnormal = [](Real v) { return std::fpclassify(v) == FP_SUBNORMAL; };
  Real z;
  std::memcpy(&z, &other.bits, sizeof z);
  if (subnormal(x) || subnormal(y) || subnormal(z)) {
    const bool invalid_first = (other.exceptions & kInvalid) != 0;
    ASSERT_TRUE((soft.exceptions & kUnimplemented) || invalid_first) << std::hex << a << " " << b;
    return;
  }
  if (soft.exceptions & kUnimplemented) {  // tiny before rounding, no more after it
    ASSERT_LE(std::fabs(z), std::numeric_limits<Real>::min()) << std::hex << a << " " << b;
    return;
  }
  ASSERT_EQ(other.exceptions, soft.exceptions)
      << std::hex << operation << " " << a << " " << b << " " << rounding;
  if (!std::isnan(z)) {
    ASSERT_EQ(other.bits, soft.bits) << std::hex << operation << " " << a << " " << b << " " << rounding;
  }
}

/// Operands whose exponents lie near each other or near an edge as often as anywhere.
std::uint64_t draw(std::mt19937_64& random, Format format, std::uint64_t near) {
  const unsigned fraction = format == kDouble ? 52 : 23;
  const std::uint64_t mask = format == kDouble ? ~std::uint64_t{0} : 0xFFFFFFFF, all = random() & mask;
  const std::uint64_t exponents = ((format == kDouble ? std::uint64_t{0x7FF} : 0xFF) << fraction);
  std::uint64_t value = all;
  const unsigned kind = random() % 8;
  if (kind < 5) {
    const std::uint64_t e = ((near & exponents) >> fraction) + random() % 9 - 4;
    value = (all & ~exponents) | (e << fraction & exponents);
  }
  if (kind == 1 || kind == 6)
    value &= ~((std::uint64_t{1} << random() % fraction) - 1);  // few bits: ties and exact results
  if (kind == 2) value |= (std::uint64_t{1} << random() % fraction) - 1;
  return value;
}

void random_operands(std::uint64_t seed, int count) {
  std::mt19937_64 random(seed);
  SCOPED_TRACE("seed " + std::to_string(seed));
  const std::uint64_t one[] = {bits(1.0F), bits(1.0)};
  for (int i = 0; i < count && !testing::Test::HasFailure(); ++i) {
    const Format format = random() % 2 ? kDouble : kSingle;
    const std::uint64_t a = draw(random, format, one[format == kDouble]), b = draw(random, format, a);
    const Rounding rounding = kModes[random() % 4];
    const Operation two = kTwo[random() % 4];
    expect_same(two, format, a, b, rounding);
    if (format == kDouble)
      expect_host<double>(two, format, a, b, rounding);
    else
      expect_host<float>(two, format, a, b, rounding);
    const Operation op = kOne[random() % 6];
    expect_same(
        op, format,
        draw(random, format,
             one[format == kDouble] + (std::uint64_t{random() % 40} << (format == kDouble ? 52 : 23))),
        0, rounding);
    expect_same(random() % 2 ? kCvtS : kCvtD, kWord, static_cast<std::uint32_t>(a), 0, rounding);
  }
}

TEST(R3010, FastAndSoftPathAgreeOnEveryPairOfCorners) {
  for (const Format format : {kSingle, kDouble})
    for (const Rounding rounding : kModes)
      for (const std::uint64_t a : corners(format)) {
        for (const Operation operation : kOne) expect_same(operation, format, a, 0, rounding);
        for (const std::uint64_t b : corners(format))
          for (const Operation operation : kTwo) expect_same(operation, format, a, b, rounding);
      }
}

TEST(R3010, SoftPathAgreesWithTheHostOnEveryPairOfCorners) {
  for (const Rounding rounding : kModes) {
    for (const std::uint64_t a : corners(kSingle))
      for (const std::uint64_t b : corners(kSingle))
        for (const Operation operation : kTwo) expect_host<float>(operation, kSingle, a, b, rounding);
    for (const std::uint64_t a : corners(kDouble))
      for (const std::uint64_t b : corners(kDouble))
        for (const Operation operation : kTwo) expect_host<double>(operation, kDouble, a, b, rounding);
  }
}

TEST(R3010, FastSoftAndHostAgreeOnRandomOperands) { random_operands(1, 100'000); }

TEST(R3010Long, FastSoftAndHostAgreeOnMillionsOfRandomOperands) {
  const char* seed = std::getenv("SEED");
  random_operands(seed ? std::strtoull(seed, nullptr, 0) : 2, 20'000'000);
}

TEST(R3010, ConversionToAWordRoundsAsTheModeSays) {
  struct Case {
    double value;
    std::int32_t nearest, zero, up, down;
  };
  for (const Case& c : {Case{2.5, 2, 2, 3, 2},
                        {-2.5, -2, -2, -2, -3},
                        {3.5, 4, 3, 4, 3},
                        {0.4, 0, 0, 1, 0},
                        {-0.6, -1, 0, 0, -1},
                        {2147483646.5, 2147483646, 2147483646, 2147483647, 2147483646}}) {
    const std::int32_t expected[] = {c.nearest, c.zero, c.up, c.down};
    for (const Rounding rounding : kModes) {
      const Result result = soft_compute(kCvtW, kDouble, bits(c.value), 0, rounding);
      EXPECT_EQ(static_cast<std::uint32_t>(expected[rounding]), result.bits) << c.value << " " << rounding;
      EXPECT_EQ(unsigned{kInexact}, result.exceptions);
    }
  }
}

TEST(R3010, ConversionOfWhatDoesNotFitIsInvalid) {
  for (const double value : {2147483648.0, -2147483649.0, 1e300, -std::numeric_limits<double>::infinity()})
    EXPECT_EQ((Result{0x7FFFFFFF, kInvalid}), compute(kCvtW, kDouble, bits(value), 0, kZero)) << value;
  EXPECT_EQ((Result{0x80000000, 0}), compute(kCvtW, kDouble, bits(-2147483648.0), 0, kZero));
}

TEST(R3010, DenormalsAreUnimplementedAsOperandAndAsResult) {
  const std::uint64_t denormal = 1, smallest = bits(std::numeric_limits<double>::min());
  for (const Operation operation : kTwo)
    EXPECT_EQ(unsigned{kUnimplemented},
              compute(operation, kDouble, denormal, bits(1.0), kNearest).exceptions);
  EXPECT_EQ(unsigned{kUnimplemented}, compute(kMul, kDouble, smallest, bits(0.5), kNearest).exceptions);
  EXPECT_EQ(unsigned{kUnimplemented}, compute(kCvtS, kDouble, smallest, 0, kNearest).exceptions);
  EXPECT_EQ(0u, compute(kMul, kDouble, smallest, bits(1.0), kNearest).exceptions);
  EXPECT_EQ(denormal, compute(kMov, kDouble, denormal, 0, kNearest).bits);
}

TEST(R3010, NansPropagateQuietlyAndSignalLoudly) {
  EXPECT_EQ((Result{kQuiet - 5, 0}), compute(kAdd, kDouble, kQuiet - 5, bits(1.0), kNearest));
  EXPECT_EQ((Result{kQuiet - 5, 0}), compute(kMul, kDouble, bits(1.0), kQuiet - 5, kNearest));
  EXPECT_EQ((Result{kQuiet, kInvalid}), compute(kAdd, kDouble, kSignaling, kQuiet - 5, kNearest));
  EXPECT_EQ((Result{kQuiet, kInvalid}), compute(kDiv, kDouble, 0, 0, kNearest));
  EXPECT_EQ((Result{0x7FBFFFFF, kInvalid}), compute(kSub, kSingle, 0x7F800000, 0x7F800000, kNearest));
}

TEST(R3010, ComparisonsAreAllSixteenOfTheirBits) {
  const std::uint64_t values[] = {bits(-1.0),
                                  bits(-0.0),
                                  bits(0.0),
                                  bits(2.0),
                                  bits(-3.0),
                                  kQuiet,
                                  bits(std::numeric_limits<double>::infinity()),
                                  1};
  for (const std::uint64_t a : values)
    for (const std::uint64_t b : values)
      for (unsigned condition = 0; condition < 16; ++condition) {
        double x, y;
        std::memcpy(&x, &a, 8);
        std::memcpy(&y, &b, 8);
        const bool unordered = a == kQuiet || b == kQuiet;
        const bool expected = ((condition & 1) && unordered) || ((condition & 2) && !unordered && x == y) ||
                              ((condition & 4) && !unordered && x < y);
        const Result result = soft_compare(condition, kDouble, a, b);
        EXPECT_EQ(expected, result.bits == 1) << x << " " << y << " " << condition;
        EXPECT_EQ(unordered && condition >= 8, result.exceptions == kInvalid);
      }
}

TEST(R3010, FlagsStickAndCausesAreThoseOfTheLastOperation) {
  State s;
  s.r[3] = 0x3FF00000;  // 1.0
  s.r[5] = 0x40080000;  // 3.0
  EXPECT_EQ(Outcome::kDone, execute(s, fp_word(kDouble, kDiv, 6, 2, 4)));
  EXPECT_EQ(unsigned{kInexact} << kCauseShift | kInexact << kFlagShift, s.control);
  EXPECT_EQ(Outcome::kDone, execute(s, fp_word(kDouble, kAdd, 6, 2, 4)));
  EXPECT_EQ(unsigned{kInexact} << kFlagShift, s.control);
}

TEST(R3010, AnEnabledExceptionChangesOnlyTheCause) {
  State s;
  s.r[3] = 0x3FF00000;
  s.r[6] = s.r[7] = 0x55555555;
  s.control = unsigned{kDivideByZero} << kEnableShift;
  EXPECT_EQ(Outcome::kInterrupt, execute(s, fp_word(kDouble, kDiv, 6, 2, 4)));
  EXPECT_TRUE(s.interrupting());
  EXPECT_EQ(0x55555555u, s.r[7]);
  EXPECT_EQ(0u, s.control >> kFlagShift & 31);
  EXPECT_EQ(unsigned{kDivideByZero}, s.control >> kCauseShift & 63);
}

TEST(R3010, ControlRegistersOtherThanZeroAndTheStatusReadZero) {
  State s;
  s.control = kCondition;
  EXPECT_EQ(kRevision, read_control(s, 0));
  EXPECT_EQ(kCondition, read_control(s, 31));
  for (unsigned reg = 1; reg < 31; ++reg) EXPECT_EQ(0u, read_control(s, reg));
}

TEST(R3010, FormatsAndFunctionsThatDoNotExistAreUnimplemented) {
  const std::uint32_t words[] = {fp_word(kDouble, 4, 0, 0),
                                 fp_word(kSingle, 13, 0, 0),  // sqrt and trunc.w of MIPS II
                                 fp_word(kSingle, kCvtS, 0, 0), fp_word(kWord, kAdd, 0, 0),
                                 fp_word(static_cast<Format>(18), kAdd, 0, 0)};
  for (const std::uint32_t word : words) {
    State s;
    EXPECT_EQ(Outcome::kInterrupt, execute(s, word)) << std::hex << word;
    EXPECT_EQ(unsigned{kUnimplemented}, s.control >> kCauseShift & 63);
  }
}

}  // namespace
}  // namespace dendro::r3010
