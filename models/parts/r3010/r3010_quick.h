#pragma once

#include <cfloat>
#include <cstring>

#include "models/parts/r3010/r3010.h"

namespace dendro::r3010 {

/// Arithmetic words between normal numbers by the host's floating point, for programs that have set it to nearest
/// with no exception enabled and that have met an inexact result already. Then all that such a word can leave beside
/// its result is Inexact in the cause field, which the next word overwrites: it is worked out when somebody looks.
/// What is not so simple is refused, before anything has changed.
class Quick {
 public:
  /// Nothing but settle() and the functions below may come between suits() and the last of them.
  static bool suits(const State& s) {
    return kHostSuits && (s.control & (31u << kEnableShift | 3u | kInexact << kFlagShift)) == kInexact << kFlagShift;
  }
  /// The cause field is as the last word left it.
  void settle(State& s) {
    if (last_ == 0) return;
    const auto format = static_cast<Format>(last_ >> 21 & 31);
    const Result result = compute(static_cast<Operation>(last_ & 63), format, a_, b_, kNearest);
    s.control = (s.control & ~kCause) | result.exceptions << kCauseShift;
    last_ = 0;
  }

  // True: done. The registers of a double are those of its low word. `word` is the whole word.
  template <Operation kOperation>
  bool single(State& s, unsigned fd, unsigned fs, unsigned ft, std::uint32_t word) {
    const std::uint32_t a = s.r[fs], b = s.r[ft];
    const std::uint32_t bits = bits_of<std::uint32_t>(operate<kOperation>(real<float>(a), real<float>(b)));
    if (!(big_single(a) & big_single(b) & safe_single(bits))) return false;
    s.r[fd] = bits;
    return note(word, a, b);
  }
  template <Operation kOperation>
  bool twice(State& s, unsigned fd, unsigned fs, unsigned ft, std::uint32_t word) {
    const std::uint64_t a = pair(s, fs), b = pair(s, ft);
    const std::uint64_t bits = bits_of<std::uint64_t>(operate<kOperation>(real<double>(a), real<double>(b)));
    if (!(big_double(a) & big_double(b) & safe_double(bits))) return false;
    put(s, fd, bits);
    return note(word, a, b);
  }
  bool single_to_double(State& s, unsigned fd, unsigned fs, std::uint32_t word) {
    const std::uint32_t a = s.r[fs];
    if (!(big_single(a) & ((a & 0x7FFFFFFF) < 0x7F800000))) return false;
    put(s, fd, bits_of<std::uint64_t>(static_cast<double>(real<float>(a))));
    return note(word, a, 0);
  }
  bool double_to_single(State& s, unsigned fd, unsigned fs, std::uint32_t word) {
    const std::uint64_t a = pair(s, fs);
    const std::uint32_t bits = bits_of<std::uint32_t>(static_cast<float>(real<double>(a)));
    if (!safe_single(bits)) return false;
    s.r[fd] = bits;
    return note(word, a, 0);
  }
  bool word_to_single(State& s, unsigned fd, unsigned fs, std::uint32_t word) {
    const std::uint32_t a = s.r[fs];
    s.r[fd] = bits_of<std::uint32_t>(static_cast<float>(static_cast<std::int32_t>(a)));
    return note(word, a, 0);
  }
  bool word_to_double(State& s, unsigned fd, unsigned fs, std::uint32_t word) {
    const std::uint32_t a = s.r[fs];
    put(s, fd, bits_of<std::uint64_t>(static_cast<double>(static_cast<std::int32_t>(a))));
    return note(word, a, 0);
  }
  /// c.cond without a NaN.
  template <class Real>
  bool compare(State& s, unsigned fs, unsigned ft, std::uint32_t word) {
    Real x, y;
    if constexpr (sizeof(Real) == 4) {
      x = real<float>(s.r[fs]);
      y = real<float>(s.r[ft]);
    } else {
      x = real<double>(pair(s, fs));
      y = real<double>(pair(s, ft));
    }
    const bool less = x < y, equal = x == y;
    if (!(less | equal | (x > y))) return false;  // a NaN
    const std::uint32_t holds = ((word >> 2 & less) | (word >> 1 & equal)) & 1;
    s.control = (s.control & ~(kCause | kCondition)) | holds << 23;
    last_ = 0;
    return true;
  }
  /// neg, which flips the sign, or abs, which clears it.
  bool sign_single(State& s, unsigned fd, unsigned fs, bool flip) {
    const std::uint32_t a = s.r[fs];
    if ((a & 0x7FFFFFFF) > 0x7F800000) return false;
    s.r[fd] = flip ? a ^ 0x80000000 : a & 0x7FFFFFFF;
    return no_cause(s);
  }
  bool sign_double(State& s, unsigned fd, unsigned fs, bool flip) {
    const std::uint64_t a = pair(s, fs), sign = std::uint64_t{1} << 63;
    if ((a & ~sign) > std::uint64_t{0x7FF} << 52) return false;
    put(s, fd, flip ? a ^ sign : a & ~sign);
    return no_cause(s);
  }

 private:
  static constexpr std::uint32_t kCause = 63u << kCauseShift;
#if defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD == 0
  static constexpr bool kHostSuits = true;
#else
  static constexpr bool kHostSuits = false;
#endif

  template <class Real, class Bits>
  static Real real(Bits bits) {
    Real value;
    static_assert(sizeof value == sizeof bits);
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  template <class Bits, class Real>
  static Bits bits_of(Real value) {
    Bits bits;
    static_assert(sizeof value == sizeof bits);
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
  }
  template <Operation kOperation, class Real>
  static Real operate(Real x, Real y) {
    if constexpr (kOperation == kAdd) return x + y;
    if constexpr (kOperation == kSub) return x - y;
    if constexpr (kOperation == kMul) return x * y;
    return x / y;
  }
  /// Neither zero nor denormal; what is not finite shows in the result.
  static bool big_single(std::uint32_t bits) { return (bits & 0x7F800000) != 0; }
  static bool big_double(std::uint64_t bits) { return (bits & std::uint64_t{0x7FF} << 52) != 0; }
  /// Finite and above the smallest normal number: neither tiny before rounding nor too large after it.
  static bool safe_single(std::uint32_t bits) { return (bits & 0x7FFFFFFF) - 0x00800001 < 0x7F800000 - 0x00800001; }
  static bool safe_double(std::uint64_t bits) {
    constexpr std::uint64_t lowest = (std::uint64_t{1} << 52) + 1, infinity = std::uint64_t{0x7FF} << 52;
    return (bits & ~(std::uint64_t{1} << 63)) - lowest < infinity - lowest;
  }
  static std::uint64_t pair(const State& s, unsigned reg) { return std::uint64_t{s.r[reg + 1]} << 32 | s.r[reg]; }
  static void put(State& s, unsigned reg, std::uint64_t bits) {
    s.r[reg] = static_cast<std::uint32_t>(bits);
    s.r[reg + 1] = static_cast<std::uint32_t>(bits >> 32);
  }
  bool note(std::uint32_t word, std::uint64_t a, std::uint64_t b) {
    last_ = word;
    a_ = a;
    b_ = b;
    return true;
  }
  bool no_cause(State& s) {
    s.control &= ~kCause;
    last_ = 0;
    return true;
  }

  std::uint32_t last_ = 0;  ///< the word whose cause field is not worked out; 0: none
  std::uint64_t a_ = 0, b_ = 0;
};

}  // namespace dendro::r3010
