#pragma once

#include <cstdint>

#include "models/parts/am2910/am2910_isa.h"
#include "sim/base/bits.h"

/// The 64-bit control word of the BPS32. The real layout is unknown: this one is ASSUMED DEV-001. Field semantics are in
/// README.md.
namespace dendro::bps32 {

constexpr int kIsaVersion = 1;
constexpr unsigned kPageWords = 4096;  ///< what a 12-bit microprogram address reaches [FG86 6.1]
constexpr unsigned kRegisters = 16;

struct Field {
  const char* name;
  unsigned low;
  unsigned width;
};

constexpr Field kSeq{"seq", 60, 4};
constexpr Field kCond{"cond", 56, 4};
constexpr Field kPol{"pol", 55, 1};     ///< 1: branch when the condition is false
constexpr Field kImm{"imm", 43, 12};    ///< branch address, immediate or scratch address
constexpr Field kDest{"dest", 39, 4};   ///< I8-I5
constexpr Field kFunc{"func", 35, 4};   ///< I4-I1
constexpr Field kI0{"i0", 34, 1};       ///< 1: S is Q
constexpr Field kA{"a", 30, 4};
constexpr Field kB{"b", 26, 4};
constexpr Field kEa{"ea", 25, 1};       ///< 1: R is the D bus
constexpr Field kOeb{"oeb", 24, 1};     ///< 1: S is the D bus (when I0 = 0)
constexpr Field kLane{"lane", 22, 2};   ///< D bus rotated right by 8 x lane bits
constexpr Field kCarry{"carry", 20, 2};
constexpr Field kFill{"fill", 18, 2};
constexpr Field kDsrc{"dsrc", 14, 4};
constexpr Field kYdst{"ydst", 10, 4};
constexpr Field kBusOp{"busop", 8, 2};
constexpr Field kBusFn{"busfn", 4, 4};
constexpr Field kMul{"mul", 2, 2};
constexpr Field kLatch{"latch", 1, 1};  ///< 1: flags are latched at the end of this tick
constexpr Field kHalt{"halt", 0, 1};    ///< 1: stop after this word and interrupt the host

/// All fields, from the top bit down; they tile the 64 bits.
constexpr Field kFields[] = {kSeq, kCond, kPol, kImm, kDest, kFunc, kI0, kA, kB, kEa, kOeb,
                             kLane, kCarry, kFill, kDsrc, kYdst, kBusOp, kBusFn, kMul, kLatch, kHalt};

constexpr unsigned get(std::uint64_t word, const Field& f) {
  return static_cast<unsigned>(base::field(word, f.low, f.width));
}
constexpr std::uint64_t put(std::uint64_t word, const Field& f, unsigned value) {
  return base::with_field(word, f.low, f.width, value);
}

/// Conditions, all of the state before the word executes.
enum Cond : std::uint8_t {
  kAlways, kZero, kNegative, kCarrySet, kOverflow,
  kLess,          ///< N xor V
  kLessEqual,     ///< Z or (N xor V)
  kQ0,            ///< bit 0 of Q
  kCounterZero,   ///< R of the sequencer is 0
  kBusBusy,       ///< an access is in flight
  kDataReady,     ///< no read is under way
  kProductReady,  ///< no multiplication is under way
  kVerticalBlank,
  kFieldFlag,     ///< 0 in the first field of a frame, 1 in the second
  kHostFlag,      ///< bit 4 of the status register, set by the host
  kLowerEqual,    ///< Z or not C: unsigned lower or same after a subtraction
};
constexpr const char* kCondNames[16] = {"always", "zero", "negative", "carry", "overflow", "less",
                                        "less_equal", "q0", "counter_zero", "bus_busy", "data_ready",
                                        "product_ready", "vertical_blank", "field", "host_flag", "lower_equal"};

enum CarryIn : std::uint8_t { kCarryZero, kCarryOne, kCarryLatched, kCarryLatchedNot };

enum Fill : std::uint8_t { kFillZero, kFillSign, kFillRotate, kFillCarry };

/// What drives the D bus.
enum Dsrc : std::uint8_t {
  kDNone,      ///< 0
  kDBus,       ///< the read data register; stalls until the read is complete
  kDSpad,      ///< scratch[imm]
  kDSpadAr,    ///< scratch[SAR]
  kDSpadArInc, ///< scratch[SAR], then SAR + 1
  kDProduct,   ///< the 32-bit product
  kDProductHi, ///< its high half, sign extended
  kDProductLo, ///< its low half, zero extended
  kDImm,       ///< imm, sign extended from 12 bits
  kDCounter,   ///< R of the sequencer
  kDStatus,    ///< status register
  kDBusAddress,///< the 24-bit bus address register
  kDSar,       ///< scratch address register
};
constexpr const char* kDsrcNames[16] = {"none", "bus", "spad", "spad_ar", "spad_ar_inc", "product", "product_hi",
                                        "product_lo", "imm", "counter", "status", "bus_address", "sar",
                                        nullptr, nullptr, nullptr};

/// What takes the Y bus.
enum Ydst : std::uint8_t {
  kYNone,
  kYBusX,        ///< bits 9-0 of the bus address register
  kYBusY,        ///< bits 23-10 of it, from Y[13:0]
  kYBusAddress,  ///< all 24
  kYBusData,     ///< the write data register
  kYSpad,        ///< scratch[imm]
  kYSpadAr,      ///< scratch[SAR]
  kYSpadArInc,   ///< scratch[SAR], then SAR + 1
  kYSar,         ///< scratch address register, 13 bits
  kYMulX,        ///< multiplier X, from Y[15:0]
  kYMulXHi,      ///< multiplier X, from Y[31:16]
  kYMulY,        ///< multiplier Y, from Y[15:0]
  kYStatus,      ///< flags from Y[3:0] = V C N Z; overrides the latch bit
  kYSeq,         ///< the sequencer's D input is Y[11:0] instead of imm
};
constexpr const char* kYdstNames[16] = {"none", "bus_x", "bus_y", "bus_address", "bus_data", "spad", "spad_ar",
                                        "spad_ar_inc", "sar", "mul_x", "mul_x_hi", "mul_y", "status", "seq",
                                        nullptr, nullptr};

enum BusOp : std::uint8_t { kBusIdle, kBusRead, kBusWrite, kBusReserved };

/// Bus function codes of image memory [NYU-H].
enum BusFunction : std::uint8_t {
  kFnWord = 0, kFnLores = 2, kFnHires = 3, kFnMaskWord = 010, kFnMaskLores = 012, kFnMaskHires = 013,
};

enum Mul : std::uint8_t { kMulNone, kMulSigned, kMulUnsigned, kMulReserved };

/// Status register bits.
enum Status : std::uint8_t { kStatusZ = 1, kStatusN = 2, kStatusC = 4, kStatusV = 8, kStatusHost = 16 };

/// ALU functions, I4-I1 [29203V].
enum Func : std::uint8_t {
  kSpecial, kSMinusR, kRMinusS, kRPlusS, kPassS, kNotS, kPassR, kNotR,
  kFZero, kNotRAndS, kXnor, kXor, kAnd, kNor, kNand, kOr,
};

/// ALU destinations, I8-I5 [29203V].
enum Dest : std::uint8_t {
  kAsrRam, kLsrRam, kAsrBoth, kLsrBoth, kRam, kQRight, kQ, kRamQ,
  kAslRam, kLslRam, kAslBoth, kLslBoth, kYOnly, kQLeft, kSignExtend, kRamAlso,
};

/// A word that does nothing: CONT, Y only, F = 0.
constexpr std::uint64_t nop() {
  std::uint64_t w = 0;
  w = put(w, kSeq, am2910::kCONT);
  w = put(w, kDest, kYOnly);
  return put(w, kFunc, kFZero);
}

}  // namespace dendro::bps32
