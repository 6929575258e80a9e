#include "models/machines/pixel_planes/clocked.h"
#include "models/machines/pixel_planes/pixel_planes_map.h"
#include "sim/base/check.h"

namespace dendro::pixel_planes {
namespace {

std::int64_t now_in_ps() { return static_cast<std::int64_t>(sc_core::sc_time_stamp().value()); }

}  // namespace

void ClockedEngine::host_thread() {
  try {
    program_(*this);
  } catch (...) {
    // An exception that leaves an SC_THREAD would become a SystemC report; simulate() rethrows this one.
    if (!error_) error_ = std::current_exception();
  }
  host_ended_ = true;
  host_end_ps_ = now_in_ps();
  if (error_ || (idle_now() && next_clock_ * tick_ps_ >= host_end_ps_)) {
    stopped_ = true;
    sc_core::sc_stop();
  }
}

void ClockedEngine::wait_ps(std::int64_t ps) {
  if (ps > 0) wait(sc_core::sc_time::from_value(static_cast<sc_dt::uint64>(ps)));
}

void ClockedEngine::own_time(std::int64_t ps) {
  host_busy_ps_ += ps;
  wait_ps(ps);
}

std::int64_t ClockedEngine::clock_now() const { return now_in_ps() / tick_ps_; }

// In the last picosecond of a clock the engine may have worked it out already; then what was true at the
// clock's beginning is remembered.
bool ClockedEngine::idle_at(std::int64_t clock) const {
  if (clock == next_clock_) return idle_now();
  DENDRO_CHECK(clock == next_clock_ - 1, "clock {}, next is {}", clock, next_clock_);
  return idle_before_ && fifo_.empty();
}

bool ClockedEngine::room_at(std::int64_t clock) const {
  const std::size_t landed_now = last_landed_ == clock ? 1 : 0;
  const std::size_t words = clock == next_clock_ ? fifo_.size() - landed_now : fifo_before_;
  return words < static_cast<std::size_t>(spec_.fifo_words);
}

void ClockedEngine::offer(std::uint32_t word) {
  ++fifo_counters_.words;
  for (;;) {
    const std::int64_t n = clock_now();
    if (room_at(n) && last_landed_ < n) {
      fifo_.land(word, n);
      last_landed_ = n;
      return;
    }
    if (room_at(n) || n < next_clock_) {
      if (!room_at(n)) ++fifo_counters_.full_clocks;
      wait_ps((n + 1) * tick_ps_ - now_in_ps());
    } else {
      host_waits_for_room_ = true;
      wait(room_event_);
      host_waits_for_room_ = false;
      fifo_counters_.full_clocks += static_cast<std::uint64_t>(clock_now() - n);
    }
  }
}

void ClockedEngine::store(std::uint32_t address, std::uint32_t value) {
  if (address < kControlStoreEnd) {
    writes_.push_back({clock_now(), address - kControlStore, value});
  } else if (address == kFifo) {
    offer(value);
  } else if (address == kVideoBase) {
    video_.base = value & (igc::kMostMemoryBits - 1);
  } else if (address == kVideoSize) {
    video_.width = static_cast<int>(value & 0xFFFF);
    video_.height = static_cast<int>(value >> 16);
  }
}

std::uint32_t ClockedEngine::load(std::uint32_t address) {
  if (address < kControlStoreEnd) {
    for (auto write = writes_.rbegin(); write != writes_.rend(); ++write)
      if (write->index == address - kControlStore) return write->value;
    return controller_.half(address - kControlStore);
  }
  if (address == kStatus) {
    time_read_ = true;
    return idle_at(clock_now()) ? 0 : 1;
  }
  if (address == kVideoBase) return video_.base;
  if (address == kVideoSize)
    return static_cast<std::uint32_t>(video_.width) | static_cast<std::uint32_t>(video_.height) << 16;
  return 0;
}

std::uint32_t ClockedEngine::read(std::uint32_t address, unsigned) {
  own_time(spec_.host.word_ps);
  return load(address);
}

void ClockedEngine::write(std::uint32_t address, std::uint32_t value, unsigned) {
  own_time(spec_.host.word_ps);
  store(address, value);
}

void ClockedEngine::dma_to(std::uint32_t address, const std::uint32_t* words, std::size_t count, unsigned,
                           std::uint32_t step) {
  for (std::size_t i = 0; i < count; ++i) {
    own_time(spec_.host.word_ps);
    store(address == kFifo ? kFifo : address + static_cast<std::uint32_t>(i) * step, words[i]);
  }
}

void ClockedEngine::dma_from(std::uint32_t address, std::uint32_t* words, std::size_t count, unsigned,
                             std::uint32_t step) {
  for (std::size_t i = 0; i < count; ++i) {
    own_time(spec_.host.word_ps);
    words[i] = load(address + static_cast<std::uint32_t>(i) * step);
  }
}

void ClockedEngine::command(std::uint32_t) {}

void ClockedEngine::wait_interrupt() {
  for (;;) {
    const std::int64_t n = clock_now();
    if (idle_at(n)) break;
    if (n < next_clock_) {
      wait_ps(next_clock_ * tick_ps_ - now_in_ps());
      continue;
    }
    host_waits_for_idle_ = true;
    wait(idle_event_);
    host_waits_for_idle_ = false;
  }
  own_time(spec_.host.interrupt_ps);
}

void ClockedEngine::compute(const Work& work) {
  own_time(static_cast<std::int64_t>(work.flops) * spec_.host.flop_ps +
           static_cast<std::int64_t>(work.instructions) * spec_.host.instruction_ps +
           static_cast<std::int64_t>(work.program_loads) * spec_.host.program_load_ps);
}

void ClockedEngine::phase(std::string_view name) {
  phases_.push_back({std::string(name), (now_in_ps() + tick_ps_ - 1) / tick_ps_});
}

std::uint32_t ClockedEngine::peek(std::uint32_t address, unsigned function) const {
  const auto width = static_cast<std::uint32_t>(spec_.array.width);
  if (address >= static_cast<std::uint32_t>(spec_.pixels())) return 0;
  return array_.planes().memory_word(function, address % width, address / width);
}

}  // namespace dendro::pixel_planes
