#include "models/machines/sgi_4d35/clocked_pipeline.h"

#include <utility>

namespace dendro::sgi_4d35 {

using r3000::Op;

const char* cause_name(ClockedCause cause) {
  static const char* const kNames[] = {
      "busy",     "exception",     "fp",          "multiply_divide", "instruction_miss", "data_miss",
      "uncached", "partial_store", "write_buffer"};
  return kNames[static_cast<std::size_t>(cause)];
}

ClockedPipeline::ClockedPipeline(const Spec& spec, Board& board, std::uint32_t start, std::uint64_t limit)
    : spec_(spec),
      board_(board),
      limit_(limit),
      next_fetch_(start),
      units_(spec.fpu),
      caches_(spec) {
  state_.pc = start;
  state_.next_pc = start + 4;
  state_.status = 0;
  stopped_ = limit == 0 || board.stopped();
}

void ClockedPipeline::look() {
  units_.begin();
  multiplier_left_ -= multiplier_left_ != 0;
  caches_.begin();
  wait_ = look_at_stages();
}

ClockedCause ClockedPipeline::look_at_stages() {
  ClockedCause wait = look_at_mem();
  if (wait != kHolds) return wait;
  stopping_ = last_word();
  if (stopping_) return kHolds;
  wait = look_at_alu();
  return wait != kHolds ? wait : look_at_if();
}

void ClockedPipeline::move() {
  cause_ = wait_ == kHolds ? run() : wait_;
  count(cause_);
  caches_.end();
  ++clock_;
  if (stopping_) finish();
}

bool ClockedPipeline::last_word() const {
  if (!mem_->live || mem_->interrupted) return false;
  return counted_ + 1 == limit_ || board_.stopped();
}

/// Everything moves on by one stage; in the last clock only the word in MEM does.
ClockedCause ClockedPipeline::run() {
  if (wb_->live && wb_->destination != 0) state_.r[wb_->destination] = wb_->result;
  const ClockedCause cause = leave_mem();
  if (stopping_) return cause;
  if (shown_ != nullptr) *shown_ = behind_last_word();
  leave_alu();
  if (rd_->live) {
    rd_->a = operand(rd_->d.rs);
    rd_->b = operand(rd_->d.rt);
  }
  leave_if();
  rotate();
  return cause;
}

ClockedCause ClockedPipeline::leave_mem() {
  ClockedSlot& m = *mem_;
  behind_branch_ = false;
  if (!m.live) return ClockedCause::kException;
  counted_ += !m.interrupted;
  log(m, m.faulting);
  if (m.faulting) {
    if (m.fault.refill && !refilling_) {
      refilling_ = true;
      refill_from_ = clock_;
    }
    m.live = false;
    m.killed = true;
    return ClockedCause::kException;
  }
  if (m.in_mem) leave_store(m);
  if (m.d.op == Op::kLwc1) state_.fpu.r[m.d.rt] = m.result;
  if (m.d.op == Op::kRfe && refilling_) {
    refilling_ = false;
    counters_.tlb_refill_cycles += clock_ - refill_from_ + 1;
  }
  ++state_.instructions;
  counters_.nops += m.word == 0;
  behind_branch_ = is_branch(m.d.op);
  return ClockedCause::kBusy;
}

void ClockedPipeline::leave_if() {
  ClockedSlot& slot = *free_;
  slot = {};
  slot.position = position_++;
  if (empty_ != 0) {
    --empty_;
    return;
  }
  slot.live = true;
  slot.pc = fetch_.pc;
  slot.physical = fetch_.physical;
  slot.faulting = fetch_.faulting;
  slot.fault = fetch_.fault;
  next_fetch_ = fetch_.pc + 4;
  fetch_ = {};
  if (slot.faulting) return;
  slot.word = board_.word(slot.physical);
  slot.d = r3000::decode(slot.word);
  slot.destination = static_cast<std::uint8_t>(destination_of(slot.d));
  slot.late = is_delayed_load(slot.d.op);
}

void ClockedPipeline::rotate() {
  ClockedSlot* const done = wb_;
  wb_ = mem_;
  mem_ = alu_;
  alu_ = rd_;
  rd_ = free_;
  free_ = done;
}

void ClockedPipeline::count(ClockedCause cause) {
  static constexpr std::uint64_t Counters::*kCounters[] = {&Counters::busy,
                                                           &Counters::stall_exception,
                                                           &Counters::stall_fp,
                                                           &Counters::stall_multiply_divide,
                                                           &Counters::stall_instruction_miss,
                                                           &Counters::stall_data_miss,
                                                           &Counters::stall_uncached,
                                                           &Counters::stall_partial_store,
                                                           &Counters::stall_write_buffer};
  ++(counters_.*kCounters[static_cast<std::size_t>(cause)]);
}

void ClockedPipeline::log(const ClockedSlot& slot, bool killed) {
  if (retired_ != nullptr) retired_->push_back({clock_, slot.pc, killed});
}

/// The state behind the word in MEM: those behind it have done nothing yet.
r3000::State ClockedPipeline::behind_last_word() const {
  r3000::State s = state_;
  if (mem_->live && mem_->destination != 0) s.r[mem_->destination] = mem_->result;
  if (mem_->killed) return s;  // the exception has set the program counter
  s.pc = alu_->pc;
  s.next_pc = rd_->pc;
  s.in_slot = behind_branch_;
  return s;
}

void ClockedPipeline::finish() {
  stopped_ = true;
  state_ = behind_last_word();
  if (shown_ != nullptr) *shown_ = state_;
}

Counters ClockedPipeline::counters() const {
  Counters c = counters_;
  c.cycles = clock_;
  const Counters caches = caches_.counters();
  c.instruction_accesses = caches.instruction_accesses;
  c.instruction_misses = caches.instruction_misses;
  c.data_accesses = caches.data_accesses;
  c.data_misses = caches.data_misses;
  c.memory = caches.memory;
  return c;
}

}  // namespace dendro::sgi_4d35
