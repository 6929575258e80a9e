#include "models/parts/r3000/r3000_block.h"

#include "models/parts/r3010/r3010.h"

namespace dendro::r3000 {
namespace {

constexpr unsigned kMostWords = 48;

StepOp fp_operation(unsigned format, unsigned operation) {
  using namespace r3010;
  const bool twice = format == kDouble;
  if (operation >= kCompare) return twice ? StepOp::kCompareD : StepOp::kCompareS;
  switch (operation) {
    case kAdd:
      return twice ? StepOp::kAddD : StepOp::kAddS;
    case kSub:
      return twice ? StepOp::kSubD : StepOp::kSubS;
    case kMul:
      return twice ? StepOp::kMulD : StepOp::kMulS;
    case kDiv:
      return twice ? StepOp::kDivD : StepOp::kDivS;
    case kAbs:
      return twice ? StepOp::kAbsD : StepOp::kAbsS;
    case kNeg:
      return twice ? StepOp::kNegD : StepOp::kNegS;
    case kMov:
      return twice ? StepOp::kMovD : StepOp::kMovS;
    case kCvtS:
      return twice ? StepOp::kCvtSD : StepOp::kCvtSW;
    case kCvtD:
      return format == kSingle ? StepOp::kCvtDS : StepOp::kCvtDW;
    default:
      return StepOp::kFp;
  }
}

Step fp_step(Step step, std::uint32_t word) {
  using namespace r3010;
  const unsigned format = word >> 21 & 31, operation = word & 63;
  step.op = exists(format, operation) ? fp_operation(format, operation) : StepOp::kFp;
  const bool wide_result = operation < kCompare && (operation == kCvtD || (format == kDouble && operation != kCvtS && operation != kCvtW));
  const auto reg = [word](unsigned shift, bool wide) { return static_cast<std::uint8_t>(word >> shift & (wide ? 30 : 31)); };
  step.rs = reg(11, format == kDouble);
  step.rt = reg(16, format == kDouble);
  step.rd = reg(6, wide_result);
  return step;
}

/// False: blocks do not have this word. Not for branches and nops.
bool make_step(const Decoded& d, unsigned at, Step& step) {
  step = {StepOp::kEnd, d.rs, d.rt, d.rd, d.imm, static_cast<std::uint16_t>(at)};
  if (is_delayed_load(d.op) && d.rd != 0 && d.rt != kNowhere) return false;  // its slot needs care
  switch (d.op) {
#define DENDRO_CASE(name, ...)  \
  case Op::k##name:             \
    step.op = StepOp::k##name;  \
    return true;
    DENDRO_R3000_ALU(DENDRO_CASE)
    DENDRO_CASE(Lb)
    DENDRO_CASE(Lbu)
    DENDRO_CASE(Lh)
    DENDRO_CASE(Lhu)
    DENDRO_CASE(Lw)
    DENDRO_CASE(Sb)
    DENDRO_CASE(Sh)
    DENDRO_CASE(Sw)
    DENDRO_CASE(Lwc1)
    DENDRO_CASE(Swc1)
    DENDRO_CASE(Mfc1)
    DENDRO_CASE(Mtc1)
    DENDRO_CASE(Mfhi)
    DENDRO_CASE(Mflo)
#undef DENDRO_CASE
    case Op::kMult:
    case Op::kMultu:
      step.op = StepOp::kMult;
      break;
    case Op::kDiv:
    case Op::kDivu:
      step.op = StepOp::kDiv;
      break;
    case Op::kFp:
      step = fp_step(step, d.imm);
      return true;
    default:
      return false;
  }
  step.rd = static_cast<std::uint8_t>(d.op);
  return true;
}

/// False: blocks do not have this branch.
bool make_branch(const Decoded& d, unsigned at, bool nop, Step& step) {
  step = {StepOp::kEnd, d.rs, d.rt, d.rd, d.imm, static_cast<std::uint16_t>(at)};
  const std::int64_t target = std::int64_t{at} + s32(d.imm) / 4;
  const bool near = target >= 0 && target < kPageWords;
  switch (d.op) {
#define DENDRO_CASE(name, ...)                               \
  case Op::k##name:                                          \
    step.op = nop ? StepOp::k##name##Nop : StepOp::k##name; \
    break;
    DENDRO_R3000_BRANCHES(DENDRO_CASE)
#undef DENDRO_CASE
    case Op::kBc1f:
    case Op::kBc1t:
      step.op = d.op == Op::kBc1f ? StepOp::kBc1f : StepOp::kBc1t;
      if (!near) return false;
      break;
    case Op::kJ:
      step.op = StepOp::kJ;
      return true;
    case Op::kJal:
      step.op = StepOp::kJal;
      return true;
    case Op::kJr:
      step.op = StepOp::kJr;
      return true;
    case Op::kJalr:
      step.op = StepOp::kJalr;
      return true;
    default:
      return false;
  }
  if (near) {
    step.imm = static_cast<std::uint32_t>(target);
  } else {
    step.rd = static_cast<std::uint8_t>(d.op);
    step.op = StepOp::kFar;
  }
  return true;
}

bool leaves_page(StepOp op) { return op >= StepOp::kFar && op <= StepOp::kJalr; }

/// The branch at `at`, its slot and what goes; false, and nothing added: blocks do not have them.
bool add_branch(const Decoded* page, unsigned at, Block& block) {
  if (at + 1 >= kPageWords) return false;
  const Decoded& slot = page[at + 1];
  const bool nop = slot.op == Op::kNop;
  Step branch, behind;
  if (!make_branch(page[at], at, nop, branch)) return false;
  if (!nop && (is_branch(slot.op) || !make_step(slot, at + 1, behind))) return false;
  block.steps.push_back(branch);
  if (!nop) block.steps.push_back(behind);
  const bool goes = nop && !leaves_page(branch.op) && branch.op != StepOp::kBc1f && branch.op != StepOp::kBc1t;
  Step go;
  go.op = leaves_page(branch.op) ? StepOp::kGoFar : StepOp::kGo;
  go.at = static_cast<std::uint16_t>(at + 1);
  if (!goes) block.steps.push_back(go);
  return true;
}

}  // namespace

Block make_block(const Decoded* page, unsigned first) {
  Block block;
  block.first = static_cast<std::uint16_t>(first);
  unsigned at = first, behind = 2;
  // The two words behind a block that does not branch are fetched while it runs, and lie in its page, too.
  for (; at + 2 < kPageWords + (is_branch(page[at].op) ? 1 : 0) && at - first < kMostWords; ++at) {
    const Decoded& d = page[at];
    if (is_branch(d.op)) {
      if (!add_branch(page, at, block)) break;
      at += 2;
      behind = 0;
      break;
    }
    if (d.op == Op::kNop) continue;
    Step step;
    if (!make_step(d, at, step)) break;
    block.steps.push_back(step);
  }
  block.words = static_cast<std::uint16_t>(at - first);
  block.fetched = static_cast<std::uint16_t>(block.words + behind);
  block.nops = static_cast<std::uint16_t>(count_nops(page, first, at));
  if (behind != 0) {
    Step end;
    end.at = static_cast<std::uint16_t>(at);
    block.steps.push_back(end);
  }
  return block;
}

unsigned count_nops(const Decoded* page, unsigned first, unsigned end) {
  unsigned nops = 0;
  for (unsigned i = first; i < end; ++i) nops += page[i].op == Op::kNop && page[i].imm == 1;
  return nops;
}

}  // namespace dendro::r3000
