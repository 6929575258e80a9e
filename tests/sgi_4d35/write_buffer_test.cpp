#include <gtest/gtest.h>

#include <deque>
#include <random>

#include "models/parts/r3000_bus/r3000_bus.h"

namespace dendro::r3000_bus {
namespace {

constexpr std::uint32_t kMemory = 1 << 16, kNone = ~0u;

/// The data sheet a clock at a time: one operation of memory, a queue, one read that waits.
class Clocked {
 public:
  explicit Clocked(const Spec& spec) : spec_(spec) {}

  std::uint64_t now = 0;
  Counters counters;

  bool full() const { return queue_.size() + writing_ >= spec_.entries; }
  bool read_done() const { return !asked_ && !reading_; }
  std::uint64_t read_started() const { return read_started_; }
  void ask(std::uint32_t address, unsigned words, bool cached) {
    asked_ = true;
    address_ = address;
    words_ = words;
    cached_ = cached;
  }
  /// The rest of the clock: memory takes what it may, then a store that leaves MEM enters.
  void clock(std::uint32_t store) {
    if (left_ == 0) begin();
    counters.busy += left_ != 0;
    if (store != kNone) queue_.push_back(store);
    ++now;
    if (left_ != 0 && --left_ == 0) writing_ = reading_ = false;
  }

 private:
  void begin() {
    bool may = asked_;
    if (asked_ && (!cached_ || !spec_.read_bypass)) may = queue_.empty();
    if (asked_ && cached_)
      for (const std::uint32_t entry : queue_) may = may && entry / (4 * words_) != address_ / (4 * words_);
    if (may) {
      counters.overtaken += !queue_.empty();
      ++counters.reads;
      counters.read_words += words_;
      left_ = spec_.first_word_cycles + words_ * spec_.word_cycles;
      page_ = page(address_);
      read_started_ = now;
      asked_ = false;
      reading_ = true;
    } else if (!queue_.empty()) {
      const std::uint32_t next = page(queue_.front());
      const bool same = next == page_ && page_ != kNone;
      left_ = same ? spec_.page_write_cycles : spec_.write_cycles;
      ++counters.writes;
      counters.page_writes += same;
      page_ = next;
      queue_.pop_front();
      writing_ = true;
    }
  }
  std::uint32_t page(std::uint32_t address) const {
    return address < kMemory ? address / spec_.page_bytes : kNone;
  }

  Spec spec_;
  std::deque<std::uint32_t> queue_;
  bool asked_ = false, cached_ = false, reading_ = false, writing_ = false;
  std::uint32_t address_ = 0, page_ = kNone;
  unsigned words_ = 0;
  std::uint64_t left_ = 0, read_started_ = 0;
};

Spec random_spec(std::mt19937& random) {
  Spec s;
  s.entries = 1 + random() % 6;
  s.read_bypass = random() % 3 != 0;
  s.first_word_cycles = 1 + random() % 8;
  s.word_cycles = 1 + random() % 2;
  s.write_cycles = 1 + random() % 9;
  s.page_write_cycles = 1 + random() % 4;
  s.page_bytes = 64u << random() % 4;
  return s;
}

/// Stores, reads and pauses in any order, the processor waiting as it does: for an entry, for its read.
void compare(std::uint32_t seed) {
  std::mt19937 random(seed);
  const Spec spec = random_spec(random);
  Bus bus(spec, kMemory);
  Clocked clocked(spec);
  for (int step = 0; step < 300; ++step) {
    const std::uint32_t address = (random() % 64) * 4 + (random() % 8 == 0 ? kMemory : 0);
    const unsigned kind = random() % 4;
    if (kind <= 1) {
      const std::uint64_t then = bus.free_from(clocked.now);
      while (clocked.full()) clocked.clock(kNone);
      ASSERT_EQ(clocked.now, then) << "seed " << seed << " step " << step;
      bus.store(address, then);
      if (const unsigned later = random() % 4; later != 0) {  // what leaves MEM with it waits in ALU
        for (unsigned i = 0; i < later; ++i) clocked.clock(kNone);
        bus.delay_newest(then, then + later);
      }
      clocked.clock(address);
    } else if (kind == 2) {
      const bool cached = random() % 4 != 0 && address < kMemory;
      const unsigned words = cached ? 4 : 1;
      const std::uint32_t block = cached ? address & ~15u : address;
      const std::uint64_t start =
          cached ? bus.read_block(block, words, clocked.now) : bus.read_uncached(block, clocked.now);
      clocked.ask(block, words, cached);
      while (!clocked.read_done()) clocked.clock(kNone);
      ASSERT_EQ(clocked.read_started(), start) << "seed " << seed << " step " << step;
    } else {
      for (unsigned n = random() % 12; n != 0; --n) clocked.clock(kNone);
    }
    if (clocked.now == 0) continue;
    const Counters a = bus.counters(clocked.now - 1);
    const Counters& b = clocked.counters;
    ASSERT_EQ(b.busy, a.busy) << "seed " << seed << " step " << step;
    ASSERT_EQ(b.writes, a.writes) << "seed " << seed << " step " << step;
    ASSERT_EQ(b.page_writes, a.page_writes) << "seed " << seed << " step " << step;
    ASSERT_EQ(b.overtaken, a.overtaken) << "seed " << seed << " step " << step;
    ASSERT_EQ(b.reads, a.reads);
    ASSERT_EQ(b.read_words, a.read_words);
  }
}

TEST(WriteBuffer, ClosedFormIsTheQueueAClockAtATime) {
  for (std::uint32_t seed = 1; seed <= 3000 && !::testing::Test::HasFatalFailure(); ++seed) compare(seed);
}

}  // namespace
}  // namespace dendro::r3000_bus
