#pragma once

#include <cstdint>

#include "sim/base/bits.h"

/// Micro-program and command formats of the image generation controller of a bit-serial pixel array. The real ones are
/// unknown: these are ASSUMED DEV-070. What the fields do is in README.md.
namespace dendro::igc {

constexpr int kIsaVersion = 1;
constexpr unsigned kStoreWords = 1024;      ///< of the control store
constexpr unsigned kRegisters = 16;         ///< of 8 bits: counts and addresses of fields
constexpr unsigned kMostMemoryBits = 256;   ///< a pixel's address has 8 bits
constexpr unsigned kStreamBits = 64;        ///< of a coefficient behind its leading zeros; then its sign

/// One of these a clock: either the carry or the enable register changes.
enum class Function : std::uint8_t {
  kHold,
  kSetEnable,     ///< E := 1, in every pixel
  kAndCarry,      ///< E := E & C
  kAndNotCarry,   ///< E := E & ~C
  kLoad,          ///< C := x
  kBorrow,        ///< C := borrow of x - y - C
  kCarry,         ///< C := carry of x + y + C
  kEqual,         ///< C := C & (x = y)
  kCount
};

/// What x and y are. kConstant stands in the control store only: the controller sends kZero or kOne.
enum class Operand : std::uint8_t { kZero, kOne, kTree, kConstant, kPortA, kPortB, kData, kCount };

/// The data register.
enum class DataOp : std::uint8_t {
  kHold,
  kClear,
  kTree,    ///< D := t
  kOrTree,  ///< D := D | t
  kPortA,   ///< D := a
  kCount
};

/// What is written, with the old C and D.
enum class Source : std::uint8_t {
  kX,
  kXOrData,      ///< x | D
  kXAndNotData,  ///< x & ~D
  kSum,          ///< x ^ y ^ C
  kTree,         ///< t
  kCount
};

/// How often a loop is run. kNone: the word is not in a loop.
enum class LoopCount : std::uint8_t {
  kNone,
  kFraction,      ///< of the command's header
  kGuard,         ///< of the command's header
  kGuardLessOne,  ///< at least 0
  kGap,           ///< the leading zeros of an expression
  kRegister,      ///< the register with the number in `loop_number`
  kNumber,        ///< `loop_number` itself
  kCount
};

/// A word of the control store, taken apart.
struct MicroWord {
  Function function = Function::kHold;
  Operand x = Operand::kZero, y = Operand::kZero;
  DataOp data = DataOp::kHold;
  Source source = Source::kX;
  bool read_a = false, write_a = false, read_b = false, write_b = false;
  /// The address of a port: register + offset, + the number of the loop's turn when `indexed`.
  std::uint8_t register_a = 0, offset_a = 0, register_b = 0, offset_b = 0;
  bool indexed_a = false, indexed_b = false;
  bool tree = false;  ///< the tree's next bit is used
  LoopCount loop = LoopCount::kNone;  ///< the same in all words of a loop
  std::uint8_t loop_number = 0;       ///< 0..63
  std::uint8_t constant_offset = 0;   ///< 0..63: kConstant is bit i + constant_offset of the command's constant
  bool loop_end = false;              ///< last word of its loop
  bool end = false;                   ///< last word of its program
};

constexpr bool operator==(const MicroWord& p, const MicroWord& q);

namespace detail {
constexpr unsigned kFunctionLow = 0, kXLow = 4, kYLow = 7, kDataLow = 10, kSourceLow = 13, kPortsLow = 16, kAddressALow = 20,
                   kAddressBLow = 33, kTreeLow = 46, kLoopLow = 47, kNumberLow = 50, kOffsetLow = 56, kLoopEndLow = 62, kEndLow = 63;
}

/// Fields from bit 0 up: function 4, x 3, y 3, data 3, source 3, read a, write a, read b, write b, port a (register 4,
/// offset 8, indexed 1), port b the same, tree 1, loop 3, loop number 6,
/// constant offset 6, loop end 1, end 1.
constexpr std::uint64_t pack(const MicroWord& w) {
  using namespace detail;
  const auto bits = [](auto value, unsigned low) { return static_cast<std::uint64_t>(value) << low; };
  return bits(w.function, kFunctionLow) | bits(w.x, kXLow) | bits(w.y, kYLow) | bits(w.data, kDataLow) |
         bits(w.source, kSourceLow) | bits(w.read_a, kPortsLow) | bits(w.write_a, kPortsLow + 1) |
         bits(w.read_b, kPortsLow + 2) | bits(w.write_b, kPortsLow + 3) | bits(w.register_a, kAddressALow) |
         bits(w.offset_a, kAddressALow + 4) | bits(w.indexed_a, kAddressALow + 12) | bits(w.register_b, kAddressBLow) |
         bits(w.offset_b, kAddressBLow + 4) | bits(w.indexed_b, kAddressBLow + 12) | bits(w.tree, kTreeLow) |
         bits(w.loop, kLoopLow) | bits(w.loop_number, kNumberLow) |
         bits(w.constant_offset, kOffsetLow) | bits(w.loop_end, kLoopEndLow) | bits(w.end, kEndLow);
}

/// The inverse of pack(). A field value that has no name does nothing, as if it were 0.
constexpr MicroWord unpack(std::uint64_t word) {
  using namespace detail;
  const auto get = [word](unsigned low, unsigned width) { return static_cast<std::uint8_t>(base::field(word, low, width)); };
  const auto named = [](std::uint8_t value, auto count) {
    return static_cast<decltype(count)>(value < static_cast<std::uint8_t>(count) ? value : 0);
  };
  MicroWord w;
  w.function = named(get(kFunctionLow, 4), Function::kCount);
  w.x = named(get(kXLow, 3), Operand::kCount);
  w.y = named(get(kYLow, 3), Operand::kCount);
  w.data = named(get(kDataLow, 3), DataOp::kCount);
  w.source = named(get(kSourceLow, 3), Source::kCount);
  w.read_a = get(kPortsLow, 1), w.write_a = get(kPortsLow + 1, 1);
  w.read_b = get(kPortsLow + 2, 1), w.write_b = get(kPortsLow + 3, 1);
  w.register_a = get(kAddressALow, 4), w.offset_a = get(kAddressALow + 4, 8), w.indexed_a = get(kAddressALow + 12, 1);
  w.register_b = get(kAddressBLow, 4), w.offset_b = get(kAddressBLow + 4, 8), w.indexed_b = get(kAddressBLow + 12, 1);
  w.tree = get(kTreeLow, 1);
  w.loop = named(get(kLoopLow, 3), LoopCount::kCount);
  w.loop_number = get(kNumberLow, 6);
  w.constant_offset = get(kOffsetLow, 6);
  w.loop_end = get(kLoopEndLow, 1), w.end = get(kEndLow, 1);
  return w;
}

constexpr bool operator==(const MicroWord& p, const MicroWord& q) { return pack(p) == pack(q); }

/// What the array is sent in one clock: the micro-word with its addresses and constant resolved.
struct ArrayWord {
  Function function = Function::kHold;
  Operand x = Operand::kZero, y = Operand::kZero;
  DataOp data = DataOp::kHold;
  Source source = Source::kX;
  bool read_a = false, write_a = false, read_b = false, write_b = false;
  std::uint8_t address_a = 0, address_b = 0;
  bool tree = false;
};

/// The first word of a command. Bits 0-9 entry, 10-15 fraction, 16-21 guard, 22 expression, 23 constant, 24 second
/// word of the constant, 31 register write. Behind it: the expression's A, B, C in single precision, then the constant,
/// its low word first. With bit 31: bits 0-7 value, 8-11 register; nothing behind it. With bit 30, and not 31: a copy; behind it the
/// tile, its column in bits 0-15, its row in bits 16-31.
struct Header {
  bool register_write = false, copy = false;
  unsigned entry = 0, fraction = 0, guard = 0;
  bool expression = false, constant = false, long_constant = false;
  unsigned register_number = 0, value = 0;

