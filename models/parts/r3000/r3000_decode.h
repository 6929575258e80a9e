#pragma once

#include <cstdint>

#include "models/parts/r3000/r3000_isa.h"

namespace dendro::r3000 {

/// One word's work, with what its fields can say in advance.
enum class Op : std::uint8_t {
  kNop,
  kSll,
  kSrl,
  kSra,
  kSllv,
  kSrlv,
  kSrav,
  kAdd,
  kAddu,
  kSub,
  kSubu,
  kAnd,
  kOr,
  kXor,
  kNor,
  kSlt,
  kSltu,
  kAddi,
  kAddiu,
  kSlti,
  kSltiu,
  kAndi,
  kOri,
  kXori,
  kLui,
  kMult,
  kMultu,
  kDiv,
  kDivu,
  kMfhi,
  kMthi,
  kMflo,
  kMtlo,
  kJ,
  kJal,
  kJr,
  kJalr,
  kBeq,
  kBne,
  kBlez,
  kBgtz,
  kBltz,
  kBgez,
  kBltzal,
  kBgezal,
  kBc0f,
  kBc0t,
  kBc1f,
  kBc1t,
  kLb,
  kLbu,
  kLh,
  kLhu,
  kLw,
  kLwl,
  kLwr,
  kMfc0,
  kMfc1,
  kCfc1,
  kSb,
  kSh,
  kSw,
  kSwl,
  kSwr,
  kLwc1,
  kSwc1,
  kMtc0,
  kMtc1,
  kCtc1,
  kFp,
  kTlbr,
  kTlbwi,
  kTlbwr,
  kTlbp,
  kRfe,
  kSyscall,
  kBreak,
  kCopUnusable,  ///< a word of coprocessor `rd`, which is not there
  kReserved,
};

/// The register that takes results for register 0.
constexpr unsigned kNowhere = 32;

/// `imm`: the extended immediate; a branch's target less its own address; a jump's target bits 27-0; the word
/// itself for kFp; for kNop 1 if it is sll r0, r0, 0, else 0. `rd` of a load says that its result must wait for the instruction after the next.
struct Decoded {
  Op op = Op::kReserved;
  std::uint8_t rs = 0, rt = 0, rd = 0;
  std::uint32_t imm = 0;
};

Decoded decode(std::uint32_t word);

constexpr bool is_branch(Op op) { return op >= Op::kJ && op <= Op::kBc1t; }
/// Writes a general register one instruction late: loads and moves from a coprocessor.
constexpr bool is_delayed_load(Op op) { return op >= Op::kLb && op <= Op::kCfc1; }

/// The general register written, or 0.
unsigned destination_of(const Decoded& d);

/// True if the word reads general register `reg` in its ALU stage. lwl and lwr take the register they merge
/// into from the load before them, so that does not count [GEN; MIPS I].
bool reads(const Decoded& d, unsigned reg);

/// Decodes a page of `count` words in place, with the loads marked whose slot needs care: the next word reads
/// the register, or it is not known which word comes next (slot of a branch, first and last word of the
/// page).
void decode_page(const std::uint32_t* words, unsigned count, Decoded* out);

}  // namespace dendro::r3000
