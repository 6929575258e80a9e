#include "models/parts/r3010/r3010.h"

namespace dendro::r3010 {
namespace {

using Wide = unsigned __int128;

struct Layout {
  unsigned fraction_bits, exponent_bits;
  int bias;
  constexpr unsigned sign_bit() const { return fraction_bits + exponent_bits; }
  constexpr std::uint64_t exponent_mask() const { return (std::uint64_t{1} << exponent_bits) - 1; }
  constexpr std::uint64_t fraction_mask() const { return (std::uint64_t{1} << fraction_bits) - 1; }
  constexpr std::uint64_t sign(bool negative) const { return std::uint64_t{negative} << sign_bit(); }
  constexpr std::uint64_t infinity(bool negative) const {
    return sign(negative) | exponent_mask() << fraction_bits;
  }
  constexpr std::uint64_t largest(bool negative) const { return infinity(negative) - 1; }
  /// A quiet NaN has the fraction's top bit clear [GEN; MIPS I]. ASSUMED DEV-116
  constexpr std::uint64_t default_nan() const {
    return (exponent_mask() << fraction_bits) | (fraction_mask() >> 1);
  }
};
constexpr Layout kSingleLayout = {23, 8, 127}, kDoubleLayout = {52, 11, 1023};

const Layout& layout_of(Format format) { return format == kDouble ? kDoubleLayout : kSingleLayout; }

enum class Kind { kZero, kDenormal, kNormal, kInfinity, kQuietNan, kSignalingNan };

/// A number: significand's top bit is bit 63 and worth 2^exponent.
struct Number {
  Kind kind = Kind::kZero;
  bool negative = false;
  int exponent = 0;
  std::uint64_t significand = 0;
};

Number unpack(const Layout& l, std::uint64_t bits) {
  Number n;
  n.negative = bits >> l.sign_bit() & 1;
  const std::uint64_t exponent = bits >> l.fraction_bits & l.exponent_mask(),
                      fraction = bits & l.fraction_mask();
  if (exponent == l.exponent_mask()) {
    const bool top = fraction >> (l.fraction_bits - 1);
    n.kind = fraction == 0 ? Kind::kInfinity : top ? Kind::kSignalingNan : Kind::kQuietNan;
  } else if (exponent == 0) {
    n.kind = fraction == 0 ? Kind::kZero : Kind::kDenormal;
  } else {
    n.kind = Kind::kNormal;
    n.exponent = static_cast<int>(exponent) - l.bias;
    n.significand = (fraction | std::uint64_t{1} << l.fraction_bits) << (63 - l.fraction_bits);
  }
  return n;
}

bool is_nan(const Number& n) { return n.kind >= Kind::kQuietNan; }

bool rounds_up(Rounding rounding, bool negative, bool odd, bool half, bool rest) {
  switch (rounding) {
    case kNearest:
      return half && (rest || odd);
    case kZero:
      return false;
    case kUp:
      return !negative && (half || rest);
    default:
      return negative && (half || rest);
  }
}

Result overflow(const Layout& l, bool negative, Rounding rounding) {
  const bool infinite = rounding == kNearest || rounding == (negative ? kDown : kUp);
  return {infinite ? l.infinity(negative) : l.largest(negative), kOverflow | kInexact};
}

/// `significand` is normalised: bit 127 set, worth 2^exponent; `sticky` stands for anything below.
Result round(const Layout& l, bool negative, int exponent, Wide significand, bool sticky, Rounding rounding) {
  if (exponent < 1 - l.bias) return {0, kUnimplemented};
  const unsigned drop = 127 - l.fraction_bits;
  auto kept = static_cast<std::uint64_t>(significand >> drop);
  const bool half = static_cast<bool>(significand >> (drop - 1) & 1);
  const bool rest = sticky || (significand & ((Wide{1} << (drop - 1)) - 1)) != 0;
  if (rounds_up(rounding, negative, kept & 1, half, rest) && ++kept >> (l.fraction_bits + 1)) {
    kept >>= 1;
    ++exponent;
  }
  if (exponent > l.bias) return overflow(l, negative, rounding);
  return {l.sign(negative) | static_cast<std::uint64_t>(exponent + l.bias) << l.fraction_bits |
              (kept & l.fraction_mask()),
          half || rest ? kInexact : 0u};
}

Result invalid(const Layout& l) { return {l.default_nan(), kInvalid}; }

/// A signaling NaN is invalid; of quiet ones the first is the result. ASSUMED DEV-116
Result nan_result(const Layout& l, const Number& a, std::uint64_t a_bits, const Number& b,
                  std::uint64_t b_bits) {
  if (a.kind == Kind::kSignalingNan || b.kind == Kind::kSignalingNan) return invalid(l);
  return {is_nan(a) ? a_bits : b_bits, 0};
}

Result zero(const Layout& l, bool negative) { return {l.sign(negative), 0}; }

Result add(const Layout& l, Number a, Number b, Rounding rounding) {
  if (a.kind == Kind::kInfinity || b.kind == Kind::kInfinity) {
    if (a.kind == b.kind && a.negative != b.negative) return invalid(l);
    return {l.infinity(a.kind == Kind::kInfinity ? a.negative : b.negative), 0};
  }
  if (a.kind == Kind::kZero && b.kind == Kind::kZero)
    return zero(l, a.negative == b.negative ? a.negative : rounding == kDown);
  if (a.kind == Kind::kZero || (b.kind != Kind::kZero && b.exponent > a.exponent)) {
    const Number swap = a;
    a = b;
    b = swap;
  }
  Wide x = Wide{a.significand} << 62, y = b.kind == Kind::kZero ? Wide{0} : Wide{b.significand} << 62;
  const unsigned distance = y == 0 ? 0 : static_cast<unsigned>(a.exponent - b.exponent);
  bool sticky = false;
  if (distance > 125) {  // far below the last bit kept
    sticky = y != 0;
    y = 0;
  } else {
    sticky = (y & ((Wide{1} << distance) - 1)) != 0;
    y >>= distance;
  }
  bool negative = a.negative;
  if (a.negative == b.negative) {
    x += y;
  } else {
    // What was cut off makes the difference a little smaller than the whole bits say.
    if (sticky) y += 1;
    if (x == y && !sticky) return zero(l, rounding == kDown);
    if (x < y) {
      negative = !negative;
      x = y - x;
    } else {
      x -= y;
    }
  }
  int exponent = a.exponent + 2;
  while (!(x >> 127)) {
    x <<= 1;
    --exponent;
  }
  return round(l, negative, exponent, x, sticky, rounding);
}

Result multiply(const Layout& l, const Number& a, const Number& b, Rounding rounding) {
  const bool negative = a.negative != b.negative;
  if (a.kind == Kind::kInfinity || b.kind == Kind::kInfinity)
    return a.kind == Kind::kZero || b.kind == Kind::kZero ? invalid(l) : Result{l.infinity(negative), 0};
  if (a.kind == Kind::kZero || b.kind == Kind::kZero) return zero(l, negative);
  Wide product = Wide{a.significand} * b.significand;
  int exponent = a.exponent + b.exponent + 1;
  if (!(product >> 127)) {
    product <<= 1;
    --exponent;
  }
  return round(l, negative, exponent, product, false, rounding);
}

Result divide(const Layout& l, const Number& a, const Number& b, Rounding rounding) {
  const bool negative = a.negative != b.negative;
  if (a.kind == Kind::kInfinity)
    return b.kind == Kind::kInfinity ? invalid(l) : Result{l.infinity(negative), 0};
  if (b.kind == Kind::kInfinity) return zero(l, negative);
  if (b.kind == Kind::kZero)
    return a.kind == Kind::kZero ? invalid(l) : Result{l.infinity(negative), kDivideByZero};
  if (a.kind == Kind::kZero) return zero(l, negative);
  const Wide dividend = Wide{a.significand} << 63;  // the quotient has its top bit at 63 or 62
  Wide quotient = dividend / b.significand;
  const bool sticky = dividend % b.significand != 0;
  quotient <<= 64;
  int exponent = a.exponent - b.exponent;
  if (!(quotient >> 127)) {
    quotient <<= 1;
    --exponent;
  }
  return round(l, negative, exponent, quotient, sticky, rounding);
}

Result to_word(const Layout& l, const Number& n, Rounding rounding) {
  (void)l;
  const Result wrong = {0x7FFFFFFF, kInvalid};
  if (is_nan(n) || n.kind == Kind::kInfinity) return wrong;
  if (n.kind == Kind::kZero) return {};
  if (n.exponent > 31) return wrong;
  std::uint64_t whole = 0;
  bool half = false, rest = true;
  if (n.exponent >= 0) {
    const unsigned drop = static_cast<unsigned>(63 - n.exponent);
    whole = n.significand >> drop;
    half = n.significand >> (drop - 1) & 1;
    rest = (n.significand & ((std::uint64_t{1} << (drop - 1)) - 1)) != 0;
  } else if (n.exponent == -1) {
    half = true;
    rest = n.significand << 1 != 0;
  }
  if (rounds_up(rounding, n.negative, whole & 1, half, rest)) ++whole;
  if (whole > (n.negative ? 0x80000000u : 0x7FFFFFFFu)) return wrong;
  return {static_cast<std::uint32_t>(n.negative ? -whole : whole), half || rest ? kInexact : 0u};
}

Result from_word(const Layout& l, std::uint32_t word, Rounding rounding) {
  if (word == 0) return {};
  const bool negative = word >> 31;
  Wide significand = Wide{negative ? 0u - word : word} << 96;
  int exponent = 31;
  while (!(significand >> 127)) {
    significand <<= 1;
    --exponent;
  }
  return round(l, negative, exponent, significand, false, rounding);
}

Result convert(const Layout& to, const Number& n, Rounding rounding) {
  if (n.kind == Kind::kSignalingNan) return invalid(to);
  if (n.kind == Kind::kQuietNan) return {to.default_nan(), 0};
  if (n.kind == Kind::kInfinity) return {to.infinity(n.negative), 0};
  if (n.kind == Kind::kZero) return zero(to, n.negative);
  return round(to, n.negative, n.exponent, Wide{n.significand} << 64, false, rounding);
}

}  // namespace

Result soft_compute(Operation operation, Format format, std::uint64_t a, std::uint64_t b, Rounding rounding) {
  const Layout& l = layout_of(format);
  if (format == kWord) {
    if (operation != kCvtS && operation != kCvtD) return {0, kUnimplemented};
    return from_word(operation == kCvtD ? kDoubleLayout : kSingleLayout, static_cast<std::uint32_t>(a),
                     rounding);
  }
  if (operation == kMov) return {a, 0};
  const Number x = unpack(l, a);
  Number y;
  if (operation <= kDiv) y = unpack(l, b);
  if (operation == kAbs || operation == kNeg) {
    if (x.kind == Kind::kSignalingNan) return invalid(l);
    if (x.kind == Kind::kQuietNan) return {a, 0};
    return {operation == kNeg ? a ^ l.sign(true) : a & ~l.sign(true), 0};
  }
  // NaN operands settle the result before the exponents are looked at.
  if (operation <= kDiv && (is_nan(x) || is_nan(y))) return nan_result(l, x, a, y, b);
  if (x.kind == Kind::kDenormal || y.kind == Kind::kDenormal) return {0, kUnimplemented};
  switch (operation) {
    case kSub:
      y.negative = !y.negative;
      [[fallthrough]];
    case kAdd:
      return add(l, x, y, rounding);
    case kMul:
      return multiply(l, x, y, rounding);
    case kDiv:
      return divide(l, x, y, rounding);
    case kCvtS:
      return format == kDouble ? convert(kSingleLayout, x, rounding) : Result{0, kUnimplemented};
    case kCvtD:
      return format == kSingle ? convert(kDoubleLayout, x, rounding) : Result{0, kUnimplemented};
    case kCvtW:
      return to_word(l, x, rounding);
    default:
      return {0, kUnimplemented};
  }
}

Result soft_compare(unsigned condition, Format format, std::uint64_t a, std::uint64_t b) {
  const Layout& l = layout_of(format);
  const Number x = unpack(l, a), y = unpack(l, b);
  if (is_nan(x) || is_nan(y)) {
    const bool signals = (condition & 8) || x.kind == Kind::kSignalingNan || y.kind == Kind::kSignalingNan;
    return {condition & 1, signals ? unsigned{kInvalid} : 0u};
  }
  const bool both_zero = x.kind == Kind::kZero && y.kind == Kind::kZero;
  const std::uint64_t magnitude = ~l.sign(true);
  const bool equal = both_zero || a == b;
  bool less = false;
  if (!equal)
    less = x.negative != y.negative ? x.negative : ((a & magnitude) < (b & magnitude)) != x.negative;
  return {static_cast<std::uint64_t>(((condition & 4) && less) || ((condition & 2) && equal)), 0};
}

}  // namespace dendro::r3010
