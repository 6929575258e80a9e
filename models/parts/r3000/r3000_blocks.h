#pragma once

#include "models/parts/r3000/r3000.h"

/// The fast way through what programs mostly do. Blocks hold no word that can change translation, what interrupts may
/// do, or code; a step that would fault, wait for a device or find no mapping leaves everything as it was, and
/// run_plain() does the word.
namespace dendro::r3000 {

/// The block at word `index` of the page, or nullptr: not all that it would fetch is in the instruction cache.
template <class Port, class Timing>
Block* Core<Port, Timing>::block_at(CodePage& page, unsigned index) {
  std::unique_ptr<Block>& block = page.blocks[index];
  if (!block) block = std::make_unique<Block>(make_block(page.words.data(), index));
  if constexpr (kTimed) {
    const std::uint32_t generation = time_.fetch_generation();
    if (block->checked == generation) return block.get();
    if (index + block->fetched > kPageWords) return nullptr;
    for (unsigned i = 0; i < block->fetched; ++i)
      if (!time_.has_word(page.physical | (index + i) << 2)) return nullptr;
    block->checked = generation;
  }
  return block.get();
}

/// The page of code at a virtual address that needs no more than a look, or nullptr.
template <class Port, class Timing>
auto Core<Port, Timing>::known_page(std::uint32_t address) -> CodePage* {
  const FetchMapping& m = fetches_[s_.user()][address >> 12 & (kMappings - 1)];
  return (address & (kPageMask | 3)) == m.tag ? m.page : nullptr;
}

/// An arithmetic word of coprocessor 1 that Quick refuses; false: nothing has changed, and it would not just be done.
template <class Port, class Timing>
bool Core<Port, Timing>::slow_fp(std::uint32_t word) {
  if (!(s_.status & kStatusCu1) || (s_.fpu.control >> r3010::kEnableShift & 31)) return false;
  quick_.settle(s_.fpu);
  const std::uint32_t control = s_.fpu.control;
  if (r3010::execute(s_.fpu, word) == r3010::Outcome::kDone) return true;
  s_.fpu.control = control;
  return false;
}

/// From a state that may_run_blocks() on. Returns what is left of the budget; `short_` says that a block was longer.
template <class Port, class Timing>
template <Pace kPace>
std::uint64_t Core<Port, Timing>::run_blocks(const std::uint64_t budget) {
  static const void* const kHandlers[] = {
#define DENDRO_LABEL(name, ...) &&do_##name,
#define DENDRO_LABELS(name, ...) &&do_##name, &&do_##name##Nop,
      DENDRO_R3000_ALU(DENDRO_LABEL) DENDRO_R3000_BRANCHES(DENDRO_LABELS) DENDRO_R3000_STEPS(DENDRO_LABEL)
#undef DENDRO_LABELS
#undef DENDRO_LABEL
  };
  constexpr bool kFast = kPace == Pace::kFast;
  short_ = false;
  std::uint32_t page_address = s_.pc & kPageMask, next_address = page_address;
  CodePage* code = known_page(s_.pc);
  if (code == nullptr) return budget;
  CodePage* next_code = code;
  Block *block = block_at(*code, s_.pc >> 2 & (kPageWords - 1)), *next = nullptr;
  if (block == nullptr || block->words == 0) return budget;
  std::uint32_t* const r = s_.r;
  std::uint32_t* const f = s_.fpu.r;
  const Mapping *const reads = maps().read.data(), *const writes = maps().write.data();
  const bool usable = s_.status & kStatusCu1;
  bool quick = usable && r3010::Quick::suits(s_.fpu);
  std::uint64_t left = budget;
  std::uint64_t clock = 0;  // in which word 0 of the page would be in ALU, if it ran from there without a stall
  std::uint32_t generation = 0;
  if constexpr (kTimed) generation = time_.fetch_generation();
  if constexpr (kFast) clock = time_.bias - block->first;
  const Step* step = nullptr;
  std::uint32_t target = 0;
  unsigned at = 0;

  const auto stall = [&](const auto& cycles) {
    if constexpr (kFast) clock += cycles(time_, clock + step->at);
  };
  const auto wait_in_memory = [&] {
    if constexpr (kFast) {
      const std::uint64_t now = clock + step->at + 1;
      clock += time_.memory(now) - now;
    } else if constexpr (kTimed) {
      time_.no_memory();
    }
  };
  const auto find = [&](bool taken, unsigned index) {
    next = block->next[taken];
    if (__builtin_expect(next != nullptr && (!kTimed || next->checked == generation), 1)) return true;
    next = block_at(*code, index);
    if (next == nullptr) return false;
    block->next[taken] = next;
    return true;
  };
  const auto find_far = [&](std::uint32_t address) {
    next_address = address & kPageMask;
    if (((address ^ page_address) & (kPageMask | 3)) == 0) {
      next_code = code;
    } else {
      next_code = known_page(address);
      if (next_code == nullptr) return false;
    }
    next = block_at(*next_code, address >> 2 & (kPageWords - 1));
    return next != nullptr;
  };
  const auto ended = [&] {
    left -= block->words;
    if constexpr (kFast) clock += block->words + block->first - next->first;
    if constexpr (kTimed) time_.count_nop(block->nops);
  };

#define DENDRO_DISPATCH goto* kHandlers[static_cast<unsigned>(step->op)]
#define DENDRO_NEXT \
  do {              \
    ++step;         \
    DENDRO_DISPATCH; \
  } while (0)
#define d (*step)
enter:
  if (__builtin_expect(left < block->words, 0)) {
    short_ = true;
    at = block->first;
    goto leave;
  }
  step = block->steps.data();
  DENDRO_DISPATCH;

#define DENDRO_DO(name, destination, value) \
  do_##name : r[d.destination] = value;     \
  DENDRO_NEXT;
  DENDRO_R3000_ALU(DENDRO_DO)
#undef DENDRO_DO

#define DENDRO_DO(name, condition)                                        \
  do_##name : {                                                           \
    const bool taken = condition;                                         \
    if (!find(taken, taken ? d.imm : block->first + block->words)) goto bail; \
    DENDRO_NEXT;                                                          \
  }                                                                       \
  do_##name##Nop : {                                                      \
    const bool taken = condition;                                         \
    if (!find(taken, taken ? d.imm : block->first + block->words)) goto bail; \
    ended();                                                              \
    block = next;                                                         \
    goto enter;                                                           \
  }
  DENDRO_R3000_BRANCHES(DENDRO_DO)
