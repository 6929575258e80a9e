#include "models/machines/sgi_4d35/clocked_pipeline.h"

namespace dendro::sgi_4d35 {

using r3000::Op;

void apply_cp0(r3000::State& s, const r3000::Decoded& d, std::uint32_t value) {
  switch (d.op) {
    case Op::kMtc0:
      write_cp0(s, d.rd, value);
      return;
    case Op::kTlbr:
      tlb_read(s);
      return;
    case Op::kTlbwi:
      tlb_write(s, s.index >> 8 & 63);
      return;
    case Op::kTlbwr:
      tlb_write(s, random_of(s));
      return;
    case Op::kTlbp:
      tlb_probe(s);
      return;
    default:
      return_from_exception(s);
      return;
  }
}

/// The state as the words in ALU and RD will leave it for the word in IF. Those in MEM have done their part.
r3000::State ClockedPipeline::ahead() const {
  r3000::State s = state_;
  s.instructions += mem_->live && !mem_->faulting;
  if (alu_->live && !alu_->faulting) {
    if (changes_cp0(alu_->d.op)) apply_cp0(s, alu_->d, alu_->b);
    ++s.instructions;
  }
  if (rd_->live && !rd_->faulting && changes_cp0(rd_->d.op) && cp0_allowed(s) && !interrupt_due(s))
    apply_cp0(s, rd_->d, operand(rd_->d.rt));
  return s;
}

ClockedCause ClockedPipeline::look_at_if() {
  if (empty_ != 0) return kHolds;
  if (!fetch_.begun) begin_fetch();
  if (fetch_.faulting) return kHolds;
  if (!caches_.fetched()) return ClockedCause::kInstructionMiss;
  if (!fetch_.memory) {
    fetch_.faulting = true;
    fetch_.fault.code = r3000::kIbe;
  }
  return kHolds;
}

void ClockedPipeline::begin_fetch() {
  ClockedFetch& f = fetch_;
  f.begun = true;
  f.pc = alu_->live && !alu_->faulting && alu_->taken ? alu_->target : next_fetch_;
  if (f.pc & 3) {
    f.faulting = true;
    f.fault.code = r3000::kAdel;
    f.fault.address = f.pc;
    f.fault.has_address = true;
    return;
  }
  const bool changing = (alu_->live && changes_cp0(alu_->d.op)) || (rd_->live && changes_cp0(rd_->d.op));
  bool past_caches;
  if (changing) {
    r3000::State s = ahead();
    f.faulting = !translate(s, f.pc, r3000::Access::kFetch, f.physical, f.fault);
    past_caches = uncached(s, f.pc);
  } else {
    f.faulting = !translate(state_, f.pc, r3000::Access::kFetch, f.physical, f.fault);
    past_caches = uncached(state_, f.pc);
  }
  if (f.faulting) return;
  f.memory = board_.in_memory(f.physical);
  f.cached = f.memory && !past_caches;
  caches_.fetch(f.physical, f.cached, f.memory);
}

/// The word in MEM faults: it and the two younger ones are killed, the handler comes behind empty positions.
void ClockedPipeline::take_exception(ClockedSlot& m) {
  m.entered = true;
  m.destination = 0;
  state_.pc = m.pc;
  state_.in_slot = behind_branch_;
  enter_exception(state_, m.fault);
  for (ClockedSlot* slot : {alu_, rd_}) {
    slot->killed = slot->live;
    slot->live = false;
  }
  fetch_ = {};
  empty_ = spec_.pipeline.exception_cycles - 2;
  next_fetch_ = state_.pc;
}

}  // namespace dendro::sgi_4d35
