#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "models/machines/sgi_4d35/run_options.h"
#include "models/parts/r3000/r3000_isa.h"

/// What the tests of the 4D/35's clocks share: hand-assembled programs, run at a level that has time.
namespace dendro::sgi_4d35 {

using Words = std::vector<std::uint32_t>;

constexpr unsigned kT0 = 8, kT1 = 9, kT2 = 10, kT3 = 11, kS4 = 20, kS5 = 21, kK0 = 26, kK1 = 27;
/// Set by every program of `Timed`: cached data, a block that is new in every pass, cached data in another
/// DRAM page, a page of kuseg that is new in every pass, an uncached word, the service block, nothing.
constexpr unsigned kData = 16, kCold = 17, kElsewhere = 18, kMapped = 19, kUncached = 22, kService = 7,
                   kNothing = 6;
constexpr std::uint32_t kCode = 0x80010000, kNop = 0;

inline std::uint32_t load(unsigned reg, unsigned base, int offset = 0) {
  return r3000::i_word(r3000::kMajorLw, reg, base, offset);
}
inline std::uint32_t store(unsigned reg, unsigned base, int offset = 0) {
  return r3000::i_word(r3000::kMajorSw, reg, base, offset);
}
inline std::uint32_t store_byte(unsigned reg, unsigned base, int offset = 0) {
  return r3000::i_word(r3000::kMajorSb, reg, base, offset);
}
inline std::uint32_t add_immediate(unsigned reg, unsigned from, int value) {
  return r3000::i_word(r3000::kMajorAddiu, reg, from, value);
}
inline std::uint32_t high(unsigned reg, int value) { return r3000::i_word(r3000::kMajorLui, reg, 0, value); }
inline std::uint32_t or_immediate(unsigned reg, unsigned from, int value) {
  return r3000::i_word(r3000::kMajorOri, reg, from, value);
}
inline std::uint32_t branch_always(int words) { return r3000::i_word(r3000::kMajorBeq, 0, 0, words); }
inline std::uint32_t to_cp0(unsigned reg, unsigned cp0) { return r3000::cop_word(0, r3000::kMtc, reg, cp0); }
inline std::uint32_t from_cp0(unsigned reg, unsigned cp0) {
  return r3000::cop_word(0, r3000::kMfc, reg, cp0);
}
inline std::uint32_t multiply() { return r3000::r_word(r3000::kFnMult, 0, kT0, kT1); }
inline std::uint32_t divide() { return r3000::r_word(r3000::kFnDiv, 0, kT0, kT1); }
inline std::uint32_t from_hi(unsigned reg) { return r3000::r_word(r3000::kFnMfhi, reg, 0, 0); }
inline std::uint32_t from_lo(unsigned reg) { return r3000::r_word(r3000::kFnMflo, reg, 0, 0); }
inline std::uint32_t syscall() { return r3000::kFnSyscall; }

/// The preset's parameters with 1 MB of memory.
Spec small();

/// Bytes 0.. of memory as the program has them, big-endian words at physical addresses.
using Memory = std::map<std::uint32_t, Words>;

/// One run, in a process of its own.
struct Ran {
  std::vector<Retired> retired;
  std::map<std::string, std::uint64_t> counters;  ///< "processor.busy" and so on
  std::uint64_t cycles = 0, instructions = 0;
  bool stopped = false;
  r3000::State state;
  std::uint64_t memory_digest = 0;  ///< of main memory at the call that stopped it

  /// When the word at `pc` left MEM for the n-th time, from 0; -1: it did not.
  std::int64_t clock_of(std::uint32_t pc, std::size_t n) const;
};

ProgramImage image_of(const Memory& memory, std::uint32_t start);
std::uint64_t digest_of(const std::vector<std::uint8_t>& bytes);

/// Any call stops the machine.
struct StopService : service_block::Services {
  std::uint64_t digest = 0;  ///< of main memory at the call

  service_block::CallResult call(std::uint32_t, const std::array<std::uint32_t, 4>&,
                                 std::vector<std::uint8_t>& memory) override {
    digest = digest_of(memory);
    return {0, false, true};
  }
};

/// Runs what is in memory from `start` on, at most `limit` words; a store to the service block's first word
/// ends it.
Ran run_words(Level level, const Spec& spec, const Memory& memory, std::uint32_t start, std::uint64_t limit);

/// A body of words, executed twice behind a pause in which the units, the write buffer and memory come to
/// rest: the first pass brings the code into its cache, the second is looked at. In the pause memory reads a
/// word of a page of its own. The body begins at a block of the instruction cache.
struct Timed {
  Spec spec = small();
  Words setup, handler, refill;  ///< before the first pass; at the two vectors
  Ran ran;
  std::uint32_t body = 0;

  void run(Level level, const Words& words);
  /// Clocks in which the body's words left MEM in the second pass, from the first one's on.
  std::vector<std::int64_t> clocks(Level level, const Words& words);
  /// When a word at `pc` left MEM first in the second pass or behind it, counted from the body's first.
  std::int64_t clock_at(std::uint32_t pc) const;
};

using Clocks = std::vector<std::int64_t>;

/// The first register, count of events or TLB entry in which two states differ; empty if none.
std::string state_difference(const r3000::State& a, const r3000::State& b);

void expect_counters(const Ran& ran, const std::map<std::string, std::uint64_t>& expected);

/// The parameter is a level that has time: every count holds at each of them.
class Sgi4d35Timing : public ::testing::TestWithParam<Level> {
 protected:
  /// `timed_` with its handlers and setup, executed.
  Clocks clocks(const Words& words) { return timed_.clocks(GetParam(), words); }
  Clocks clocks(const Words& words, const Spec& spec) {
    timed_ = {};
    timed_.spec = spec;
    return clocks(words);
  }
  /// Clocks in which the words leave ALU: a word leaves MEM when the next one leaves ALU.
  Clocks issues(Words words, const Spec& spec = small()) {
    words.insert(words.begin(), kNop);
    Clocks result = clocks(words, spec);
    result.pop_back();
    return result;
  }
  Ran from_reset(const Words& words, std::uint64_t limit, const Spec& spec = small(),
                 std::uint32_t start = kCode) {
    return run_words(GetParam(), spec, {{kCode, words}}, start, limit);
  }
  std::uint64_t counter(const std::string& name) const { return timed_.ran.counters.at(name); }
  std::int64_t handler() const { return timed_.clock_at(r3000::kGeneralVector); }
  unsigned code() const { return timed_.ran.state.cause >> 2 & 31; }
  Timed timed_;
};

}  // namespace dendro::sgi_4d35
