#pragma once

#include <cstdint>
#include <vector>

#include "models/parts/r3000/r3000_alu.h"
#include "models/parts/r3000/r3000_decode.h"

/// Straight pieces of decoded code, up to a branch and its slot, in the form that run_blocks() executes.
namespace dendro::r3000 {

/// What a step can be beside the lists of r3000_alu.h: accesses, moves, the multiplier, floating point by operation.
#define DENDRO_R3000_STEPS(X) \
  X(Lb) X(Lbu) X(Lh) X(Lhu) X(Lw) X(Sb) X(Sh) X(Sw) X(Lwc1) X(Swc1) X(Mfc1) X(Mtc1)                             \
  X(Mult) X(Div) X(Mfhi) X(Mflo)                                                                                \
  X(AddS) X(SubS) X(MulS) X(DivS) X(AddD) X(SubD) X(MulD) X(DivD) X(CvtDS) X(CvtSD) X(CvtSW) X(CvtDW)           \
  X(CompareS) X(CompareD) X(NegS) X(AbsS) X(NegD) X(AbsD) X(MovS) X(MovD) X(Fp)                                 \
  X(Bc1f) X(Bc1t) X(Far) X(J) X(Jal) X(Jr) X(Jalr)                                                              \
  X(Go) X(GoFar) X(End)

enum class StepOp : std::uint8_t {
#define DENDRO_NAME(name, ...) k##name,
#define DENDRO_PAIR(name, ...) k##name, k##name##Nop,
  DENDRO_R3000_ALU(DENDRO_NAME) DENDRO_R3000_BRANCHES(DENDRO_PAIR) DENDRO_R3000_STEPS(DENDRO_NAME)
#undef DENDRO_PAIR
#undef DENDRO_NAME
};

/// A word as it is executed; nops are left out. Branches of r3000_alu.h end with `Nop` if their slot is one, and then
/// go at once; all others say where, their slot follows and then Go, or GoFar for what may leave the page.
/// Fields as those of Decoded, but: floating point has fs, ft, fd in rs, rt, rd, those of a double even; a branch
/// has in `imm` the index of its target in the page; Far, a branch out of it, has its Op in `rd` and keeps its `imm`.
struct Step {
  StepOp op = StepOp::kEnd;
  std::uint8_t rs = 0, rt = 0, rd = 0;
  std::uint32_t imm = 0;
  std::uint16_t at = 0;  ///< index of the word in its page
};

struct Block {
  std::vector<Step> steps;
  std::uint16_t first = 0, words = 0;  ///< index in the page; number of words, nops and the slot included, 0 if none
  std::uint16_t fetched = 0;           ///< words from `first` on that its execution or its going on fetches
  std::uint16_t nops = 0;
  std::uint32_t checked = 0;  ///< for whoever executes: when it last was found fit
  Block* next[2] = {nullptr, nullptr};  ///< in the same page: behind the block, and at the target
};

constexpr unsigned kPageWords = 1024;

/// The block that begins at `first` of a decoded page.
Block make_block(const Decoded* page, unsigned first);

/// Words sll r0, r0, 0 among [first, end) of a page.
unsigned count_nops(const Decoded* page, unsigned first, unsigned end);

}  // namespace dendro::r3000
