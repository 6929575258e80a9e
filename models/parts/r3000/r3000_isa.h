#pragma once

#include <cstdint>

/// Encodings of the R3000A: MIPS I, words as the program counter finds them. [GEN; MIPS I]
namespace dendro::r3000 {

constexpr unsigned rs_of(std::uint32_t w) { return w >> 21 & 31; }
constexpr unsigned rt_of(std::uint32_t w) { return w >> 16 & 31; }
constexpr unsigned rd_of(std::uint32_t w) { return w >> 11 & 31; }
constexpr unsigned sa_of(std::uint32_t w) { return w >> 6 & 31; }
constexpr std::uint32_t signed_immediate(std::uint32_t w) {
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(static_cast<std::int16_t>(w & 0xFFFF)));
}

/// Major opcodes, bits 31-26. 20-31, 39, 45 and 47 do not exist in MIPS I.
enum Major : std::uint32_t {
  kSpecial = 0,
  kRegimm = 1,
  kMajorJ = 2,
  kMajorJal = 3,
  kMajorBeq = 4,
  kMajorBne = 5,
  kMajorBlez = 6,
  kMajorBgtz = 7,
  kMajorAddi = 8,
  kMajorAddiu = 9,
  kMajorSlti = 10,
  kMajorSltiu = 11,
  kMajorAndi = 12,
  kMajorOri = 13,
  kMajorXori = 14,
  kMajorLui = 15,
  kCop0 = 16,
  kCop1 = 17,
  kCop2 = 18,
  kCop3 = 19,
  kMajorLb = 32,
  kMajorLh = 33,
  kMajorLwl = 34,
  kMajorLw = 35,
  kMajorLbu = 36,
  kMajorLhu = 37,
  kMajorLwr = 38,
  kMajorSb = 40,
  kMajorSh = 41,
  kMajorSwl = 42,
  kMajorSw = 43,
  kMajorSwr = 46,
  kMajorLwc0 = 48,
  kMajorLwc1 = 49,
  kMajorLwc3 = 51,
  kMajorSwc0 = 56,
  kMajorSwc1 = 57,
  kMajorSwc3 = 59,
};

/// Functions of kSpecial, bits 5-0.
enum Function : std::uint32_t {
  kFnSll = 0,
  kFnSrl = 2,
  kFnSra = 3,
  kFnSllv = 4,
  kFnSrlv = 6,
  kFnSrav = 7,
  kFnJr = 8,
  kFnJalr = 9,
  kFnSyscall = 12,
  kFnBreak = 13,
  kFnMfhi = 16,
  kFnMthi = 17,
  kFnMflo = 18,
  kFnMtlo = 19,
  kFnMult = 24,
  kFnMultu = 25,
  kFnDiv = 26,
  kFnDivu = 27,
  kFnAdd = 32,
  kFnAddu = 33,
  kFnSub = 34,
  kFnSubu = 35,
  kFnAnd = 36,
  kFnOr = 37,
  kFnXor = 38,
  kFnNor = 39,
  kFnSlt = 42,
  kFnSltu = 43,
};

/// Bits 25-21 of a coprocessor's words below kCopOperation.
enum CopMove : std::uint32_t { kMfc = 0, kCfc = 2, kMtc = 4, kCtc = 6, kBc = 8, kCopOperation = 16 };

/// Coprocessor 0's operations, bits 5-0.
enum Cp0Operation : std::uint32_t { kFnTlbr = 1, kFnTlbwi = 2, kFnTlbwr = 6, kFnTlbp = 8, kFnRfe = 16 };

/// Registers of coprocessor 0 that exist; the others read 0.
enum Cp0Register : unsigned {
  kIndex = 0,
  kRandom = 1,
  kEntryLo = 2,
  kContext = 4,
  kBadVAddr = 8,
  kEntryHi = 10,
  kStatus = 12,
  kCause = 13,
  kEpc = 14,
  kPrId = 15,
};

constexpr std::uint32_t kStatusIec = 1u << 0, kStatusKuc = 1u << 1, kStatusStack = 0x3F, kStatusIm = 0xFF00,
                        kStatusIsc = 1u << 16, kStatusSwc = 1u << 17, kStatusTs = 1u << 21,
                        kStatusBev = 1u << 22, kStatusCu0 = 1u << 28, kStatusCu1 = 1u << 29;
/// Bits that mtc0 writes; TS is read only.
constexpr std::uint32_t kStatusWritable = 0xF0000000 | kStatusBev | 0x001F0000 | kStatusIm | kStatusStack;
constexpr std::uint32_t kCauseSoftware = 0x300;  ///< the two interrupt bits that mtc0 writes
constexpr unsigned kCauseIpShift = 8;            ///< interrupt line n of the six is bit 10 + n
constexpr std::uint32_t kCauseBd = 1u << 31;

enum ExceptionCode : unsigned {
  kInt = 0,
  kMod = 1,
  kTlbl = 2,
  kTlbs = 3,
  kAdel = 4,
  kAdes = 5,
  kIbe = 6,
  kDbe = 7,
  kSys = 8,
  kBp = 9,
  kRi = 10,
  kCpu = 11,
  kOv = 12,
};
/// "AdEL" and so on.
const char* exception_name(unsigned code);

/// EntryLo and EntryHi.
constexpr std::uint32_t kPageMask = 0xFFFFF000, kLoUncached = 1u << 11, kLoDirty = 1u << 10,
                        kLoValid = 1u << 9, kLoGlobal = 1u << 8, kHiAsid = 0xFC0;
constexpr unsigned kTlbEntries = 64, kTlbWired = 8;

constexpr std::uint32_t kKuseg = 0, kKseg0 = 0x80000000, kKseg1 = 0xA0000000, kKseg2 = 0xC0000000;
constexpr std::uint32_t kResetVector = 0xBFC00000, kUtlbVector = 0x80000000, kGeneralVector = 0x80000080,
                        kBootUtlbVector = 0xBFC00100, kBootGeneralVector = 0xBFC00180;

/// Words by field, for tests and tools.
constexpr std::uint32_t r_word(std::uint32_t fn, unsigned rd, unsigned rs, unsigned rt, unsigned sa = 0) {
  return rs << 21 | rt << 16 | rd << 11 | sa << 6 | fn;
}
constexpr std::uint32_t i_word(std::uint32_t major, unsigned rt, unsigned rs, std::int32_t immediate) {
  return major << 26 | rs << 21 | rt << 16 | (static_cast<std::uint32_t>(immediate) & 0xFFFF);
}
constexpr std::uint32_t j_word(std::uint32_t major, std::uint32_t address) {
  return major << 26 | (address >> 2 & 0x3FFFFFF);
}
constexpr std::uint32_t cop_word(unsigned cop, unsigned move, unsigned rt, unsigned rd) {
  return (16 + cop) << 26 | move << 21 | rt << 16 | rd << 11;
}
constexpr std::uint32_t cp0_word(std::uint32_t fn) { return kCop0 << 26 | 1u << 25 | fn; }

}  // namespace dendro::r3000
