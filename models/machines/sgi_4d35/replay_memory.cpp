#include <algorithm>
#include <deque>
#include <memory>
#include <string>

#include "models/machines/sgi_4d35/boundaries.h"
#include "models/machines/sgi_4d35/trace_words.h"
#include "models/parts/r3000_bus/clocked_bus.h"
#include "models/parts/r3000_bus/r3000_bus.h"
#include "sim/base/check.h"
#include "sim/trace/replay_unit.h"

namespace dendro::sgi_4d35 {
namespace {

using r3000_bus::Read;
using trace::Record;
using trace::Replayer;

/// Write buffer and memory at one level, driven by what asks one after another. Clocks are absolute.
class BusSide {
 public:
  struct Listener {
    virtual ~Listener() = default;
    virtual void entered(std::uint64_t store) = 0;
    /// Memory has written a store, 0 being the first.
    virtual void written(std::uint64_t store, std::uint64_t start, std::uint64_t end) = 0;
    /// The last word of a read is there, 0 being the first read.
    virtual void read_done(std::uint64_t read, std::uint64_t end) = 0;
  };

  explicit BusSide(Listener& listener) : listener_(listener) {}
  virtual ~BusSide() = default;

  /// Asks in clock `at`, or when it is its turn. Returns the clock in which memory begins.
  std::uint64_t read(const Read& read, std::uint64_t at) {
    std::uint64_t now = std::max(at, turn_);
    if (in_mem_ && leaves_ <= now) {
      now = std::max(now, leaves_ + 1);
      enter();
    }
    const std::uint64_t start = start_read(read, now);
    if (in_mem_) leaves_ = std::max(leaves_, start + 1);
    turn_ = start + 1;
    return start;
  }
  /// A store is in MEM in clock `at`, or when it is its turn, and leaves it in `leaves` if it can. Returns the clock in
  /// which an entry is free.
  std::uint64_t write(std::uint32_t address, bool memory, std::uint64_t at, std::uint64_t leaves) {
    std::uint64_t now = std::max(at, turn_);
    if (in_mem_) {
      now = std::max(now, leaves_ + 1);
      enter();
    }
    turn_ = free_from(now);
    in_mem_ = true;
    address_ = address;
    memory_ = memory;
    leaves_ = std::max(turn_, leaves);
    return turn_;
  }
  /// As if the run ended with clock `last`.
  r3000_bus::Counters counters(std::uint64_t last) {
    if (in_mem_ && leaves_ <= last) enter();
    turn_ = std::max(turn_, last + 1);
    return counters_at(last);
  }
  /// Goes on until every read is done.
  virtual void finish_read() = 0;
  /// Goes on until nothing waits.
  void finish() {
    if (in_mem_) enter();
    finish_all();
  }
  virtual void open_page(std::uint32_t address) = 0;

 protected:
  virtual std::uint64_t start_read(const Read& read, std::uint64_t now) = 0;
  virtual std::uint64_t free_from(std::uint64_t now) = 0;
  virtual void store(std::uint32_t address, bool memory, std::uint64_t now) = 0;
  virtual r3000_bus::Counters counters_at(std::uint64_t last) = 0;
  virtual void finish_all() = 0;

  Listener& listener_;

 private:
  void enter() {
    in_mem_ = false;
    store(address_, memory_, leaves_);
    listener_.entered(stores_++);
  }

  std::uint64_t turn_ = 0, stores_ = 0;
  bool in_mem_ = false, memory_ = false;  ///< a store waits in MEM
  std::uint32_t address_ = 0;
  std::uint64_t leaves_ = 0;
};

class CycleBus : public BusSide {
 public:
  CycleBus(const Spec& spec, Listener& listener) : BusSide(listener), bus_(spec.bus, spec.main_bytes) {}

  void finish_read() override {}
  void open_page(std::uint32_t address) override { bus_.open_page(address); }

 protected:
  std::uint64_t start_read(const Read& read, std::uint64_t now) override {
    settle(now);
    const std::uint64_t start =
        read.cached ? bus_.read_block(read.address, read.words, now) : bus_.read_uncached(read.address, now);
    listener_.read_done(reads_++, bus_.read_end());
    return start;
  }
  std::uint64_t free_from(std::uint64_t now) override {
    settle(now);
    return bus_.free_from(now);
  }
  void store(std::uint32_t address, bool, std::uint64_t now) override {
    settle(now);
    bus_.store(address, now);
  }
  r3000_bus::Counters counters_at(std::uint64_t last) override { return bus_.counters(last); }
  void finish_all() override { settle(UINT64_MAX); }

 private:
  // No read can move what has begun.
  void settle(std::uint64_t now) {
    for (; settled_ < bus_.stores(); ++settled_) {
      const r3000_bus::Bus::Write write = bus_.write(settled_);
      if (write.start >= now) return;
      listener_.written(settled_, write.start, write.end);
    }
  }

