#pragma once

#include <array>
#include <cstdint>
#include <map>

#include "models/machines/machine.h"
#include "sim/trace/kanata.h"

namespace dendro::sgi_4d35 {

class ClockedPipeline;
struct ClockedSlot;

/// The way of every word through the pipeline as a Kanata log: lane 0 has the stages IF RD ALU MEM WB, lane 1
/// what a stall clock waited for, at the word that waits. Words that IF first asks for in the window are
/// followed to their end.
class ClockedLog {
 public:
  /// Throws UserError for a file that cannot be written.
  ClockedLog(const ClockedPipeline& pipeline, const MachineOptions& options);

  void during(std::uint64_t n);  ///< between look() and move()
  void close();

 private:
  struct Word {
    std::uint64_t id = 0;
    const char* stage = nullptr;
    bool named = false;  ///< its text is written
  };
  void fetch(std::uint64_t n);
  void stage(const ClockedSlot& slot, const char* name);
  void stall();

  const ClockedPipeline& pipeline_;
  std::uint64_t from_, to_;
  trace::KanataWriter writer_;
  std::map<std::uint64_t, Word> words_;  ///< in the pipeline, by position
  std::uint64_t ids_ = 0, retired_ = 0;
  std::uint64_t stalled_ = 0;
  const char* stalled_by_ = nullptr;  ///< the stage of lane 1 that is open, of word `stalled_`
};

}  // namespace dendro::sgi_4d35