#undef DENDRO_DO
do_Bc1f:
do_Bc1t : {
  const bool taken = s_.fpu.condition() == (d.op == StepOp::kBc1t);
  if (!usable || !find(taken, taken ? d.imm : block->first + block->words)) goto bail;
  stall([](auto& time, std::uint64_t now) { return time.condition(now); });
  DENDRO_NEXT;
}
do_Far : {
  bool taken = false;
  switch (static_cast<Op>(d.rd)) {
#define DENDRO_DO(name, condition) \
  case Op::k##name:                \
    taken = condition;             \
    break;
    DENDRO_R3000_BRANCHES(DENDRO_DO)
#undef DENDRO_DO
    default:
      break;
  }
  if (!find_far(taken ? page_address + 4 * d.at + d.imm : page_address + 4 * (d.at + 2))) goto bail;
  DENDRO_NEXT;
}
do_Jal:
do_J:
  target = ((page_address + 4 * d.at + 4) & 0xF0000000) | d.imm;
  if (!find_far(target)) goto bail;
  if (d.op == StepOp::kJal) r[31] = page_address + 4 * d.at + 8;
  DENDRO_NEXT;
do_Jr:
  if (!find_far(r[d.rs])) goto bail;
  DENDRO_NEXT;
do_Jalr:
  if (!find_far(r[d.rs])) goto bail;
  r[d.rd] = page_address + 4 * d.at + 8;
  DENDRO_NEXT;

