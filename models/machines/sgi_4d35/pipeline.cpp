#include "models/machines/sgi_4d35/pipeline.h"

#include <algorithm>

namespace dendro::sgi_4d35 {

Pipeline::Pipeline(const Spec& spec)
    : spec_(spec),
      fpu_timing_(spec.fpu),
      instruction_(spec.instruction_cache),
      data_(spec.data_cache),
      bus_(spec.bus, spec.main_bytes),
      fpu_(spec.fpu) {}

void Pipeline::miss(std::uint32_t address) {
  ++data_misses_;
  data_.fill(address);
  event_ = {Event::kBlockRead, address};
}

void Pipeline::write_part(std::uint32_t address) {
  if (!same_access_) {
    ++data_accesses_;
    data_misses_ += !data_.hit(address);
  }
  data_.store_part(address);
  event_ = {spec_.data_cache.store_partial ? Event::kPartialStore : Event::kStore, address & ~3u};
}

void Pipeline::isolated_write(std::uint32_t address, unsigned size, bool swapped) {
  data_accesses_ += !same_access_;
  if (swapped)
    event_ = {Event::kSwapped, address, size == 4};
  else if (size == 4)
    data_.store_word(address);
  else
    data_.invalidate(address);
}

/// IF looks at a word in clock `now` and would go on in `look(now)`. What stands in ALU issues only in the run clock:
/// where another unit rounds in between, ALU holds up IF, which then may miss the clock of its word.
template <class Look>
std::uint64_t Pipeline::wait_in_fetch(std::uint64_t now, const Look& look) {
  std::uint64_t then = look(now);
  if (then == now) return now;
  if (in_alu_.issue != nullptr && in_alu_.clock == now) {
    for (then = now;; ++then) {
      if (fpu_.when_still(*in_alu_.issue, then) != then)
        ++stall_fp_;
      else if (look(then) != then)
        ++stall_instruction_miss_;
      else
        break;
    }
    in_alu_.clock = then;
    if (in_alu_.good) fpu_.issue(*in_alu_.issue, then);
  } else {
    stall_instruction_miss_ += then - now;
  }
  if (multiplier_start_ == now && now != 0) {
    multiplier_start_ += then - now;
    multiplier_free_ += then - now;
  }
  bus_.delay_newest(now, then);
  return then;
}

std::uint64_t Pipeline::fetch(std::uint32_t address, std::uint64_t now, bool warm) {
  ++instruction_accesses_;
  const std::uint32_t block = instruction_.block_of(address);
  std::uint64_t end = 0;  // of a read without streaming
  if (!instruction_.hit(address)) {
    ++instruction_misses_;
    instruction_.fill(address);
    ++fetch_generation_;
    if (warm) return now;
    const unsigned words = spec_.instruction_cache.refill_words;
    const std::uint64_t start = bus_.read_block(block, words, now);
    end = start + spec_.bus.first_word_cycles + std::uint64_t{words} * spec_.bus.word_cycles;
    if (spec_.instruction_cache.streaming) {
      stream_block_ = block;
      stream_start_ = start;
      stream_end_ = end;
      end = 0;
    }
  }
  return wait_in_fetch(now, [&](std::uint64_t clock) {
    if (!streaming(clock)) return std::max(clock, end);
    const std::uint64_t there = stream_start_ + spec_.bus.first_word_cycles +
                                std::uint64_t{(address - block) / 4 + 1} * spec_.bus.word_cycles;
    return block == stream_block_ && clock <= there ? there : stream_end_;
  });
}

std::uint64_t Pipeline::fetch_uncached(std::uint32_t address, std::uint64_t now) {
  const std::uint64_t end =
      bus_.read_uncached(address, now) + spec_.bus.first_word_cycles + spec_.bus.word_cycles;
  return wait_in_fetch(now, [end](std::uint64_t clock) { return std::max(clock, end); });
}

std::uint64_t Pipeline::memory_slowly(std::uint64_t now) {
  const Event event = event_;
  event_.kind = Event::kNone;
  switch (event.kind) {
    case Event::kPartialStore:
      stall_partial_store_ += spec_.data_cache.partial_store_cycles;
      event_ = {Event::kStore, event.address};
      return memory(now + spec_.data_cache.partial_store_cycles);
    case Event::kBlockRead: {
      const unsigned words = spec_.data_cache.refill_words;
      const std::uint64_t then = bus_.read_block(data_.block_of(event.address), words, now) +
                                 spec_.bus.first_word_cycles + std::uint64_t{words} * spec_.bus.word_cycles;
      stall_data_miss_ += then - now;
      return then;
    }
    case Event::kUncachedRead: {
      const std::uint64_t then = bus_.read_uncached(event.address, now) + spec_.bus.first_word_cycles +
                                 spec_.bus.word_cycles;
      stall_uncached_ += then - now;
      return then;
    }
    default:
      swap_ = event;
      return now;
  }
}

std::uint64_t Pipeline::put_off_memory(std::uint64_t now) {
  const Event event = event_;
  event_ = put_off_;
  const std::uint64_t then = memory(now);
  event_ = event;
  return then;
}

void Pipeline::in_memory(std::uint32_t pc, bool killed, bool refill, bool rfe) {
  waits_[waiting_++] = {{0, pc, killed}, true, refill, rfe};
  notes_ += refill || rfe;
}

void Pipeline::in_no_memory() { waits_[waiting_++] = {}; }

/// The run clock in which the oldest word that waits leaves MEM.
void Pipeline::run_clock(std::uint64_t clock) {
  if (swap_.kind == Event::kSwapped) {
    swap_.kind = Event::kNone;
    ++fetch_generation_;
    if (swap_.valid)
      instruction_.store_word(swap_.address);
    else
      instruction_.invalidate(swap_.address);
  }
  if (waiting_ == 0) return;
  Waiting oldest = waits_[0];
  std::copy(waits_ + 1, waits_ + waiting_, waits_);
  --waiting_;
  if (!oldest.listed) return;
  notes_ -= oldest.refill || oldest.rfe;
  if (oldest.refill && !refilling_) {
    refilling_ = true;
    refill_start_ = clock;
  } else if (oldest.rfe && refilling_) {
    refilling_ = false;
    tlb_refill_cycles_ += clock - refill_start_ + 1;
  }
  if (listener_ == nullptr) return;
  oldest.word.clock = clock;
  listener_->left_memory(oldest.word, left_memory_);
  left_memory_ = clock + 1;
}

void Pipeline::finish() {
  while (waiting_ != 0) run_clock(bias);
}

Counters Pipeline::counters(std::uint64_t words, std::uint64_t last) const {
  Counters c;
  c.cycles = last + 1;
  c.busy = words;
  c.nops = nops_;
  c.tlb_refill_cycles = tlb_refill_cycles_;
  c.stall_exception = stall_exception_;
  c.stall_fp = stall_fp_;
  c.stall_multiply_divide = stall_multiply_divide_;
  c.stall_instruction_miss = stall_instruction_miss_;
  c.stall_data_miss = stall_data_miss_;
  c.stall_uncached = stall_uncached_;
  c.stall_partial_store = stall_partial_store_;
  c.stall_write_buffer = stall_write_buffer_;
  c.instruction_accesses = instruction_accesses_;
  c.instruction_misses = instruction_misses_;
  c.data_accesses = data_accesses_;
  c.data_misses = data_misses_;
  c.memory = bus_.counters(last);
  return c;
}

}  // namespace dendro::sgi_4d35
