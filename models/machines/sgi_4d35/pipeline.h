#pragma once

#include <cstdint>
#include <vector>

#include "models/machines/sgi_4d35/sgi_4d35.h"
#include "models/parts/r3000_bus/r3000_bus.h"
#include "models/parts/r3000_cache/r3000_cache.h"
#include "models/parts/r3010/r3010_scoreboard.h"

namespace dendro::sgi_4d35 {

/// The time of the timed core (r3000_time.h) at level `cycle`: caches, write buffer, multiplier, floating-point
/// units, all in absolute clocks, and the causes of every stall clock. Tags of the data cache change in program
/// order, since only MEM looks at them; what takes time is kept as an event until the word is in MEM.
class Pipeline {
 public:
  static constexpr bool kTimed = true;
  using Issue = r3010::Issue;

  explicit Pipeline(const Spec& spec);

  /// The clock in which MEM lets go of the word before the next, plus what run_plain() has left to count.
  std::uint64_t bias = 0;

  /// Gets the words that left MEM, in order. `then` is the clock of the one before. All words are then careful.
  struct Listener {
    virtual ~Listener() = default;
    virtual void left_memory(const Retired& word, std::uint64_t then) = 0;
  };
  void listen(Listener* listener) { listener_ = listener; }

  /// As if the machine stopped in clock `last`, `words` of which had completed.
  Counters counters(std::uint64_t words, std::uint64_t last) const;

  // Data, in program order. Physical addresses; `read` and `write` are of cached main memory.
  /// False: it misses.
  bool read(std::uint32_t address) {
    ++data_accesses_;
    if (__builtin_expect(data_.hit(address), 1)) return true;
    miss(address);
    return false;
  }
  void write(std::uint32_t address, unsigned size) {
    if (size == 4) {
      ++data_accesses_;
      data_misses_ += !data_.hit(address);
      data_.store_word(address);
      event_ = {Event::kStore, address & ~3u};
    } else {
      write_part(address);
    }
  }
  void read_uncached(std::uint32_t address) { event_ = {Event::kUncachedRead, address}; }
  void write_uncached(std::uint32_t address) { event_ = {Event::kStore, address & ~3u}; }
  void isolated_read(bool cached) { data_accesses_ += cached; }
  void isolated_write(std::uint32_t address, unsigned size, bool swapped);
  /// The next byte belongs to the access of the one before, or does not.
  void part(bool same) { same_access_ = same; }
  bool in_mem() const { return event_.kind != Event::kNone; }

  // IF.
  /// Changes whenever a word of the instruction cache does.
  std::uint32_t fetch_generation() const { return fetch_generation_; }
  std::uint32_t fetch_edge() const { return instruction_.refill_bytes() - 1; }
  bool has_word(std::uint32_t address) const { return instruction_.hit(address); }
  void count_fetches(std::uint64_t words) { instruction_accesses_ += words; }
  void uncount_fetch() { --instruction_accesses_; }
  std::uint64_t fetch(std::uint32_t address, std::uint64_t now, bool warm);
  std::uint64_t fetch_uncached(std::uint32_t address, std::uint64_t now);
  bool streaming(std::uint64_t now) const { return stream_end_ > now; }

  // ALU: stall clocks of a word that is there from clock `now` on.
  Issue issue_of(std::uint32_t word) const { return r3010::issue_of(word, fpu_timing_); }
  std::uint64_t fp_issue(std::uint64_t now, const Issue& issue, bool good) {
    const std::uint64_t then = fpu_.when(issue, now);
    in_alu_ = {&issue, then, good};
    if (good) fpu_.issue(issue, then);
    return stalled(stall_fp_, now, then);
  }
  std::uint64_t fp_register(std::uint64_t now, unsigned reg) {
    return stalled(stall_fp_, now, fpu_.when_register(reg, now));
  }
  std::uint64_t condition(std::uint64_t now) { return fp_register(now, r3010::kConditionRegister); }
  std::uint64_t fp_empty(std::uint64_t now) { return stalled(stall_fp_, now, fpu_.when_empty(now)); }
  std::uint64_t multiplier(std::uint64_t now) {
    return stalled(stall_multiply_divide_, now, multiplier_free_ > now ? multiplier_free_ : now);
  }
  std::uint64_t multiply_divide(std::uint64_t now, bool divide) {
    const std::uint64_t stall = multiplier(now);
    multiplier_start_ = now + stall;
    multiplier_free_ = now + stall + (divide ? spec_.pipeline.divide_cycles : spec_.pipeline.multiply_cycles);
    return stall;
  }
  void count_nop(std::uint32_t nops) { nops_ += nops; }