do_GoFar:
  page_address = next_address;
  code = next_code;
do_Go:
  ended();
  block = next;
  goto enter;
do_End:
  at = step->at;
  if (block->words == 0 || !find(false, at)) goto end;
  ended();
  block = next;
  goto enter;

#define DENDRO_LOAD(name, size, may, value_of, wait, destination)                              \
  do_##name : {                                                                                \
    if (!(may)) goto bail;                                                                     \
    const std::uint32_t address = r[d.rs] + d.imm;                                             \
    const Mapping& m = reads[address >> 12 & (kMappings - 1)];                                 \
    if (__builtin_expect((address & (kPageMask | (size - 1))) != m.tag, 0)) goto bail;         \
    const std::uint8_t* const p = m.bytes + (address & ~kPageMask);                            \
    bool there = true;                                                                         \
    if constexpr (kTimed) there = time_.read(m.physical | (address & ~kPageMask));             \
    wait;                                                                                      \
    destination = value_of;                                                                    \
    if (__builtin_expect(!there, 0)) wait_in_memory();                                         \
    DENDRO_NEXT;                                                                               \
  }
#define DENDRO_STORE(name, size, may, put, wait)                                               \
  do_##name : {                                                                                \
    if (!(may)) goto bail;                                                                     \
    const std::uint32_t address = r[d.rs] + d.imm;                                             \
    const Mapping& m = writes[address >> 12 & (kMappings - 1)];                                \
    if (__builtin_expect((address & (kPageMask | (size - 1))) != m.tag, 0)) goto bail;         \
    std::uint8_t* const p = m.bytes + (address & ~kPageMask);                                  \
    if constexpr (kTimed) time_.write(m.physical | (address & ~kPageMask), size);              \
    wait;                                                                                      \
    put;                                                                                       \
    wait_in_memory();                                                                          \
    DENDRO_NEXT;                                                                               \
  }
#define DENDRO_FP_REGISTER(reg) stall([&](auto& time, std::uint64_t now) { return time.fp_register(now, reg); })
  DENDRO_LOAD(Lb, 1, true, static_cast<std::uint32_t>(static_cast<std::int8_t>(*p)), {}, r[d.rt])
  DENDRO_LOAD(Lbu, 1, true, *p, {}, r[d.rt])
  DENDRO_LOAD(Lh, 2, true, static_cast<std::uint32_t>(static_cast<std::int16_t>(load16(p))), {}, r[d.rt])
  DENDRO_LOAD(Lhu, 2, true, load16(p), {}, r[d.rt])
  DENDRO_LOAD(Lw, 4, true, load32(p), {}, r[d.rt])
  DENDRO_LOAD(Lwc1, 4, usable, load32(p), DENDRO_FP_REGISTER(d.rt), f[d.rt])
  DENDRO_STORE(Sb, 1, true, *p = static_cast<std::uint8_t>(r[d.rt]), {})
  DENDRO_STORE(Sh, 2, true, store16(p, r[d.rt]), {})
  DENDRO_STORE(Sw, 4, true, store32(p, r[d.rt]), {})
  DENDRO_STORE(Swc1, 4, usable, store32(p, f[d.rt]), DENDRO_FP_REGISTER(d.rt))
#undef DENDRO_STORE
#undef DENDRO_LOAD

do_Mfc1:
  if (!usable) goto bail;
  DENDRO_FP_REGISTER(d.imm);
  r[d.rt] = f[d.imm];
  DENDRO_NEXT;
do_Mtc1:
  if (!usable) goto bail;
  DENDRO_FP_REGISTER(d.rd);
  f[d.rd] = r[d.rt];
  DENDRO_NEXT;
#undef DENDRO_FP_REGISTER