  r3000_bus::Bus bus_;
  std::uint64_t settled_ = 0, reads_ = 0;
};

class ClockedBusSide : public BusSide {
 public:
  ClockedBusSide(const Spec& spec, Listener& listener) : BusSide(listener), bus_(spec.bus) {}

  void finish_read() override {
    while (done_ < asked_) step();
  }
  void open_page(std::uint32_t address) override { bus_.open_page(address); }

 protected:
  std::uint64_t start_read(const Read& read, std::uint64_t now) override {
    go_to(now);
    bus_.ask(read);
    ++asked_;
    started_ = UINT64_MAX;
    while (started_ == UINT64_MAX) step();
    return started_;
  }
  std::uint64_t free_from(std::uint64_t now) override {
    go_to(now);
    while (!bus_.entry_free()) step();
    return clock_;
  }
  void store(std::uint32_t address, bool memory, std::uint64_t now) override {
    go_to(now);
    bus_.enter(address, memory);
  }
  r3000_bus::Counters counters_at(std::uint64_t last) override {
    go_to(last + 1);
    return bus_.counters();
  }
  void finish_all() override {
    while (!bus_.idle()) step();
  }

 private:
  void go_to(std::uint64_t clock) {
    while (clock_ < clock) {
      if (bus_.idle()) clock_ = clock - 1;
      step();
    }
  }
  // The end of a clock and the beginning of the next.
  void step() {
    const bool writing = bus_.writing();
    if (bus_.end() != nullptr) started_ = clock_;
    if (!writing && bus_.writing()) write_start_ = clock_;
    const std::size_t entries = bus_.entries();
    ++clock_;
    bus_.begin();
    if (bus_.ended() != nullptr) listener_.read_done(done_++, clock_);
    if (bus_.entries() < entries) listener_.written(written_++, write_start_, clock_);
  }

  r3000_bus::ClockedBus bus_;
  std::uint64_t clock_ = 0, started_ = 0, write_start_ = 0, written_ = 0, asked_ = 0, done_ = 0;
};

class MemoryReplay : public trace::ReplayedUnit, public BusSide::Listener {
 public:
  MemoryReplay(const Spec& spec, Level level, Replayer& replayer)
      : spec_(spec), replayer_(replayer), clocked_(level == Level::kClocked) {
    if (clocked_)
      side_ = std::make_unique<ClockedBusSide>(spec, *this);
    else
      side_ = std::make_unique<CycleBus>(spec, *this);
  }

  void before(const Record& record) {
    if (record.at.kind == trace::When::Kind::kRelative) side_->finish_read();
  }
  void take(const Record& record, std::int64_t at) {
    if (record.op == "read" || record.op == "read_uncached")
      read(record, at);
    else if (record.op == "write")
      write(record, at);
    else if (record.op == "holds")
      hold(record);
    else if (record.op == "word")
      replayer_.expect_data(record, standing(word_address(record)), "the word");
    else if (record.op == "counters")
      counters(record, at);
    else
      open_page(record);
    if (record.op != "read" && record.op != "read_uncached" && record.op != "write") replayer_.complete(at);
  }
  void finish() {
    side_->finish();
    replayer_.complete(std::max(replayer_.completed(), last_));
  }

 private:
  /// What is still expected of a read or a store.
  struct Asked {
    Record record;
    std::int64_t at = 0;
    std::string what;
    std::uint32_t address = 0, word = 0, mask = 0;  ///< stores
    bool memory = false, applied = false;
  };

  static std::string named(const Record& record, std::int64_t at) {
    return fmt::format("the {} of 0x{:x} that asked at tick {}", record.op, static_cast<std::uint64_t>(record.value(0)), at);
  }

  void read(const Record& record, std::int64_t at) {
    const bool block = record.op == "read";
    Read read;
    read.address = physical(record);
    read.words = block ? static_cast<unsigned>(replayer_.within(record, "words", record.key("words", 4), 1, kMostBlockWords)) : 1;
    read.instruction = record.key("fetch") != 0;
    read.cached = block;
    read.memory = read.address < spec_.main_bytes;
    if (block && ((read.words & (read.words - 1)) != 0 || read.address % (4 * read.words) != 0 || !read.memory))
      replayer_.fail(record, "a block is 1, 2, 4, 8, 16 or 32 words of main memory, aligned to its size");
    if (!read.memory && record.answer) replayer_.fail(record, "what a device answers is not memory's");
    std::string what = named(record, at);
    reads_.push_back({record, at, what});
    ++reads_asked_;
    const std::uint64_t start = side_->read(read, static_cast<std::uint64_t>(at));
    replayer_.expect_key(record, "start", static_cast<std::int64_t>(start) - at, what + ": clocks until memory begins:");
    if (!read.memory) return;
    replayer_.expect_data(record, words_.at(read.address), what + ": the word");
    for (unsigned i = 1; i < kMostBlockWords; ++i) {
      const std::string key = word_key(i);
      if (!record.expected(key)) continue;
      if (i >= read.words) replayer_.fail(record, fmt::format("the block has no {}", key));
      replayer_.expect_word(record, key.c_str(), words_.at(read.address + 4 * i));
    }
  }

