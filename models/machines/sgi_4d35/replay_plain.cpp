#include <fmt/format.h>

#include <algorithm>

#include "models/machines/sgi_4d35/boundaries.h"
#include "models/machines/sgi_4d35/memory_side.h"
#include "sim/trace/plain_trace.h"

namespace dendro::sgi_4d35 {
namespace {

using trace::PlainAccess;

/// A processor that asks when the trace says, later by all clocks that it has waited.
class PlainDriver {
 public:
  PlainDriver(const Spec& spec, Level level) : spec_(spec), side_(make_memory_side(spec, level)) {}

  void take(const PlainAccess& access) {
    if (accesses_++ == 0) first_ = access.time;
    const std::uint64_t at = access.time - first_ + stalls_;
    wrapped_ += access.address >= spec_.main_bytes;
    const MemorySide::Place place{static_cast<std::uint32_t>(access.address % spec_.main_bytes), true, true};
    if (access.kind == PlainAccess::kFetch)
      went_on(side_->fetch({place.address & ~3u, true, true}, at), stall_instruction_miss_);
    else if (access.kind == PlainAccess::kRead)
      went_on(side_->load(place, at), stall_data_miss_);
    else
      store(place, access.size < 4, at);
  }

  PlainReplay result() {
    counters_ = side_->counters(last_);
    PlainReplay replay;
    replay.accesses = static_cast<std::int64_t>(accesses_);
    replay.cycles = static_cast<std::int64_t>(last_ + 1);
    counters_.cycles = last_ + 1;
    replay.units = units_of(counters_, {});
    replay.units[0].values = {{"cycles", counters_.cycles},
                              {"busy", busy_},
                              {"stall_instruction_miss", stall_instruction_miss_},
                              {"stall_data_miss", stall_data_miss_},
                              {"stall_partial_store", stall_partial_store_},
                              {"stall_write_buffer", stall_write_buffer_},
                              {"idle", counters_.cycles - busy_ - stalls_},
                              {"beyond_main_memory", wrapped_}};
    replay.summary = summary();
    return replay;
  }

 private:
  void went_on(const MemorySide::Told& told, std::uint64_t& cause) {
    cause += told.clock - told.looked;
    stalls_ += told.clock - told.looked;
    busy_ += accesses_ == 1 || told.clock != last_;
    last_ = told.clock;
  }

  void store(const MemorySide::Place& place, bool partial, std::uint64_t at) {
    MemorySide::Told told = side_->store(place, partial, at, 0);
    const std::uint64_t merging =
        partial && spec_.data_cache.store_partial ? std::uint64_t{spec_.data_cache.partial_store_cycles} : 0;
    stall_partial_store_ += merging;
    stalls_ += merging;
    told.looked += merging;
    went_on(told, stall_write_buffer_);
  }

  std::vector<std::string> summary() const {
    const auto share = [](std::uint64_t part, std::uint64_t whole) {
      return whole == 0 ? 0.0 : 100 * static_cast<double>(part) / static_cast<double>(whole);
    };
    const auto cache = [&share](const char* name, std::uint64_t accesses, std::uint64_t misses) {
      return fmt::format("{}: {} accesses, {} hits, {} misses ({:.2f}%)", name, accesses, accesses - misses, misses,
                         share(misses, accesses));
    };
    const r3000_bus::Counters& m = counters_.memory;
    std::vector<std::string> lines = {
        cache("instruction cache", counters_.instruction_accesses, counters_.instruction_misses),
        cache("data cache", counters_.data_accesses, counters_.data_misses),
        fmt::format("stall clocks: {} ({:.2f}%): instruction misses {}, data misses {}, partial stores {}, write buffer {}",
                    stalls_, share(stalls_, counters_.cycles), stall_instruction_miss_, stall_data_miss_,
                    stall_partial_store_, stall_write_buffer_),
        fmt::format("memory: busy {:.2f}%: {} reads of {} words, {} writes, {} of them in the open page",
                    share(m.busy, counters_.cycles), m.reads, m.read_words, m.writes, m.page_writes)};
    if (wrapped_ != 0)
      lines.push_back(fmt::format("{} addresses beyond main memory, taken modulo its {} bytes", wrapped_, spec_.main_bytes));
    return lines;
  }

  Spec spec_;
  std::unique_ptr<MemorySide> side_;
  Counters counters_;
  std::uint64_t first_ = 0, last_ = 0, accesses_ = 0, wrapped_ = 0, busy_ = 0, stalls_ = 0;
  std::uint64_t stall_instruction_miss_ = 0, stall_data_miss_ = 0, stall_partial_store_ = 0, stall_write_buffer_ = 0;
};

}  // namespace

PlainReplay replay_plain(const Spec& spec, Level level, trace::PlainReader& trace) {
  PlainDriver driver(spec, level);
  PlainAccess access;
  while (trace.next(access)) driver.take(access);
  return driver.result();
}

}  // namespace dendro::sgi_4d35
