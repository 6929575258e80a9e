#include <algorithm>
#include <string>

#include "models/machines/sgi_4d35/boundaries.h"
#include "models/machines/sgi_4d35/memory_side.h"
#include "models/machines/sgi_4d35/trace_words.h"
#include "sim/trace/replay_unit.h"

namespace dendro::sgi_4d35 {
namespace {

using trace::Record;
using trace::Replayer;

class ProcessorReplay : public trace::ReplayedUnit {
 public:
  ProcessorReplay(const Spec& spec, Level level, Replayer& replayer)
      : spec_(spec), replayer_(replayer), side_(make_memory_side(spec, level)) {}

  void take(const Record& record, std::int64_t at) {
    if (record.op == "fetch")
      fetch(record, at);
    else if (record.op == "fetch_again")
      told(record, at, side_->fetch_again(clock(at)), "the last fetch, looked at again at tick " + std::to_string(at));
    else if (record.op == "load")
      load(record, at);
    else if (record.op == "store")
      store(record, at);
    else if (record.op == "isolated_load")
      replayer_.complete(static_cast<std::int64_t>(side_->isolated_load(clock(at)).clock));
    else if (record.op == "isolated_store")
      isolated_store(record, at);
    else if (record.op == "counters")
      counters(record, at);
    else
      state(record, at);
  }

 private:
  static std::uint64_t clock(std::int64_t at) { return static_cast<std::uint64_t>(at); }

  void fetch(const Record& record, std::int64_t at) {
    moving_ = true;
    const MemorySide::Place place = word_place(record);
    const std::uint64_t leaves = side_->leaves();
    const MemorySide::Told answer = side_->fetch(place, clock(at));
    if (answer.looked > leaves) enter_store();
    told(record, at, answer, what(record, at));
    expect_word(record, place);
  }

  void load(const Record& record, std::int64_t at) {
    moving_ = true;
    const MemorySide::Place place = place_of(record);
    const MemorySide::Told answer = side_->load(place, clock(at));
    enter_store();
    told(record, at, answer, what(record, at));
    expect_word(record, place);
  }

  void store(const Record& record, std::int64_t at) {
    moving_ = true;
    const MemorySide::Place place = place_of(record);
    const unsigned size = size_of(record, place.address);
    if (place.memory && record.values.size() < 2) replayer_.fail(record, "`store` to main memory takes its data");
    const MemorySide::Told answer =
        side_->store(place, is_partial(record, size), clock(at), clock(leaves(record, at)));
    enter_store();
    const std::uint32_t mask = bytes_mask(place.address, size);
    in_mem_ = place.memory;
    address_ = place.address & ~3u;
    mask_ = mask;
    word_ = static_cast<std::uint32_t>(record.value(1)) << 8 * (4 - (place.address & 3) - size);
    told(record, at, answer, what(record, at));
  }

  void isolated_store(const Record& record, std::int64_t at) {
    moving_ = true;
    const MemorySide::Place place = place_of(record);
    if (!place.cached) replayer_.fail(record, "an isolated store is to main memory");
    const unsigned size = size_of(record, place.address);
    const MemorySide::Told answer = side_->isolated_store(place.address, is_partial(record, size), record.key("swapped") != 0,
                                                          clock(at), clock(leaves(record, at)));
    enter_store();
    replayer_.complete(static_cast<std::int64_t>(answer.clock));
  }

  void counters(const Record& record, std::int64_t at) {
    for (const auto& [key, value] : counter_keys(side_->counters(clock(at)), true))
      replayer_.expect_key(record, key, static_cast<std::int64_t>(value), fmt::format("`{}` of clocks up to {}:", key, at));
    replayer_.complete(at);
  }

  void state(const Record& record, std::int64_t at) {
    const MemorySide::Place place = word_place(record);
    if (!place.memory) replayer_.fail(record, fmt::format("0x{:x} is no address of main memory", place.address));
    if (record.op == "holds") {
      enter_store();
      for (std::size_t i = 1; i < record.values.size(); ++i)
        words_.put(place.address + static_cast<std::uint32_t>(4 * (i - 1)), static_cast<std::uint32_t>(record.value(i)));
    } else if (record.op == "word") {
      enter_store();
      replayer_.expect_data(record, words_.at(place.address), "the word");
    } else {
      set(record, place.address);
    }
    replayer_.complete(at);
  }

  void set(const Record& record, std::uint32_t address) {
    if (moving_) replayer_.fail(record, fmt::format("`{}` comes before everything else", record.op));
    if (record.op == "set_page") {
      side_->open_page(address);
      return;
    }
    const std::int64_t room = (std::int64_t{spec_.main_bytes} - address) / 4;
    const std::int64_t count = replayer_.within(record, "count", record.key("count", 1), 1, room);
    for (std::uint32_t i = 0; i < count; ++i) side_->hold(record.op == "set_instruction", address + 4 * i);
  }

  void told(const Record& record, std::int64_t at, const MemorySide::Told& answer, const std::string& what) {
    const auto then = static_cast<std::int64_t>(answer.clock);
    replayer_.complete(then);
    replayer_.expect_key(record, "miss", answer.miss, what + ": a miss:");
    replayer_.expect_tick(record, at, then, what + ": goes on");
  }

  void expect_word(const Record& record, const MemorySide::Place& place) {
    if (!place.memory && record.answer) replayer_.fail(record, "what a device answers is not known here");
    replayer_.expect_data(record, words_.at(place.address & ~3u), fmt::format("the word at 0x{:x}", place.address & ~3u));
  }

  // A store's data is in memory for whoever looks behind the clock in which it leaves MEM.
  void enter_store() {
    if (in_mem_) words_.put(address_, word_, mask_);
    in_mem_ = false;
  }

  static std::string what(const Record& record, std::int64_t at) {
    return fmt::format("the {} of 0x{:x}, looked at at tick {}", record.op, static_cast<std::uint64_t>(record.value(0)), at);
  }
  std::int64_t leaves(const Record& record, std::int64_t at) const {
    return replayer_.checked(record, at + replayer_.within(record, "leaves", record.key("leaves"), 0, INT64_MAX / 8));
  }
  unsigned size_of(const Record& record, std::uint32_t address) const {
    return static_cast<unsigned>(replayer_.within(record, "size", record.key("size", 4), 1, 4 - (address & 3)));
  }
  static bool is_partial(const Record& record, unsigned size) { return size < 4 || record.key("partial") != 0; }
  MemorySide::Place place_of(const Record& record) const {
    const auto address = static_cast<std::uint32_t>(replayer_.within(record, "address", record.value(0), 0, ~0u));
    const bool memory = address < spec_.main_bytes;
    return {address, memory && record.key("uncached") == 0, memory};
  }
  MemorySide::Place word_place(const Record& record) const {
    const MemorySide::Place place = place_of(record);
    if (place.address % 4 != 0) replayer_.fail(record, fmt::format("0x{:x} is no address of a word", place.address));
    return place;
  }

  Spec spec_;
  Replayer& replayer_;
  std::unique_ptr<MemorySide> side_;
  TraceWords words_;
  bool moving_ = false;
  bool in_mem_ = false;  ///< a store of main memory has not left MEM
  std::uint32_t address_ = 0, word_ = 0, mask_ = 0;
};

}  // namespace

trace::ReplayResult replay_processor(const Spec& spec, Level level, trace::Reader& trace) {
  return trace::replay_unit<ProcessorReplay>(spec, static_cast<std::int64_t>(1e12 / spec.clock_hz), level, trace);
}

}  // namespace dendro::sgi_4d35
