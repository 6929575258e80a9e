#include "models/machines/sgi_4d35/clocked_log.h"

#include <fmt/format.h>

#include "models/machines/sgi_4d35/clocked_pipeline.h"
#include "models/parts/r3000/r3000_disasm.h"

namespace dendro::sgi_4d35 {

ClockedLog::ClockedLog(const ClockedPipeline& pipeline, const MachineOptions& options)
    : pipeline_(pipeline),
      from_(static_cast<std::uint64_t>(options.pipeline_from)),
      to_(static_cast<std::uint64_t>(options.pipeline_to)),
      writer_(options.pipeline_file) {}

void ClockedLog::during(std::uint64_t n) {
  if (n < from_ || (n >= to_ && words_.empty())) return;
  writer_.at(static_cast<std::int64_t>(n));
  stage(pipeline_.wb(), "WB");
  stage(pipeline_.mem(), "MEM");
  stage(pipeline_.alu(), "ALU");
  stage(pipeline_.rd(), "RD");
  fetch(n);
  stall();
  if (!pipeline_.runs()) return;
  writer_.at(static_cast<std::int64_t>(n) + 1);
  for (const ClockedSlot* done : {&pipeline_.wb(), &pipeline_.mem()}) {
    const auto found = words_.find(done->position);
    if (found == words_.end() || (done == &pipeline_.mem() && !done->faulting)) continue;
    writer_.retire(found->second.id, retired_, done->faulting);
    retired_ += !done->faulting;
    words_.erase(found);
  }
}

void ClockedLog::fetch(std::uint64_t n) {
  const ClockedFetch& fetch = pipeline_.fetch();
  if (!fetch.begun || n >= to_ || words_.count(pipeline_.position()) != 0) return;
  Word& word = words_[pipeline_.position()];
  word.id = ids_++;
  word.stage = "IF";
  writer_.begin(word.id, pipeline_.position());
  writer_.stage(word.id, 0, "IF");
}

void ClockedLog::stage(const ClockedSlot& slot, const char* name) {
  const auto found = words_.find(slot.position);
  if (found == words_.end()) return;
  Word& word = found->second;
  if (!word.named) {
    word.named = true;
    const std::string text = slot.faulting ? "(cannot be fetched)" : r3000::disassemble(slot.word, slot.pc);
    writer_.text(word.id, 0, fmt::format("{:08x}: {}", slot.pc, text));
  }
  if (slot.killed) {
    writer_.retire(word.id, retired_, true);
    words_.erase(found);
    return;
  }
  if (word.stage == name) return;
  word.stage = name;
  writer_.stage(word.id, 0, name);
}

/// Opens or closes the stage of lane 1.
void ClockedLog::stall() {
  const ClockedCause cause = pipeline_.stalled_by();
  std::uint64_t position = pipeline_.mem().position;
  if (cause == ClockedCause::kInstructionMiss) position = pipeline_.position();
  if (cause == ClockedCause::kFp || cause == ClockedCause::kMultiplyDivide)
    position = pipeline_.alu().position;
  const auto found = words_.find(position);
  const char* name = pipeline_.runs() || found == words_.end() ? nullptr : cause_name(cause);
  if (name == stalled_by_ && (name == nullptr || found->second.id == stalled_)) return;
  if (stalled_by_ != nullptr) writer_.end(stalled_, 1, stalled_by_);
  stalled_by_ = name;
  if (name == nullptr) return;
  stalled_ = found->second.id;
  writer_.stage(stalled_, 1, name);
}

void ClockedLog::close() {
  for (const auto& [position, word] : words_) writer_.retire(word.id, retired_, true);
  writer_.close();
}

}  // namespace dendro::sgi_4d35
