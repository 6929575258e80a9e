#include "models/machines/sgi_4d35/recorder.h"

#include <algorithm>
#include <utility>

#include "models/machines/sgi_4d35/boundaries.h"

namespace dendro::sgi_4d35 {

using trace::decimal;
using trace::hex;
using trace::Record;
using trace::When;

namespace {

std::int64_t between(std::uint64_t from, std::uint64_t to) { return static_cast<std::int64_t>(to - from); }

}  // namespace

RecordedPipeline::RecordedPipeline(const Spec& spec, const Board& board, trace::Writer& out)
    : Pipeline(spec), board_(board), out_(out), memory_boundary_(out.boundary() == kMemoryBoundary) {}

// ---- What the core tells.

bool RecordedPipeline::read(std::uint32_t address) {
  const bool there = Pipeline::read(address);
  if (!watching_) return there;
  access_ = {Access::kLoad, address};
  access_.missed = !there;
  if (!recording() || (of_memory() && there)) return there;
  const unsigned words = of_memory() ? spec_.data_cache.refill_words : 1;
  const std::uint32_t first = of_memory() ? data_.block_of(address) : address & ~3u;
  for (unsigned i = 0; i < words; ++i) {
    learn(first + 4 * i, 0);
    access_.words.push_back(board_.word(first + 4 * i));
  }
  return there;
}

void RecordedPipeline::read_uncached(std::uint32_t address) {
  Pipeline::read_uncached(address);
  if (!watching_) return;
  access_ = {Access::kLoad, address};
  access_.uncached = true;
  if (!recording() || !in_main(address)) return;
  learn(address & ~3u, 0);
  access_.words = {board_.word(address)};
}

void RecordedPipeline::write(std::uint32_t address, unsigned size) {
  const std::uint64_t misses = data_misses_;
  Pipeline::write(address, size);
  if (!watching_) return;
  const bool missed = data_misses_ != misses;
  if (same_ && access_.kind == Access::kStore) {
    access_.size += size;
  } else {
    access_ = {Access::kStore, address, size, size < 4};
    access_.missed = missed;
  }
  access_.mask = bytes_mask(access_.address, access_.size);
  if (recording() && access_.mask != ~0u) learn(address & ~3u, access_.mask);
}

void RecordedPipeline::write_uncached(std::uint32_t address) {
  Pipeline::write_uncached(address);
  if (!watching_) return;
  access_ = {Access::kStore, address & ~3u};
  access_.uncached = true;
}

void RecordedPipeline::isolated_read(bool cached) {
  Pipeline::isolated_read(cached);
  if (watching_ && cached) access_ = {Access::kIsolatedLoad};
}

void RecordedPipeline::isolated_write(std::uint32_t address, unsigned size, bool swapped) {
  Pipeline::isolated_write(address, size, swapped);
  if (!watching_ || (same_ && access_.kind == Access::kIsolatedStore)) return;
  access_ = {Access::kIsolatedStore, address, size, size < 4};
  access_.swapped = swapped;
}

std::uint64_t RecordedPipeline::fetch(std::uint32_t address, std::uint64_t now, bool warm) {
  if (watching_) {
    look_for_end(now);
    look_for_begin(now);
  }
  const std::uint64_t misses = instruction_misses_;
  const std::uint64_t then = Pipeline::fetch(address, now, warm);
  if (recording()) emit_fetch(address, true, instruction_misses_ != misses);
  return then;
}

std::uint64_t RecordedPipeline::fetch_uncached(std::uint32_t address, std::uint64_t now) {
  if (watching_) {
    look_for_end(now);
    look_for_begin(now);
  }
  const std::uint64_t then = Pipeline::fetch_uncached(address, now);
  if (recording()) emit_fetch(address, false, false);
  return then;
}

std::uint64_t RecordedPipeline::memory(std::uint64_t now) {
  if (!watching_ || access_.kind == Access::kNone) return Pipeline::memory(now);
  look_for_end(now);
  take_data(access_);
  const std::uint64_t then = Pipeline::memory(now);
  if (recording()) emit_access(access_, now, then);
  access_.kind = Access::kNone;
  return then;
}

void RecordedPipeline::put_off() {
  Pipeline::put_off();
  if (!watching_) return;
  take_data(access_);
  later_ = access_;
  access_.kind = Access::kNone;
}

std::uint64_t RecordedPipeline::put_off_memory(std::uint64_t now) {
  if (watching_) look_for_end(now);
  const std::uint64_t then = Pipeline::put_off_memory(now);
  if (recording() && later_.kind != Access::kNone) emit_access(later_, now, then);
  later_.kind = Access::kNone;
  return then;
}

void RecordedPipeline::run_clock(std::uint64_t clock) {
  Pipeline::run_clock(clock);
  if (!in_mem_) return;
  const std::uint64_t asked = asked_, told = goes_on_;
  // The clock in which it leaves where nothing is said.
  const bool held_up = !of_memory() && fetched_at_ <= told && fetch_done_ > told;
  const std::uint64_t otherwise = held_up ? fetch_done_ : told;
  for (Pending& pending : pending_) {
    if (!pending.leaves) continue;
    pending.leaves = false;
    if (clock != otherwise) pending.record.keys.emplace_back("leaves", decimal(between(asked, clock)));
  }
  if (in_mem_->kind == Access::kStore && in_main(in_mem_->address))
    words_.put(in_mem_->address & ~3u, in_mem_->word, in_mem_->mask);
  in_mem_.reset();
}

void RecordedPipeline::finish() {
  while (waiting_ != 0) run_clock(bias);
  if (recording()) end(bias);
}

void RecordedPipeline::take_data(Access& access) {
  if (access.kind == Access::kStore && in_main(access.address)) access.word = board_.word(access.address);
}

// ---- The window.

void RecordedPipeline::look_for_begin(std::uint64_t now) {
  if (begun_ || now < static_cast<std::uint64_t>(out_.from()) || !bus_.idle(now)) return;
  if (access_.kind != Access::kNone || later_.kind != Access::kNone || in_mem_ || swap_.kind != Event::kNone) return;
  begun_ = true;
  latest_ = now;
  fetched_at_ = fetch_done_ = now;
  if (now == 0) return;
  base_ = bus_.counters(now - 1);
  write_state(now);
}

void RecordedPipeline::look_for_end(std::uint64_t now) {
  if (now < static_cast<std::uint64_t>(out_.to())) return;
  if (recording())
    end(now - 1);
  else
    ended_ = true, watching_ = false;
}

void RecordedPipeline::write_state(std::uint64_t now) {
  if (const auto page = bus_.open_page()) {
    Record record = record_at(now, "set_page");
    record.values = {hex(*page)};
    out_.add(record);
  }
  if (of_memory()) return;
  write_tags(true);
  write_tags(false);
}

/// One record for each run of words that follow one another.
void RecordedPipeline::write_tags(bool instruction) {
  const r3000_cache::Tags& tags = instruction ? instruction_ : data_;
  for (std::uint32_t i = 0, next; i < tags.words(); i = next) {
    next = i + 1;
    const auto first = tags.held(i);
    if (!first) continue;
    for (; next < tags.words() && tags.held(next) == *first + 4 * (next - i); ++next) {
    }
    Record record = record_at(latest_, instruction ? "set_instruction" : "set_data");
    record.values = {hex(*first)};
    if (next - i > 1) record.keys = {{"count", decimal(next - i)}};
    out_.add(record);
  }
}

/// The last clock of the window is over.
void RecordedPipeline::end(std::uint64_t last) {
  for (Pending& pending : pending_)
    if (pending.leaves) {
      pending.leaves = false;
      pending.record.keys.emplace_back("leaves", decimal(between(asked_, std::max(last + 1, goes_on_))));
    }
  flush(last + 1);
  for (Pending& pending : pending_) out_.add(pending.record);  // memory comes to them later
  pending_.clear();
  write_counters(last);
  ended_ = true;
  watching_ = false;
}

void RecordedPipeline::write_counters(std::uint64_t last) {
  Counters counters = counts_;
  const r3000_bus::Counters now = bus_.counters(last);
  counters.memory = {now.busy - base_.busy,     now.reads - base_.reads,
                     now.read_words - base_.read_words, now.writes - base_.writes,
                     now.page_writes - base_.page_writes, now.overtaken - base_.overtaken};
  Record record = record_at(last, "counters");
  for (const auto& [key, value] : counter_keys(counters, !of_memory()))
    record.answer_keys.emplace_back(key, decimal(static_cast<std::int64_t>(value)));
  out_.add(record);
}

// ---- What memory holds.

/// The trace knows the word from here on. `own_mask`: bits that are about to be written, or have been.
void RecordedPipeline::learn(std::uint32_t address, std::uint32_t own_mask) {
  const std::uint32_t word = board_.word(address);
  if (words_.known(address)) {
    std::uint32_t expected = words_.at(address), written = own_mask;
    for (const Access* store : {in_mem_ ? &*in_mem_ : nullptr, &later_, &access_}) {
      if (store == nullptr || store->kind != Access::kStore || (store->address & ~3u) != address) continue;
      if (store != &access_) expected = (expected & ~store->mask) | (store->word & store->mask);
      written |= store == &access_ ? store->mask : 0;
    }
    if (((expected ^ word) & ~written) == 0) return;
    // A device has been there.
    words_.put(address, (words_.at(address) & written) | (word & ~written));
  } else {
    words_.put(address, word);
  }
  if (!tell_.empty() && (address != telling_ + 4 * tell_.size() || tell_.size() == kMostBlockWords)) tell_words();
  if (tell_.empty()) telling_ = address;
  tell_.push_back(words_.at(address));
}

void RecordedPipeline::tell_words() {
  if (tell_.empty()) return;
  Pending pending{record_at(latest_, "holds"), false, std::nullopt};
  pending.record.values = {hex(telling_)};
  for (const std::uint32_t word : tell_) pending.record.values.push_back(hex(word));
  tell_.clear();
  pending_.push_back(std::move(pending));
}

std::vector<std::uint32_t> RecordedPipeline::seen(std::uint32_t address, unsigned words) const {
  std::vector<std::uint32_t> data;
  for (unsigned i = 0; i < words; ++i) data.push_back(words_.at(address + 4 * i));
  return data;
}

// ---- Records.

Record RecordedPipeline::record_at(std::uint64_t clock, const char* op) {
  Record record;
  record.at = When::at(static_cast<std::int64_t>(clock));
  record.op = op;
  return record;
}

void RecordedPipeline::add(Pending pending) {
  tell_words();
  latest_ = static_cast<std::uint64_t>(pending.record.at.ticks);
  pending_.push_back(std::move(pending));
}

/// Writes what is known for good: in clock `now` and later no read has asked yet.
void RecordedPipeline::flush(std::uint64_t now) {
  for (; !pending_.empty(); pending_.pop_front()) {
    Pending& first = pending_.front();
    if (first.leaves) return;
    if (first.store) {
      const r3000_bus::Bus::Write write = bus_.write(*first.store);
      if (write.start >= now) return;
      const auto at = static_cast<std::uint64_t>(first.record.at.ticks);
      first.record.answer_keys.emplace_back("start", decimal(between(at, write.start)));
      first.record.answer_keys.emplace_back("done", decimal(between(at, write.end)));
    }
    out_.add(first.record);
  }
}

void RecordedPipeline::emit_read(std::uint32_t address, unsigned words, bool fetch, bool cached, std::uint64_t now,
                                 const std::vector<std::uint32_t>& data) {
  Record record = record_at(now, cached ? "read" : "read_uncached");
  record.values = {hex(address)};
  if (cached) record.keys.emplace_back("words", decimal(words));
  if (fetch) record.keys.emplace_back("fetch", decimal(1));
  record.answer_at = When::after(between(now, bus_.read_end()));
  record.answer_keys.emplace_back("start", decimal(between(now, bus_.read_start())));
  for (unsigned i = 0; i < data.size(); ++i) {
    if (i == 0)
      record.answer = hex(data[0]);
    else
      record.answer_keys.emplace_back(word_key(i), hex(data[i]));
  }
  add({std::move(record), false, std::nullopt});
}

void RecordedPipeline::emit_fetch(std::uint32_t address, bool cached, bool missed) {
  flush(looks_[0].now);
  fetched_at_ = looks_[0].now;
  fetch_done_ = looks_[0].there;
  if (of_memory()) {
    if (cached && !missed) return;
    const unsigned words = cached ? spec_.instruction_cache.refill_words : 1;
    const std::uint32_t first = cached ? instruction_.block_of(address) : address;
    if (in_main(first))
      for (unsigned i = 0; i < words; ++i) learn(first + 4 * i, 0);
    emit_read(first, words, true, cached, looks_[0].now,
              in_main(first) ? seen(first, words) : std::vector<std::uint32_t>());
    return;
  }
  counts_.instruction_accesses += cached;
  counts_.instruction_misses += missed;
  if (in_main(address)) learn(address, 0);
  for (unsigned i = 0; i < looked_; ++i) {
    Record record = record_at(looks_[i].now, i == 0 ? "fetch" : "fetch_again");
    if (i == 0) {
      record.values = {hex(address)};
      if (!cached) record.keys.emplace_back("uncached", decimal(1));
      if (in_main(address)) record.answer = hex(words_.at(address));
      if (missed) record.answer_keys.emplace_back("miss", decimal(1));
    }
    record.answer_at = When::after(between(looks_[i].now, looks_[i].there));
    add({std::move(record), false, std::nullopt});
  }
}

void RecordedPipeline::emit_access(const Access& access, std::uint64_t now, std::uint64_t then) {
  flush(now);
  if (access.kind == Access::kStore || access.kind == Access::kIsolatedStore) {
    emit_store(access, now, then);
    return;
  }
  if (of_memory()) {
    if (access.kind == Access::kLoad && (access.missed || access.uncached)) emit_data_read(access, now);
    return;
  }
  counts_.data_accesses += !access.uncached;
  counts_.data_misses += access.missed;
  Record record = record_at(now, access.kind == Access::kLoad ? "load" : "isolated_load");
  if (access.kind == Access::kLoad) {
    record.values = {hex(access.address)};
    if (access.uncached) record.keys.emplace_back("uncached", decimal(1));
    record.answer_at = When::after(between(now, then));
    if (!access.words.empty()) record.answer = hex(access.words[0]);
    if (access.missed) record.answer_keys.emplace_back("miss", decimal(1));
  }
  add({std::move(record), false, std::nullopt});
}

void RecordedPipeline::emit_data_read(const Access& access, std::uint64_t now) {
  const bool cached = !access.uncached;
  emit_read(cached ? data_.block_of(access.address) : access.address & ~3u,
            cached ? spec_.data_cache.refill_words : 1, false, cached, now, access.words);
}

void RecordedPipeline::emit_store(const Access& access, std::uint64_t now, std::uint64_t then) {
  const bool isolated = access.kind == Access::kIsolatedStore;
  const bool waits = access.partial && !access.uncached && spec_.data_cache.store_partial;
  asked_ = of_memory() && waits ? now + spec_.data_cache.partial_store_cycles : now;
  goes_on_ = then;
  in_mem_ = access;
  if (of_memory() && isolated) return;
  Pending pending{record_at(asked_, of_memory() ? "write" : isolated ? "isolated_store" : "store"), true, std::nullopt};
  Record& record = pending.record;
  record.values = {hex(of_memory() ? access.address & ~3u : access.address)};
  if (!isolated && in_main(access.address)) {
    const unsigned down = of_memory() ? 0 : 8 * (4 - (access.address & 3) - access.size);
    record.values.push_back(hex((access.word & access.mask) >> down));
  }
  if (of_memory()) {
    if (access.mask != ~0u) record.keys.emplace_back("mask", hex(access.mask));
    pending.store = bus_.stores() - 1;
  } else {
    counts_.data_accesses += !access.uncached;
    counts_.data_misses += access.missed;
    if (access.size != 4) record.keys.emplace_back("size", decimal(access.size));
    if (access.size == 4 && access.partial) record.keys.emplace_back("partial", decimal(1));
    if (access.uncached) record.keys.emplace_back("uncached", decimal(1));
    if (access.swapped) record.keys.emplace_back("swapped", decimal(1));
    if (access.missed) record.answer_keys.emplace_back("miss", decimal(1));
  }
  if (!isolated) record.answer_at = When::after(between(asked_, then));
  add(std::move(pending));
}

}  // namespace dendro::sgi_4d35