do_Mult:
do_Div:
  multiply_divide(static_cast<Op>(d.rd), r[d.rs], r[d.rt]);
  stall([&](auto& time, std::uint64_t now) { return time.multiply_divide(now, d.op == StepOp::kDiv); });
  DENDRO_NEXT;
do_Mfhi:
  r[d.rd] = s_.hi;
  stall([](auto& time, std::uint64_t now) { return time.multiplier(now); });
  DENDRO_NEXT;
do_Mflo:
  r[d.rd] = s_.lo;
  stall([](auto& time, std::uint64_t now) { return time.multiplier(now); });
  DENDRO_NEXT;

#define DENDRO_FP(name, done)                            \
  do_##name : if (!quick || !(done)) goto slow;          \
  stall([&](auto& time, std::uint64_t now) { return time.fp_issue(now, code->issues[d.at], true); }); \
  DENDRO_NEXT;
#define DENDRO_FP3(name, operation)                                                                      \
  DENDRO_FP(name##S, quick_.template single<r3010::operation>(s_.fpu, d.rd, d.rs, d.rt, d.imm))          \
  DENDRO_FP(name##D, quick_.template twice<r3010::operation>(s_.fpu, d.rd, d.rs, d.rt, d.imm))
  DENDRO_FP3(Add, kAdd)
  DENDRO_FP3(Sub, kSub)
  DENDRO_FP3(Mul, kMul)
  DENDRO_FP3(Div, kDiv)
#undef DENDRO_FP3
  DENDRO_FP(CvtDS, quick_.single_to_double(s_.fpu, d.rd, d.rs, d.imm))
  DENDRO_FP(CvtSD, quick_.double_to_single(s_.fpu, d.rd, d.rs, d.imm))
  DENDRO_FP(CvtSW, quick_.word_to_single(s_.fpu, d.rd, d.rs, d.imm))
  DENDRO_FP(CvtDW, quick_.word_to_double(s_.fpu, d.rd, d.rs, d.imm))
  DENDRO_FP(CompareS, quick_.template compare<float>(s_.fpu, d.rs, d.rt, d.imm))
  DENDRO_FP(CompareD, quick_.template compare<double>(s_.fpu, d.rs, d.rt, d.imm))
  DENDRO_FP(NegS, quick_.sign_single(s_.fpu, d.rd, d.rs, true))
  DENDRO_FP(AbsS, quick_.sign_single(s_.fpu, d.rd, d.rs, false))
  DENDRO_FP(NegD, quick_.sign_double(s_.fpu, d.rd, d.rs, true))
  DENDRO_FP(AbsD, quick_.sign_double(s_.fpu, d.rd, d.rs, false))
  DENDRO_FP(MovS, (f[d.rd] = f[d.rs], true))
  DENDRO_FP(MovD, (f[d.rd] = f[d.rs], f[d.rd + 1] = f[d.rs + 1], true))
  DENDRO_FP(Fp, false)
slow:
  if (!slow_fp(d.imm)) goto bail;
  quick = r3010::Quick::suits(s_.fpu);
  stall([&](auto& time, std::uint64_t now) { return time.fp_issue(now, code->issues[d.at], true); });
  DENDRO_NEXT;
#undef DENDRO_FP
#undef d
#undef DENDRO_NEXT
#undef DENDRO_DISPATCH

bail:  // before this word
  at = step->at;
end:
leave:
  quick_.settle(s_.fpu);
  left -= at - block->first;
  s_.pc = page_address | at << 2;
  s_.next_pc = s_.pc + 4;
  s_.in_slot = block->fetched == block->words && at == block->first + block->words - 1u;
  if (s_.in_slot) s_.next_pc = next_address | std::uint32_t{next->first} << 2;
  s_.instructions += budget - left;
  if constexpr (kTimed) {
    time_.count_nop(count_nops(code->words.data(), block->first, at));
    time_.count_fetches(budget - left);
  }
  if constexpr (kFast) time_.bias = clock + at;
  return left;
}

}  // namespace dendro::r3000
