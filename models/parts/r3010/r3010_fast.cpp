#include <cstring>

#include "models/parts/r3010/r3010.h"

namespace dendro::r3010 {

#ifdef __SSE2__
namespace {

/// The host's control word: all exceptions masked, no flags; the rounding field has its own order of modes.
constexpr std::uint32_t kHostControl = 0x1F80, kHostInexact = 0x20;
constexpr std::uint32_t kHostRounding[] = {0, 0x6000, 0x4000, 0x2000};

/// One instruction between setting and reading the host's control word; `asm volatile` keeps the three
/// together.
#define DENDRO_HOST_OP(instruction, a, b)                                      \
  asm volatile("ldmxcsr %[in]\n\t" instruction " %[y], %[x]\n\tstmxcsr %[out]" \
               : [x] "+x"(a), [out] "=m"(after)                                \
               : [y] "x"(b), [in] "m"(before))

constexpr std::uint32_t kUsual = kHostControl;

/// The host's rounding mode as everybody else expects it. Flags that stay behind harm nobody.
inline void restore(Rounding rounding) {
  if (rounding != kNearest) asm volatile("ldmxcsr %[usual]" : : [usual] "m"(kUsual));
}

template <class Real, class Bits>
Real real_of(std::uint64_t bits) {
  const auto narrow = static_cast<Bits>(bits);
  Real value;
  std::memcpy(&value, &narrow, sizeof value);
  return value;
}

template <class Real, class Bits>
Bits bits_of(Real value) {
  Bits bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

bool normal_double(std::uint64_t bits) { return (((bits >> 52) + 1) & 0x7FF) > 1; }
bool normal_single(std::uint64_t bits) { return (((bits >> 23) + 1) & 0xFF) > 1; }
/// Above the smallest normal number and finite: neither tiny nor overflowed, whatever the rounding did.
bool safe_double(std::uint64_t bits) { return normal_double(bits) && (bits << 1) != std::uint64_t{1} << 53; }
bool safe_single(std::uint64_t bits) { return normal_single(bits) && (bits & 0x7FFFFFFF) != 0x00800000; }
/// The largest finite number may be an overflow cut off.
bool largest_double(std::uint64_t bits) { return bits << 1 == 0xFFDFFFFFFFFFFFFE; }
bool largest_single(std::uint64_t bits) { return (bits & 0x7FFFFFFF) == 0x7F7FFFFF; }

bool double_op(Operation operation, std::uint64_t a, std::uint64_t b, Rounding rounding, Result& result) {
  const std::uint32_t before = kHostControl | kHostRounding[rounding];
  std::uint32_t after = 0;
  auto x = real_of<double, std::uint64_t>(a);
  const auto y = real_of<double, std::uint64_t>(b);
  switch (operation) {
    case kAdd:
      DENDRO_HOST_OP("addsd", x, y);
      break;
    case kSub:
      DENDRO_HOST_OP("subsd", x, y);
      break;
    case kMul:
      DENDRO_HOST_OP("mulsd", x, y);
      break;
    default:
      DENDRO_HOST_OP("divsd", x, y);
      break;
  }
  restore(rounding);
  const std::uint64_t bits = bits_of<double, std::uint64_t>(x);
  result = {bits, after & kHostInexact ? unsigned{kInexact} : 0u};
  return safe_double(bits) && !largest_double(bits);
}

bool single_op(Operation operation, std::uint64_t a, std::uint64_t b, Rounding rounding, Result& result) {
  const std::uint32_t before = kHostControl | kHostRounding[rounding];
  std::uint32_t after = 0;
  auto x = real_of<float, std::uint32_t>(a);
  const auto y = real_of<float, std::uint32_t>(b);
  switch (operation) {
    case kAdd:
      DENDRO_HOST_OP("addss", x, y);
      break;
    case kSub:
      DENDRO_HOST_OP("subss", x, y);
      break;
    case kMul:
      DENDRO_HOST_OP("mulss", x, y);
      break;
    default:
      DENDRO_HOST_OP("divss", x, y);
      break;
  }
  restore(rounding);
  const std::uint32_t bits = bits_of<float, std::uint32_t>(x);
  result = {bits, after & kHostInexact ? unsigned{kInexact} : 0u};
  return safe_single(bits) && !largest_single(bits);
}

bool double_to_single(std::uint64_t a, Rounding rounding, Result& result) {
  const std::uint32_t before = kHostControl | kHostRounding[rounding];
  std::uint32_t after = 0;
  const auto x = real_of<double, std::uint64_t>(a);
  float y = 0;
  DENDRO_HOST_OP("cvtsd2ss", y, x);
  restore(rounding);
  const std::uint32_t bits = bits_of<float, std::uint32_t>(y);
  result = {bits, after & kHostInexact ? unsigned{kInexact} : 0u};
  return safe_single(bits) && !largest_single(bits);
}

bool double_to_word(std::uint64_t a, Rounding rounding, Result& result) {
  const std::uint32_t before = kHostControl | kHostRounding[rounding];
  std::uint32_t after = 0, word = 0;
  const auto x = real_of<double, std::uint64_t>(a);
  asm volatile("ldmxcsr %[in]\n\tcvtsd2si %[y], %[x]\n\tstmxcsr %[out]\n\tldmxcsr %[usual]"
               : [x] "=r"(word), [out] "=m"(after)
               : [y] "x"(x), [in] "m"(before), [usual] "m"(kUsual));
  result = {word, after & kHostInexact ? unsigned{kInexact} : 0u};
  return word != 0x80000000;  // also the host's answer to what does not fit
}

Result word_to_single(std::uint64_t a, Rounding rounding) {
  const std::uint32_t before = kHostControl | kHostRounding[rounding];
  std::uint32_t after = 0;
  const auto x = static_cast<std::uint32_t>(a);
  float y = 0;
  asm volatile("ldmxcsr %[in]\n\tcvtsi2ssl %[y], %[x]\n\tstmxcsr %[out]"
               : [x] "+x"(y), [out] "=m"(after)
               : [y] "r"(x), [in] "m"(before));
  restore(rounding);
  return {bits_of<float, std::uint32_t>(y), after & kHostInexact ? unsigned{kInexact} : 0u};
}

/// To nearest, between normal singles, without the control word: in double the product is exact, and a sum or
/// quotient rounded twice is the one rounded once. It was exact if going back gives the operand.
bool nearest_single(Operation operation, std::uint64_t a, std::uint64_t b, Result& result) {
  const double x = real_of<float, std::uint32_t>(a), y = real_of<float, std::uint32_t>(b);
  float value = 0;
  bool exact = false;
  if (operation == kMul) {
    value = static_cast<float>(x * y);
    exact = value == x * y;
  } else if (operation == kDiv) {
    value = static_cast<float>(x / y);
    exact = value * y == x;
  } else {
    const double other = operation == kSub ? -y : y, sum = x + other, part = sum - x;
    value = static_cast<float>(sum);
    exact = value == sum && (x - (sum - part)) + (other - part) == 0;
  }
  const std::uint32_t bits = bits_of<float, std::uint32_t>(value);
  result = {bits, exact ? 0u : unsigned{kInexact}};
  return safe_single(bits);
}

/// The same for sums of doubles, by the error that a sum leaves, which is a double itself.
bool nearest_double_sum(Operation operation, std::uint64_t a, std::uint64_t b, Result& result) {
  const double x = real_of<double, std::uint64_t>(a),
               y = real_of<double, std::uint64_t>(operation == kSub ? b ^ std::uint64_t{1} << 63 : b);
  const double sum = x + y, part = sum - x, error = (x - (sum - part)) + (y - part);
  const std::uint64_t bits = bits_of<double, std::uint64_t>(sum);
  result = {bits, error == 0 ? 0u : unsigned{kInexact}};
  return safe_double(bits);
}

bool normal_op(Operation operation, bool wide, std::uint64_t a, std::uint64_t b, Rounding rounding,
               Result& result) {
  if (!wide)
    return rounding == kNearest ? nearest_single(operation, a, b, result)
                                : single_op(operation, a, b, rounding, result);
  if (rounding == kNearest && operation <= kSub) return nearest_double_sum(operation, a, b, result);
  return double_op(operation, a, b, rounding, result);
}

/// One of the operands 0, the other normal or 0 too: exact, but for a division by it and a sum of two zeros.
bool with_zero(Operation operation, std::uint64_t a, std::uint64_t b, std::uint64_t sign, Result& result) {
  const bool a_zero = (a & (sign - 1)) == 0, b_zero = (b & (sign - 1)) == 0;
  switch (operation) {
    case kMul:
      result = {(a ^ b) & sign, 0};
      return true;
    case kDiv:
      result = {(a ^ b) & sign, 0};
      return !b_zero;
    default:
      result = {a_zero ? (operation == kSub ? b ^ sign : b) : a, 0};
      return !(a_zero && b_zero);
  }
}

/// 2: normal, 1: zero, 0: anything else.
int kind_double(std::uint64_t bits) { return normal_double(bits) ? 2 : bits << 1 == 0; }
int kind_single(std::uint64_t bits) { return normal_single(bits) ? 2 : (bits & 0x7FFFFFFF) == 0; }

}  // namespace

Result compute(Operation operation, Format format, std::uint64_t a, std::uint64_t b, Rounding rounding) {
  Result result;
  bool done = false;
  if (operation <= kDiv && format != kWord) {
    const bool wide = format == kDouble;
    const int kinds = wide ? kind_double(a) * kind_double(b) : kind_single(a) * kind_single(b);
    if (kinds == 4)
      done = normal_op(operation, wide, a, b, rounding, result);
    else if (kinds != 0)
      done = with_zero(operation, a, b, wide ? std::uint64_t{1} << 63 : std::uint64_t{1} << 31, result);
  } else if (operation == kCvtD && format == kSingle) {
    done = normal_single(a);
    if (done) result = {bits_of<double, std::uint64_t>(real_of<float, std::uint32_t>(a)), 0};
  } else if (operation == kCvtD && format == kWord) {
    done = true;
    result = {bits_of<double, std::uint64_t>(static_cast<std::int32_t>(a)), 0};
  } else if (operation == kCvtS && format == kWord) {
    return word_to_single(a, rounding);
  } else if (operation == kCvtS && format == kDouble) {
    done = normal_double(a) && double_to_single(a, rounding, result);
  } else if (operation == kCvtW && format != kWord) {
    const bool normal = format == kDouble ? normal_double(a) : normal_single(a);
    if (format == kSingle && normal) a = bits_of<double, std::uint64_t>(real_of<float, std::uint32_t>(a));
    done = normal && double_to_word(a, rounding, result);
    if (normal && !done && format == kSingle) return soft_compute(operation, kDouble, a, b, rounding);
  }
  return done ? result : soft_compute(operation, format, a, b, rounding);
}

#undef DENDRO_HOST_OP

#else

Result compute(Operation operation, Format format, std::uint64_t a, std::uint64_t b, Rounding rounding) {
  return soft_compute(operation, format, a, b, rounding);
}

#endif

}  // namespace dendro::r3010