  unsigned words() const {
    return register_write ? 1 : copy ? 2 : 1 + (expression ? 3 : 0) + (constant ? 1 : 0) + (long_constant ? 1 : 0);
  }
};

constexpr std::uint32_t pack(const Header& h) {
  if (h.register_write) return 1u << 31 | (h.register_number & 15) << 8 | (h.value & 255);
  if (h.copy) return 1u << 30;
  return (h.entry & 1023) | (h.fraction & 63) << 10 | (h.guard & 63) << 16 | (h.expression ? 1u << 22 : 0) |
         (h.constant ? 1u << 23 : 0) | (h.long_constant ? 1u << 24 : 0);
}

constexpr Header unpack_header(std::uint32_t word) {
  Header h;
  h.register_write = word >> 31, h.copy = word >> 30 == 1;
  h.entry = word & 1023, h.fraction = word >> 10 & 63, h.guard = word >> 16 & 63;
  h.expression = word >> 22 & 1, h.constant = word >> 23 & 1, h.long_constant = word >> 24 & 1;
  h.register_number = word >> 8 & 15, h.value = word & 255;
  return h;
}

/// A command as the translator hands it to the controller.
struct Command {
  Header header;
  std::int64_t a = 0, b = 0, c = 0;  ///< the expression's streams: two's complement, units of 2^-fraction
  unsigned tile_x = 0, tile_y = 0;   ///< of a copy
  std::uint64_t constant = 0;        ///< its low word is the one of `constant`, its high word that of `long_constant`
};

}  // namespace dendro::igc