  void write(const Record& record, std::int64_t at) {
    const std::uint32_t address = physical(record);
    const bool memory = address < spec_.main_bytes;
    if (address % 4 != 0) replayer_.fail(record, fmt::format("0x{:x} is no address of a word", address));
    if (memory && record.values.size() < 2) replayer_.fail(record, "`write` to main memory takes the word");
    const auto mask = static_cast<std::uint32_t>(replayer_.within(record, "mask", record.key("mask", ~0u), 0, ~0u));
    const std::int64_t leaves = replayer_.checked(record, at + record.key("leaves"));
    const std::string what = named(record, at);
    writes_.push_back({record, at, what, address, static_cast<std::uint32_t>(record.value(1)), mask, memory});
    const auto free = static_cast<std::int64_t>(
        side_->write(address, memory, static_cast<std::uint64_t>(at), static_cast<std::uint64_t>(leaves)));
    replayer_.expect_tick(record, at, free, what + ": an entry is free");
    replayer_.complete(free);
  }

  void hold(const Record& record) {
    for (std::uint64_t i = 0; i < entered_ - written_; ++i) apply(writes_[i]);
    const std::uint32_t address = word_address(record);
    for (std::size_t i = 1; i < record.values.size(); ++i)
      words_.put(address + static_cast<std::uint32_t>(4 * (i - 1)), static_cast<std::uint32_t>(record.value(i)));
  }

  void counters(const Record& record, std::int64_t at) {
    Counters counters;
    counters.memory = side_->counters(static_cast<std::uint64_t>(at));
    for (const auto& [key, value] : counter_keys(counters, false))
      replayer_.expect_key(record, key, static_cast<std::int64_t>(value), fmt::format("`{}` of clocks up to {}:", key, at));
  }

  void open_page(const Record& record) {
    if (entered_ + reads_asked_ + writes_.size() != 0) replayer_.fail(record, "`set_page` comes before everything else");
    side_->open_page(word_address(record));
  }

  // BusSide::Listener
  void entered(std::uint64_t store) override {
    if (!clocked_) apply(writes_[store - written_]);
    ++entered_;
  }
  void written(std::uint64_t store, std::uint64_t start, std::uint64_t end) override {
    DENDRO_CHECK(store == written_, "store {} after {}", store, written_);
    Asked asked = std::move(writes_.front());
    apply(asked);
    writes_.pop_front();
    ++written_;
    last_ = std::max(last_, static_cast<std::int64_t>(end));
    replayer_.expect_key(asked.record, "start", static_cast<std::int64_t>(start) - asked.at,
                         asked.what + ": clocks until memory begins:");
    replayer_.expect_key(asked.record, "done", static_cast<std::int64_t>(end) - asked.at,
                         asked.what + ": clocks until memory has written it:");
  }
  void read_done(std::uint64_t read, std::uint64_t end) override {
    DENDRO_CHECK(!reads_.empty(), "read {}", read);
    const Asked asked = std::move(reads_.front());
    reads_.pop_front();
    last_ = std::max(last_, static_cast<std::int64_t>(end));
    if (read + 1 == reads_asked_) replayer_.complete(static_cast<std::int64_t>(end));
    replayer_.expect_tick(asked.record, asked.at, static_cast<std::int64_t>(end), asked.what + ": its last word is there");
  }

  void apply(Asked& store) {
    if (store.memory && !store.applied) words_.put(store.address, store.word, store.mask);
    store.applied = true;
  }
  /// With everything that waits in the buffer or before it.
  std::uint32_t standing(std::uint32_t address) const {
    std::uint32_t word = words_.at(address);
    for (const Asked& store : writes_)
      if (store.memory && !store.applied && store.address == address)
        word = (word & ~store.mask) | (store.word & store.mask);
    return word;
  }
  std::uint32_t physical(const Record& record) const {
    return static_cast<std::uint32_t>(replayer_.within(record, "address", record.value(0), 0, ~0u));
  }
  std::uint32_t word_address(const Record& record) const {
    const std::uint32_t address = physical(record);
    if (address % 4 != 0 || address >= spec_.main_bytes)
      replayer_.fail(record, fmt::format("0x{:x} is no address of a word of main memory", address));
    return address;
  }

  Spec spec_;
  Replayer& replayer_;
  bool clocked_;
  std::unique_ptr<BusSide> side_;
  TraceWords words_;
  std::deque<Asked> reads_, writes_;  ///< reads that are not done, stores that memory has not written
  std::uint64_t reads_asked_ = 0, entered_ = 0, written_ = 0;
  std::int64_t last_ = 0;
};

}  // namespace

trace::ReplayResult replay_memory(const Spec& spec, Level level, trace::Reader& trace) {
  return trace::replay_unit<MemoryReplay>(spec, static_cast<std::int64_t>(1e12 / spec.clock_hz), level, trace);
}

}  // namespace dendro::sgi_4d35
