#include "models/machines/sgi_4d35/memory_side.h"

#include <algorithm>

#include "models/machines/sgi_4d35/clocked_caches.h"
#include "models/machines/sgi_4d35/pipeline.h"

namespace dendro::sgi_4d35 {

/// MEM looks in a clock of its own, behind that in which the one before left it.
std::uint64_t MemorySide::turn_of_mem(std::uint64_t at) {
  std::uint64_t now = std::max(at, next_mem_);
  if (in_mem_) {
    now = std::max(now, leaves_ + 1);
    in_mem_ = false;
    do_leave(leaving_);
  }
  return now;
}

/// IF may look in the clock in which a store leaves MEM.
std::uint64_t MemorySide::turn_of_fetch(std::uint64_t at) {
  const std::uint64_t now = std::max(at, next_fetch_);
  if (in_mem_ && leaves_ < now) {
    in_mem_ = false;
    do_leave(leaving_);
  }
  return now;
}

MemorySide::Told MemorySide::mem_went_on(const Told& told) {
  next_mem_ = told.clock + 1;
  next_fetch_ = std::max(next_fetch_, told.clock);
  return told;
}

MemorySide::Told MemorySide::fetch_went_on(const Told& told) {
  hold_up(told.clock);
  next_mem_ = std::max(next_mem_, told.clock + 1);
  next_fetch_ = std::max(next_fetch_, told.clock + 1);
  return told;
}

MemorySide::Told MemorySide::fetch(const Place& place, std::uint64_t at) {
  return fetch_went_on(do_fetch(place, turn_of_fetch(at)));
}

MemorySide::Told MemorySide::fetch_again(std::uint64_t at) { return fetch_went_on(do_fetch_again(turn_of_fetch(at))); }

MemorySide::Told MemorySide::load(const Place& place, std::uint64_t at) {
  return mem_went_on(do_load(place, turn_of_mem(at)));
}

MemorySide::Told MemorySide::put(const Leaving& store, std::uint64_t at, std::uint64_t leaves) {
  const std::uint64_t now = turn_of_mem(at);
  const Told told = store.kind == Leaving::kStore ? do_store(store, now) : Told{now, now, false};
  in_mem_ = true;
  leaving_ = store;
  leaves_ = std::max(told.clock, leaves);
  return mem_went_on(told);
}

MemorySide::Told MemorySide::store(const Place& place, bool partial, std::uint64_t at, std::uint64_t leaves) {
  return put({Leaving::kStore, place, partial, false}, at, leaves);
}

MemorySide::Told MemorySide::isolated_load(std::uint64_t at) {
  const std::uint64_t now = turn_of_mem(at);
  do_isolated_load();
  return mem_went_on({now, now, false});
}

MemorySide::Told MemorySide::isolated_store(std::uint32_t address, bool partial, bool swapped, std::uint64_t at,
                                            std::uint64_t leaves) {
  do_isolated_load();
  return put({Leaving::kIsolated, {address, true, true}, partial, swapped}, at, leaves);
}

Counters MemorySide::counters(std::uint64_t last) {
  turn_of_fetch(last + 1);
  next_mem_ = std::max(next_mem_, last + 1);
  next_fetch_ = std::max(next_fetch_, last + 1);
  return counters_at(last);
}

namespace {

/// The caches and the bus of level `cycle`, which are its Pipeline's.
class CycleSide : public MemorySide, private Pipeline {
 public:
  explicit CycleSide(const Spec& spec) : Pipeline(spec) {}

  void open_page(std::uint32_t address) override { bus_.open_page(address); }
  void hold(bool instruction, std::uint32_t address) override {
    (instruction ? instruction_ : data_).store_word(address);
  }

