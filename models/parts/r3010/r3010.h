#pragma once

#include <cstdint>

/// The R3010 floating-point unit without time. Data sheet: README.md.
namespace dendro::r3010 {

/// Control register 31 [GEN; MIPS I].
constexpr std::uint32_t kCondition = 1u << 23;
constexpr unsigned kCauseShift = 12, kEnableShift = 7, kFlagShift = 2;
constexpr std::uint32_t kControlWritable = 0x0083FFFF;
constexpr std::uint32_t kRevision =
    0x0340;  ///< control register 0: implementation 3, revision 4.0. ASSUMED DEV-111

/// One exception each; shifted by the three above they are cause, enable and flag.
enum Exception : unsigned {
  kInexact = 1,
  kUnderflow = 2,
  kOverflow = 4,
  kDivideByZero = 8,
  kInvalid = 16,
  kUnimplemented = 32
};

enum Rounding : unsigned { kNearest = 0, kZero = 1, kUp = 2, kDown = 3 };

enum Format : unsigned { kSingle = 16, kDouble = 17, kWord = 20 };

/// Functions, bits 5-0 of a word whose format stands in bits 25-21.
enum Operation : unsigned {
  kAdd = 0,
  kSub = 1,
  kMul = 2,
  kDiv = 3,
  kAbs = 5,
  kMov = 6,
  kNeg = 7,
  kCvtS = 32,
  kCvtD = 33,
  kCvtW = 36,
  kCompare = 48,  ///< bits 3-0: invalid if unordered, less, equal, unordered
};

constexpr std::uint32_t fp_word(Format format, unsigned operation, unsigned fd, unsigned fs,
                                unsigned ft = 0) {
  return 17u << 26 | format << 21 | ft << 16 | fs << 11 | fd << 6 | operation;
}

struct State {
  std::uint32_t r[32] = {};   ///< a double's low word is in the even register
  std::uint32_t control = 0;  ///< register 31

  bool condition() const { return control & kCondition; }
  /// An exception of the cause field is enabled (Unimplemented always is): the interrupt line is pulled.
  bool interrupting() const {
    return (control >> kCauseShift & (control >> kEnableShift | kUnimplemented)) & 63;
  }
};

std::uint32_t read_control(const State& state, unsigned reg);

/// True if the R3010 has the operation in that format.
bool exists(unsigned format, unsigned operation);

enum class Outcome { kDone, kInterrupt };

/// Executes an arithmetic word (format and operation valid or not). With an enabled exception neither the
/// destination nor the flags change; only the cause field does.
Outcome execute(State& state, std::uint32_t word);

/// A result in the format's low bits, and the exceptions that happened.
struct Result {
  std::uint64_t bits = 0;
  unsigned exceptions = 0;
};
inline bool operator==(const Result& a, const Result& b) {
  return a.bits == b.bits && a.exceptions == b.exceptions;
}

/// The operation by integer arithmetic alone; `b` counts for kAdd to kDiv. With kUnimplemented the bits mean
/// nothing.
Result soft_compute(Operation operation, Format format, std::uint64_t a, std::uint64_t b, Rounding rounding);

/// The same by the host's floating point where it can do it exactly, else by soft_compute().
Result compute(Operation operation, Format format, std::uint64_t a, std::uint64_t b, Rounding rounding);

/// c.cond: `condition` is bits 3-0 of the word. bits is 0 or 1.
Result soft_compare(unsigned condition, Format format, std::uint64_t a, std::uint64_t b);

}  // namespace dendro::r3010
