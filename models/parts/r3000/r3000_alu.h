#pragma once

#include <cstdint>

/// What the words do that change one register and cannot fault, and when the branches go, each written once. Who
/// expands a list has the word's fields in `d` and the registers in `r`.
namespace dendro::r3000 {

constexpr std::int32_t s32(std::uint32_t value) { return static_cast<std::int32_t>(value); }

}  // namespace dendro::r3000

/// X(name of the Op, field of its destination, value)
#define DENDRO_R3000_ALU(X)                                         \
  X(Sll, rd, r[d.rt] << d.imm)                                      \
  X(Srl, rd, r[d.rt] >> d.imm)                                      \
  X(Sra, rd, static_cast<std::uint32_t>(s32(r[d.rt]) >> d.imm))     \
  X(Sllv, rd, r[d.rt] << (r[d.rs] & 31))                            \
  X(Srlv, rd, r[d.rt] >> (r[d.rs] & 31))                            \
  X(Srav, rd, static_cast<std::uint32_t>(s32(r[d.rt]) >> (r[d.rs] & 31))) \
  X(Addu, rd, r[d.rs] + r[d.rt])                                    \
  X(Subu, rd, r[d.rs] - r[d.rt])                                    \
  X(And, rd, r[d.rs] & r[d.rt])                                     \
  X(Or, rd, r[d.rs] | r[d.rt])                                      \
  X(Xor, rd, r[d.rs] ^ r[d.rt])                                     \
  X(Nor, rd, ~(r[d.rs] | r[d.rt]))                                  \
  X(Slt, rd, s32(r[d.rs]) < s32(r[d.rt]))                           \
  X(Sltu, rd, r[d.rs] < r[d.rt])                                    \
  X(Addiu, rt, r[d.rs] + d.imm)                                     \
  X(Slti, rt, s32(r[d.rs]) < s32(d.imm))                            \
  X(Sltiu, rt, r[d.rs] < d.imm)                                     \
  X(Andi, rt, r[d.rs] & d.imm)                                      \
  X(Ori, rt, r[d.rs] | d.imm)                                       \
  X(Xori, rt, r[d.rs] ^ d.imm)                                      \
  X(Lui, rt, d.imm)

/// X(name of the Op, condition): branches whose only effect is to go.
#define DENDRO_R3000_BRANCHES(X)      \
  X(Beq, r[d.rs] == r[d.rt])          \
  X(Bne, r[d.rs] != r[d.rt])          \
  X(Blez, s32(r[d.rs]) <= 0)          \
  X(Bgtz, s32(r[d.rs]) > 0)           \
  X(Bltz, s32(r[d.rs]) < 0)           \
  X(Bgez, s32(r[d.rs]) >= 0)
