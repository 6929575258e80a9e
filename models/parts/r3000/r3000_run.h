#pragma once

#include "models/parts/r3000/r3000.h"

namespace dendro::r3000 {

template <class Port, class Timing>
std::uint64_t Core<Port, Timing>::run(std::uint64_t budget) {
  while (budget != 0 && !port_.stopped()) budget = run_to_service(budget);
  return budget;
}

template <class Port, class Timing>
std::uint64_t Core<Port, Timing>::run_to_service(std::uint64_t budget) {
  touched_ = false;
  while (budget != 0 && !touched_) {
    if constexpr (kTimed) lose_positions();
    if (interrupt_due(s_)) {
      fault_ = {};
      if constexpr (kTimed) {
        interrupted();
        enter_exception(s_, fault_);
        refetch_ = true;
        continue;
      }
      enter_exception(s_, fault_);
      refetch_ = true;
    }
    if (s_.pending_reg != 0) {
      run_after_load();
      --budget;
    } else {
      budget = run_paced(budget);
    }
  }
  return budget;
}

/// One word in the slot of a load that it may read: it sees the register's old value, and what it writes
/// there wins. If it is itself a load whose result waits, the word behind it sees the first one's.
template <class Port, class Timing>
void Core<Port, Timing>::run_after_load() {
  const unsigned reg = s_.pending_reg;
  const std::uint32_t value = s_.pending_value;
  s_.pending_reg = 0;
  const CodePage* const page = fetch_page(s_.pc);
  const Decoded d = page ? page->words[s_.pc >> 2 & (kPageWords - 1)] : Decoded();
  refetch_ = true;
  merge_ = (d.op == Op::kLwl || d.op == Op::kLwr) && d.rt == reg;
  merge_value_ = value;
  const std::uint64_t exceptions = s_.exceptions;
  run_words(1);
  merge_ = false;
  if (s_.exceptions != exceptions || destination_of(d) != reg || s_.pending_reg == reg) s_.r[reg] = value;
}

/// Where nothing reads a load's register in its slot. Ends early after a word that run() must look behind.
template <class Port, class Timing>
template <Pace kPace>
std::uint64_t Core<Port, Timing>::run_plain(std::uint64_t budget) {
  std::uint32_t* const r = s_.r;
  std::uint32_t pc = s_.pc, npc = s_.next_pc;
  std::uint64_t left = budget, faults = 0;
  std::uint64_t branch_left =
      s_.in_slot ? budget + 1 : 0;  // `left` at the last branch, so that a slot is known
  std::uint32_t page_address = 1;
  const CodePage* code = nullptr;
  const Decoded* page = nullptr;
  constexpr bool kCount = kPace == Pace::kFast || kPace == Pace::kCareful, kCareful = kPace == Pace::kCareful,
                 kHurry = kPace == Pace::kFast || kPace == Pace::kWarm;
  std::uint32_t edge = 0;
  if constexpr (kHurry) edge = time_.fetch_edge();
  const std::uint64_t base = s_.instructions;
  leave_ = false;
  refetch_ = true;
  while (left != 0 && !leave_) {
    if (__builtin_expect(((pc ^ page_address) & (kPageMask | 3)) != 0 || refetch_, 0)) {
      refetch_ = false;
      page_address = pc & kPageMask;
      code = fetch_page(pc);
      page = code ? code->words.data() : nullptr;
      refetch_ = false;
    }
    std::uint32_t next = npc + 4, value = 0;
    bool good = page != nullptr;
    const Decoded d = good ? page[pc >> 2 & (kPageWords - 1)] : Decoded();
    const auto branch = [&](bool taken) {
      branch_left = left;
      if (taken) next = pc + d.imm;
    };
    const auto reserved = [&] {
      good = false;
      fault_ = {};
    };
    // ALU lets the word go in clock `when(now)`.
    const auto wait = [&](const auto& when) {
      if constexpr (kCareful) catch_up(left);
      if constexpr (kCount) time_.bias += when(time_, time_.bias - left);
    };
    if (__builtin_expect(good, 1)) switch (d.op) {
        case Op::kNop:
          if constexpr (kTimed) time_.count_nop(d.imm);
          goto plain;
#define DENDRO_CASE(name, destination, value) \
  case Op::k##name:                           \
    r[d.destination] = value;                 \
    goto plain;
        DENDRO_R3000_ALU(DENDRO_CASE)
#undef DENDRO_CASE
        case Op::kAdd: {
          const std::uint32_t sum = r[d.rs] + r[d.rt];
          good = s32((r[d.rs] ^ sum) & (r[d.rt] ^ sum)) >= 0;
          if (good)
            r[d.rd] = sum;
          else
            fault_ = {}, fault_.code = kOv;
          break;
        }
        case Op::kSub: {
          const std::uint32_t difference = r[d.rs] - r[d.rt];
          good = s32((r[d.rs] ^ r[d.rt]) & (r[d.rs] ^ difference)) >= 0;
          if (good)
            r[d.rd] = difference;
          else
            fault_ = {}, fault_.code = kOv;
          break;
        }
        case Op::kAddi: {
          const std::uint32_t sum = r[d.rs] + d.imm;
          good = s32((r[d.rs] ^ sum) & (d.imm ^ sum)) >= 0;
          if (good)
            r[d.rt] = sum;
          else
            fault_ = {}, fault_.code = kOv;
          break;
        }
        case Op::kMult:
        case Op::kMultu:
        case Op::kDiv:
        case Op::kDivu:
          multiply_divide(d.op, r[d.rs], r[d.rt]);
          wait([&](auto& time, std::uint64_t now) { return time.multiply_divide(now, d.op >= Op::kDiv); });
          goto plain;
        case Op::kMfhi:
          r[d.rd] = s_.hi;
          wait([&](auto& time, std::uint64_t now) { return time.multiplier(now); });
          goto plain;
        case Op::kMthi:
          s_.hi = r[d.rs];
          wait([&](auto& time, std::uint64_t now) { return time.multiplier(now); });
          goto plain;
        case Op::kMflo:
          r[d.rd] = s_.lo;
          wait([&](auto& time, std::uint64_t now) { return time.multiplier(now); });
          goto plain;
        case Op::kMtlo:
          s_.lo = r[d.rs];
          wait([&](auto& time, std::uint64_t now) { return time.multiplier(now); });
          goto plain;
        case Op::kJal:
          r[31] = pc + 8;
          [[fallthrough]];
        case Op::kJ:
          branch(false);
          next = ((pc + 4) & 0xF0000000) | d.imm;
          goto branched;
        case Op::kJalr: {
          const std::uint32_t target = r[d.rs];
          r[d.rd] = pc + 8;
          branch(false);
          next = target;
          goto branched;
        }
        case Op::kJr:
          branch(false);
          next = r[d.rs];
          goto branched;
#define DENDRO_CASE(name, condition) \
  case Op::k##name:                  \
    branch(condition);               \
    goto branched;
        DENDRO_R3000_BRANCHES(DENDRO_CASE)
#undef DENDRO_CASE
        case Op::kBltzal:
        case Op::kBgezal: {
          const bool taken = (s32(r[d.rs]) < 0) == (d.op == Op::kBltzal);
          r[31] = pc + 8;
          branch(taken);
          goto branched;
        }
        case Op::kBc0f:
        case Op::kBc0t:
          if (s_.user() && !(s_.status & kStatusCu0))
            reserved(), fault_.code = kCpu;
          else
            branch(d.op == Op::kBc0f);  // the condition input is not connected and reads 0
          if (good) goto branched;
          break;
        case Op::kBc1f:
        case Op::kBc1t:
          good = coprocessor1();
          if (!good) break;
          wait([&](auto& time, std::uint64_t now) { return time.condition(now); });
          branch(s_.fpu.condition() == (d.op == Op::kBc1t));
          goto branched;
        case Op::kLb:
          good = load(r[d.rs] + d.imm, 1, value);
          value = static_cast<std::uint32_t>(static_cast<std::int8_t>(value));
          goto loaded;
        case Op::kLbu:
          good = load(r[d.rs] + d.imm, 1, value);
          goto loaded;
        case Op::kLh:
          good = load(r[d.rs] + d.imm, 2, value);
          value = static_cast<std::uint32_t>(static_cast<std::int16_t>(value));
          goto loaded;
        case Op::kLhu:
          good = load(r[d.rs] + d.imm, 2, value);
          goto loaded;
        case Op::kLw:
          good = load(r[d.rs] + d.imm, 4, value);
          goto loaded;
        case Op::kLwl:
        case Op::kLwr:
          good = load_part(d, d.op == Op::kLwl, value);
          goto loaded;
        case Op::kMfc0:
          good = !s_.user() || (s_.status & kStatusCu0);
          if (!good) fault_ = {}, fault_.code = kCpu;
          s_.instructions = base + (budget - left) - faults;
          value = read_cp0(s_, spec_, d.imm, random_of(s_));
          goto loaded;
        case Op::kMfc1:
          good = coprocessor1();
          if (good) wait([&](auto& time, std::uint64_t now) { return time.fp_register(now, d.imm); });
          value = s_.fpu.r[d.imm];
          goto loaded;
        case Op::kCfc1:
          good = coprocessor1();
          if (good) wait([&](auto& time, std::uint64_t now) { return time.fp_empty(now); });
          value = r3010::read_control(s_.fpu, d.imm);
          goto loaded;
        loaded:
          if (!good) break;
          if (d.rd != 0 && d.rt != kNowhere) {  // somebody may read it too early
            s_.pending_reg = d.rt;
            s_.pending_value = value;
            leave_ = true;
          } else {
            r[d.rt] = value;
          }
          if constexpr (kTimed)
            if (__builtin_expect(time_.in_mem(), 0)) goto memory;
          goto plain;
        case Op::kSb:
          good = store(r[d.rs] + d.imm, 1, r[d.rt] & 0xFF);
          if (good) goto memory;
          break;
        case Op::kSh:
          good = store(r[d.rs] + d.imm, 2, r[d.rt] & 0xFFFF);
          if (good) goto memory;
          break;
        case Op::kSw:
          good = store(r[d.rs] + d.imm, 4, r[d.rt]);
          if (good) goto memory;
          break;
        case Op::kSwl:
        case Op::kSwr:
          good = store_part(d, d.op == Op::kSwl);
          if (good) goto memory;
          break;
        case Op::kLwc1:
          good = coprocessor1();
          if (!good) break;
          good = load(r[d.rs] + d.imm, 4, value);
          wait([&](auto& time, std::uint64_t now) { return time.fp_register(now, d.rt); });
          if (!good) break;
          s_.fpu.r[d.rt] = value;
          if constexpr (kTimed)
            if (__builtin_expect(time_.in_mem(), 0)) goto memory;
          goto plain;
        case Op::kSwc1:
          good = coprocessor1();
          if (!good) break;
          good = store(r[d.rs] + d.imm, 4, s_.fpu.r[d.rt]);
          wait([&](auto& time, std::uint64_t now) { return time.fp_register(now, d.rt); });
          if (good) goto memory;
          break;
        case Op::kMtc1:
          good = coprocessor1();
          if (!good) break;
          wait([&](auto& time, std::uint64_t now) { return time.fp_register(now, d.rd); });
          s_.fpu.r[d.rd] = r[d.rt];
          goto plain;
        case Op::kCtc1:
          good = coprocessor1();
          if (!good) break;
          good = d.rd != 31 || control_to_fpu(r[d.rt]);
          wait([&](auto& time, std::uint64_t now) { return time.fp_empty(now); });
          leave_ = true;
          break;
        case Op::kFp:
          good = coprocessor1();
          if (!good) break;
          good = execute_fp(d);
          if constexpr (kCount)
            wait([&](auto& time, std::uint64_t now) {
              return time.fp_issue(now, code->issues[pc >> 2 & (kPageWords - 1)], good);
            });
          if (good) goto plain;
          break;
        case Op::kMtc0:
        case Op::kTlbr:
        case Op::kTlbwi:
        case Op::kTlbwr:
        case Op::kTlbp:
        case Op::kRfe:
          s_.instructions = base + (budget - left) - faults;
          good = execute_cp0(d);
          break;
        case Op::kSyscall:
          reserved(), fault_.code = kSys;
          break;
        case Op::kBreak:
          reserved(), fault_.code = kBp;
          break;
        case Op::kCopUnusable:
          reserved(), fault_.code = kCpu, fault_.coprocessor = d.rd;
          break;
        case Op::kReserved:
          reserved(), fault_.code = kRi;
          break;
      }
    if (__builtin_expect(good, 1)) {
    plain:
      if constexpr (kHurry)
        if (__builtin_expect((next & edge) == 0, 0)) fetched(next, left);
      if constexpr (kCareful) {
        catch_up(left);
        finish_careful(pc, npc, next, d.op == Op::kRfe, left);
      }
      pc = npc;
      npc = next;
    } else {
      s_.pc = pc;
      s_.in_slot = branch_left == left + 1;
      if constexpr (kTimed) {
        if constexpr (kHurry) time_.uncount_fetch();
        catch_up(left);
        finish_fault(pc, npc, fault_.refill, left);
      }
      enter_exception(s_, fault_);
      pc = s_.pc;
      npc = s_.next_pc;
      refetch_ = true;
      branch_left = 0;
      ++faults;
    }
    goto stepped;
  memory:  // a store, or a load that MEM must wait for
    if constexpr (kHurry) {
      if (__builtin_expect((next & edge) == 0, 0)) fetched(next, left);
      if constexpr (kPace == Pace::kFast)
        time_.bias += time_.memory(time_.bias - left + 1) - (time_.bias - left + 1);
      else
        time_.no_memory();
      pc = npc;
      npc = next;
      goto stepped;
    }
    goto plain;
  branched:
    if constexpr (kHurry) {
      fetched(next, left);
      pc = npc;
      npc = next;
      goto stepped;
    }
    goto plain;
  stepped:
    --left;
    if constexpr (kCareful)
      if (lost_ == 0 && !leave_) {
        s_.pc = pc;
        s_.next_pc = npc;
        time_.bias -= left;
        leave_ = may_hurry();
        time_.bias += left;
      }
  }
  if constexpr (kHurry) time_.count_fetches(budget - left);
  s_.pc = pc;
  s_.next_pc = npc;
  s_.in_slot = branch_left != 0 && branch_left == left + 1;
  s_.instructions = base + (budget - left) - faults;
  return left;
}

}  // namespace dendro::r3000
