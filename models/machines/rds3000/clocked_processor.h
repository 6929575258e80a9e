#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "models/machines/rds3000/rds3000_spec.h"
#include "models/machines/rds3000/rds3000_state.h"
#include "models/parts/am2903/am2903_slices.h"
#include "models/parts/bps32/bps32_isa.h"

namespace dendro::rds3000 {

/// What a tick of the processor was spent on.
enum class ClockedCause : std::uint8_t { kBusy, kHost, kBranch, kData, kBus, kScratch, kIdle };

/// What the processor sees of the other units in a tick.
struct ClockedSignals {
  bool access_in_flight = false;
  bool read_under_way = false;
  bool vertical_blank = false;
  bool field = false;
};

/// An access that a word starts.
struct ClockedRequest {
  bool write = false;
  std::uint32_t address = 0, data = 0;
  unsigned function = 0;
};

/// The BPS32 of the clocked level: one tick at a time, from its data sheets. Bus and display are seen through
/// signals.
class ClockedProcessor {
 public:
  ClockedProcessor(const ProcessorSpec& spec, const std::map<std::uint32_t, std::string>& marks);

  /// What a word that executed did to the outside, valid until the next tick.
  struct Effects {
    bool request = false;
    bool halted = false;
    bool reads_time = false;
    bool marked = false;
    std::uint32_t word = 0;  ///< its word index
    std::uint32_t f = 0, y = 0;
    ClockedRequest access;
  };

  /// One tick; the state afterwards is that at its end.
  ClockedCause tick(std::int64_t n, const ClockedSignals& in);
  const Effects& effects() const { return effects_; }

  /// The host has taken ticks n + 1 to n + steal_ticks.
  void steal(std::int64_t n);
  void run();
  void halt() { state_.running = false; }
  void reset();
  void load_read_data(std::uint32_t data) { state_.read_data = data; }

  /// The board as the host sees it over the bus; places that are not there read 0 and ignore writes.
  std::uint32_t host_read(std::uint32_t address) const;
  void host_write(std::uint32_t address, std::uint32_t data);

  const ProcessorState& state() const { return state_; }
  /// Replaces the state, memories of the same sizes included; nothing holds the processor.
  void load(const ProcessorState& state) {
    state_ = state;
    for (Word& word : words_) word.decoded = false;
  }
  void set_interrupt(bool up) { state_.interrupt = up; }
  std::uint32_t word_index() const {
    const std::uint32_t index = state_.page * bps32::kPageWords + state_.pc;
    return index < control_words_ ? index : index % control_words_;
  }

 private:
  /// A control word taken apart; made when it is first fetched after a change.
  struct Word {
    bool decoded = false;
    bool reads_bus, starts_access, uses_scratch, reads_time, marked;
    bool writes, pol, i0, ea, oeb, latch, halt;
    std::uint8_t seq, cond, func, dest, a, b, shift, carry, fill, dsrc, ydst, busfn, mul;
    std::uint16_t imm;
  };

  // clocked_processor.cpp
  void decode(std::uint32_t index, Word& word) const;

  // clocked_word.cpp: what one word does
  void execute(const Word& w, std::int64_t n, const ClockedSignals& in);
  std::uint32_t d_bus(const Word& w) const;
  bool condition(unsigned cond, const ClockedSignals& in) const;
  bool carry_in(unsigned select) const;
  std::uint32_t scratch_index(std::uint32_t address) const {
    return address < scratch_words_ ? address : address % scratch_words_;
  }
  void write_y(const Word& w, std::uint32_t y);
  void multiplier(const Word& w);
  std::uint16_t sequence(unsigned op, bool pass, std::uint16_t direct);
  void push(std::uint16_t address);
  std::uint16_t top() const { return state_.stack[state_.depth == 0 ? 0 : state_.depth - 1u]; }
  void pop() {
    if (state_.depth > 0) --state_.depth;
  }

  ProcessorSpec spec_;
  const std::map<std::uint32_t, std::string>& marks_;
  std::uint32_t control_words_, scratch_words_;
  ProcessorState state_;
  std::vector<Word> words_;
  Effects effects_;
  std::int64_t stolen_through_ = -1;   ///< no word executes up to this tick: the host has the memories
  std::int64_t branch_through_ = -1;   ///< nor up to this one: the pipeline refills
  std::int64_t scratch_through_ = -1;  ///< nor up to this one: the scratchpad works
  bool scratch_started_ = false;       ///< for the word now held
};

}  // namespace dendro::rds3000