 protected:
  Told do_fetch(const Place& place, std::uint64_t now) override {
    stand(now);
    fetched_ = place.address;
    const std::uint64_t misses = instruction_misses_;
    const std::uint64_t then =
        place.cached ? Pipeline::fetch(place.address, now, false) : fetch_uncached(place.address, now);
    return {now, then, instruction_misses_ != misses};
  }
  Told do_fetch_again(std::uint64_t now) override {
    stand(now);
    const std::uint64_t then = streaming(now) ? streamed(fetched_, now) : now;
    bus_.delay_newest(now, then);
    return {now, then, false};
  }
  Told do_load(const Place& place, std::uint64_t now) override {
    const std::uint64_t misses = data_misses_;
    if (place.cached)
      read(place.address);
    else
      read_uncached(place.address);
    return {now, memory(now), data_misses_ != misses};
  }
  Told do_store(const Leaving& store, std::uint64_t now) override {
    const std::uint64_t misses = data_misses_;
    if (store.place.cached)
      write(store.place.address, store.partial ? 1 : 4);
    else
      write_uncached(store.place.address);
    const std::uint64_t then = memory(now);
    standing_ = true;
    return {now, then, data_misses_ != misses};
  }
  void do_isolated_load() override { isolated_read(true); }
  void do_leave(const Leaving& store) override {
    if (store.kind == Leaving::kStore) {
      move(leaves());
      standing_ = false;
      return;
    }
    isolated_write(store.place.address, store.partial ? 1 : 4, store.swapped);
    --data_accesses_;  // counted when MEM looked at it
    memory(leaves());
    run_clock(leaves());
  }
  Counters counters_at(std::uint64_t last) override {
    stand(last + 1);
    return Pipeline::counters(0, last);
  }

 private:
  // A store that does not leave before IF looks in clock `now` stands in that clock, as in a machine that does not know
  // yet what holds it up.
  void stand(std::uint64_t now) {
    if (standing_) move(now);
  }
  void move(std::uint64_t clock) {
    bus_.delay_newest(bus_.write(bus_.stores() - 1).enter, clock);
  }
  std::uint32_t fetched_ = 0;
  bool standing_ = false;  ///< the newest store of the bus has not left MEM
};

class ClockedSide : public MemorySide {
 public:
  explicit ClockedSide(const Spec& spec)
      : partial_cycles_(spec.data_cache.store_partial ? spec.data_cache.partial_store_cycles : 0), caches_(spec) {}

  void open_page(std::uint32_t address) override { caches_.open_page(address); }
  void hold(bool instruction, std::uint32_t address) override { caches_.tags(instruction).validate(address); }

 protected:
  Told do_fetch(const Place& place, std::uint64_t now) override {
    go_to(now);
    const bool miss = caches_.fetch(place.address, place.cached, place.memory);
    return {now, wait_for_fetch(), miss};
  }
  Told do_fetch_again(std::uint64_t now) override {
    go_to(now);
    return {now, wait_for_fetch(), false};
  }
  Told do_load(const Place& place, std::uint64_t now) override {
    go_to(now);
    if (place.cached) caches_.count_data();
    const bool miss = caches_.load(place.address, place.cached, place.memory);
    while (!caches_.loaded()) step();
    return {now, clock_, miss};
  }
  Told do_store(const Leaving& store, std::uint64_t now) override {
    go_to(now);
    bool miss = false;
    if (store.place.cached) {
      caches_.count_data();
      miss = caches_.look_up_store(store.place.address);
      for (unsigned i = 0; store.partial && i < partial_cycles_; ++i) step();
    }
    while (!caches_.entry_free()) step();
    return {now, clock_, miss};
  }
  void do_isolated_load() override { caches_.count_data(); }
  void do_leave(const Leaving& store) override {
    go_to(leaves());
    if (store.kind == Leaving::kStore)
      caches_.store(store.place.address, store.partial, store.place.cached, store.place.memory);
    else
      caches_.isolated_store(store.place.address, store.partial, store.swapped);
  }
  Counters counters_at(std::uint64_t last) override {
    go_to(last + 1);
    return caches_.counters();
  }

 private:
  std::uint64_t wait_for_fetch() {
    while (!caches_.fetched()) step();
    return clock_;
  }
  void go_to(std::uint64_t clock) {
    while (clock_ < clock) {
      if (caches_.bus().idle()) clock_ = clock - 1;
      step();
    }
  }
  // The end of a clock and the beginning of the next.
  void step() {
    caches_.end();
    ++clock_;
    caches_.begin();
  }

  unsigned partial_cycles_;
  ClockedCaches caches_;
  std::uint64_t clock_ = 0;
};

}  // namespace

std::unique_ptr<MemorySide> make_memory_side(const Spec& spec, Level level) {
  if (level == Level::kClocked) return std::make_unique<ClockedSide>(spec);
  return std::make_unique<CycleSide>(spec);
}

}  // namespace dendro::sgi_4d35
