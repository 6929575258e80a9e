#pragma once

#include <cstdint>
#include <vector>

#include "models/machines/sgi_4d35/board.h"
#include "models/machines/sgi_4d35/clocked_caches.h"
#include "models/machines/sgi_4d35/sgi_4d35.h"
#include "models/parts/r3010/clocked_units.h"

namespace dendro::sgi_4d35 {

/// What a clock was used for; the order of the waveform.
enum class ClockedCause : std::uint8_t {
  kBusy,
  kException,
  kFp,
  kMultiplyDivide,
  kInstructionMiss,
  kDataMiss,
  kUncached,
  kPartialStore,
  kWriteBuffer,
};

/// "busy", "exception" and so on.
const char* cause_name(ClockedCause cause);

/// A position of the pipeline, with what its stages have found out. Position 0 is the first word's.
struct ClockedSlot {
  std::uint64_t position = UINT64_MAX;  ///< before the first word: none
  bool live = false;                    ///< holds a word: not empty, not killed
  bool killed = false;                  ///< held one
  std::uint32_t pc = 0, physical = 0, word = 0;
  r3000::Decoded d;
  std::uint8_t destination = 0;  ///< general register, 0: none
  bool late = false;             ///< the next word does not see the result yet
  std::uint32_t a = 0, b = 0;    ///< operands, read in RD
  bool in_alu = false;           ///< ALU has looked at it
  std::uint32_t result = 0;
  bool taken = false;  ///< a branch, to `target`
  std::uint32_t target = 0;

  bool faulting = false, interrupted = false, entered = false;  ///< `entered`: its exception is
  r3000::Fault fault;

  bool in_mem = false;  ///< MEM has looked at it
  std::uint32_t address = 0, data_physical = 0;
  bool isolated = false, cached = false, memory = false;
  bool stored = false;
  unsigned partial_left = 0;
};

/// The word that IF asks for, from its first clock there on.
struct ClockedFetch {
  bool begun = false;
  std::uint32_t pc = 0, physical = 0;
  bool faulting = false;
  r3000::Fault fault;
  bool cached = false, memory = false;
};

/// R3000A, R3010A, caches, write buffer and memory, a clock at a time. In each clock the stages are looked at
/// from old state, from MEM to IF; then all move on, or none does. Rules: models/parts/r3000/README.md.
class ClockedPipeline {
 public:
  static constexpr ClockedCause kHolds = ClockedCause::kBusy;  ///< nothing to wait for

  /// Ends after `limit` words, or when the board stops.
  ClockedPipeline(const Spec& spec, Board& board, std::uint32_t start, std::uint64_t limit);

  /// What the next clock will be used for, and what happens in it up to its end.
  void look();
  /// The clock's end: what moves on does.
  void move();
  bool stopped() const { return stopped_; }  ///< the last clock was the machine's last

  std::uint64_t clock() const { return clock_; }
  Counters counters() const;
  const r3000::State& state() const { return state_; }
  void keep(std::vector<Retired>* retired) { retired_ = retired; }
  std::uint64_t words() const { return counted_; }  ///< completed or faulted
  /// From here on `state` is that behind the word that left MEM last.
  void show(r3000::State* state) { shown_ = state; }

  // For waveform and log, between look() and move().
  ClockedCause cause() const { return cause_; }
  const ClockedFetch& fetch() const { return fetch_; }
  const ClockedSlot& rd() const { return *rd_; }
  const ClockedSlot& alu() const { return *alu_; }
  const ClockedSlot& mem() const { return *mem_; }
  const ClockedSlot& wb() const { return *wb_; }
  std::uint64_t position() const { return position_; }  ///< of the word in IF
  const r3010::ClockedUnits& units() const { return units_; }
  const ClockedCaches& caches() const { return caches_; }
  const r3000_bus::ClockedBus& bus() const { return caches_.bus(); }
  unsigned multiplier_left() const { return multiplier_left_; }
  bool runs() const { return wait_ == kHolds; }      ///< a run clock
  ClockedCause stalled_by() const { return wait_; }  ///< if it is none

 private:
  // clocked_pipeline.cpp
  ClockedCause look_at_stages();
  bool last_word() const;
  ClockedCause run();
  ClockedCause leave_mem();
  void leave_if();
  void rotate();
  void count(ClockedCause cause);
  void log(const ClockedSlot& slot, bool killed);
  r3000::State behind_last_word() const;
  void finish();

  // clocked_fetch.cpp
  ClockedCause look_at_if();
  void begin_fetch();
  r3000::State ahead() const;
  void take_exception(ClockedSlot& m);

  // clocked_alu.cpp
  ClockedCause look_at_alu();
  void allow(ClockedSlot& a);
  ClockedCause wait_of(const ClockedSlot& a) const;
  void compute(ClockedSlot& a) const;
  void compute_branch(ClockedSlot& a) const;
  void leave_alu();
  void multiply_divide(const ClockedSlot& a);
  void execute_fp(ClockedSlot& a);
  void control_to_fpu(ClockedSlot& a);
  void pull_line();
  std::uint32_t operand(unsigned reg) const;

  // clocked_data.cpp
  ClockedCause look_at_mem();
  void begin_access(ClockedSlot& m);
  void begin_store(ClockedSlot& m);
  void take_word(ClockedSlot& m, std::uint32_t word) const;
  void store(ClockedSlot& m);
  void see_store(ClockedSlot& slot, std::uint32_t physical, bool has_operands);
  void leave_store(const ClockedSlot& m);

  const Spec spec_;
  Board& board_;
  std::uint64_t limit_;
  r3000::State state_;  ///< registers as WB left them; the rest as the stages that change it did
  ClockedSlot slots_[5];
  ClockedSlot *free_ = &slots_[0], *rd_ = &slots_[1], *alu_ = &slots_[2], *mem_ = &slots_[3],
              *wb_ = &slots_[4];
  ClockedFetch fetch_;
  std::uint32_t next_fetch_;    ///< behind the last fetched word
  unsigned empty_ = 0;          ///< positions that fetch nothing before the next word
  std::uint64_t position_ = 0;  ///< of the word in IF
  bool behind_branch_ = false;  ///< the word that left MEM last was a branch
  unsigned multiplier_left_ = 0;
  r3010::ClockedUnits units_;
  ClockedCaches caches_;

  std::uint64_t clock_ = 0, counted_ = 0;
  ClockedCause wait_ = kHolds, cause_ = kHolds;
  bool stopping_ = false, stopped_ = false;
  bool refilling_ = false;  ///< between a UTLB exception and rfe
  std::uint64_t refill_from_ = 0;
  Counters counters_;
  std::vector<Retired>* retired_ = nullptr;
  r3000::State* shown_ = nullptr;
};

/// The word's work changes what fetches behind it see: coprocessor 0's.
inline bool changes_cp0(r3000::Op op) {
  return op == r3000::Op::kMtc0 || (op >= r3000::Op::kTlbr && op <= r3000::Op::kRfe);
}
/// Whether the mode allows words of coprocessor 0.
inline bool cp0_allowed(const r3000::State& s) { return !s.user() || (s.status & r3000::kStatusCu0); }
/// mtc0, the TLB's operations, rfe.
void apply_cp0(r3000::State& s, const r3000::Decoded& d, std::uint32_t value);

}  // namespace dendro::sgi_4d35