  // MEM: the clock in which the word whose event is kept goes on.
  std::uint64_t memory(std::uint64_t now) {
    if (event_.kind == Event::kStore) {
      const std::uint64_t then = bus_.free_from(now);
      stall_write_buffer_ += then - now;
      bus_.store(event_.address, then);
      event_.kind = Event::kNone;
      return then;
    }
    return event_.kind == Event::kNone ? now : memory_slowly(now);
  }
  void no_memory() { event_.kind = Event::kNone; }
  void put_off() {
    put_off_ = event_;
    event_.kind = Event::kNone;
  }
  std::uint64_t put_off_memory(std::uint64_t now);

  // Careful steps: what stands in MEM, and run clocks.
  unsigned exception_positions() const { return spec_.pipeline.exception_cycles; }
  void before_step() {
    if (waiting_ == 0) in_no_memory();
  }
  void in_memory(std::uint32_t pc, bool killed, bool refill, bool rfe);
  void in_no_memory();
  void run_clock(std::uint64_t clock);
  void lost(std::uint64_t positions) { stall_exception_ += positions; }
  bool may_hurry() const { return listener_ == nullptr && notes_ == 0; }
  void hurry() { waiting_ = 0; }
  /// The last word leaves MEM.
  void finish();

 private:
  struct Event {
    enum Kind : std::uint8_t { kNone, kStore, kPartialStore, kBlockRead, kUncachedRead, kSwapped };
    Kind kind = kNone;
    std::uint32_t address = 0;
    bool valid = false;  ///< kSwapped: the word becomes valid
  };
  /// The last arithmetic word of coprocessor 1, which issues in the run clock, so not while IF waits.
  struct InAlu {
    const Issue* issue = nullptr;
    std::uint64_t clock = 0;
    bool good = false;
  };
  struct Waiting {
    Retired word;
    bool listed = false, refill = false, rfe = false;
  };

  std::uint64_t stalled(std::uint64_t& cause, std::uint64_t now, std::uint64_t then) {
    if (__builtin_expect(then == now, 1)) return 0;
    cause += then - now;
    bus_.delay_newest(now, then);
    return then - now;
  }
  void miss(std::uint32_t address);
  template <class Look>
  std::uint64_t wait_in_fetch(std::uint64_t now, const Look& look);
  void write_part(std::uint32_t address);
  std::uint64_t memory_slowly(std::uint64_t now);

  const Spec spec_;
  const r3010::Timing fpu_timing_;
  r3000_cache::Tags instruction_, data_;
  r3000_bus::Bus bus_;
  r3010::Scoreboard fpu_;
  Event event_, put_off_, swap_;
  bool same_access_ = false;
  InAlu in_alu_;
  std::uint64_t multiplier_start_ = 0, multiplier_free_ = 0;
  std::uint64_t stream_start_ = 0, stream_end_ = 0;  ///< read of the instruction block at stream_block_
  std::uint32_t stream_block_ = 0, fetch_generation_ = 1;
  Waiting waits_[4];
  unsigned waiting_ = 0, notes_ = 0;
  Listener* listener_ = nullptr;
  std::uint64_t left_memory_ = 0;  ///< clock in which the last listed word left MEM, plus 1
  bool refilling_ = false;
  std::uint64_t refill_start_ = 0;
  std::uint64_t nops_ = 0, tlb_refill_cycles_ = 0;
  std::uint64_t stall_exception_ = 1, stall_fp_ = 0, stall_multiply_divide_ = 0, stall_instruction_miss_ = 0,
                stall_data_miss_ = 0, stall_uncached_ = 0, stall_partial_store_ = 0, stall_write_buffer_ = 0;
  std::uint64_t instruction_accesses_ = 0, instruction_misses_ = 0, data_accesses_ = 0, data_misses_ = 0;
};

}  // namespace dendro::sgi_4d35
