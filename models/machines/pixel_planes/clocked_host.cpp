#include <algorithm>

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
  return std::all_of(renderers_.begin(), renderers_.end(), [](const ClockedRenderer& r) { return r.idle_before(); });
}

void ClockedEngine::offer(ClockedRenderer& renderer, std::uint32_t word) {
  ++renderer.fifo_counters.words;
  for (;;) {
    const std::int64_t n = clock_now();
    const bool room = renderer.room_at(n, next_clock_);
    if (room && renderer.can_land_in(n)) {
      renderer.land(word, n);
      return;
    }
    if (room || n < next_clock_) {
      if (!room) ++renderer.fifo_counters.full_clocks;
      wait_ps((n + 1) * tick_ps_ - now_in_ps());
    } else {
      host_waits_for_room_ = &renderer;
      wait(room_event_);
      host_waits_for_room_ = nullptr;
      renderer.fifo_counters.full_clocks += static_cast<std::uint64_t>(clock_now() - n);
    }
  }
}

void ClockedEngine::store(std::uint32_t address, std::uint32_t value) {
  if (address == kVideoBase) {
    video_.base = value & (igc::kMostMemoryBits - 1);
  } else if (address == kVideoSize) {
    video_.width = static_cast<int>(value & 0xFFFF);
    video_.height = static_cast<int>(value >> 16);
  } else if (address == kSelect) {
    selection_.number = value;
  }
  for (std::size_t r = selection_.first(renderers_.size()); r < selection_.end(renderers_.size()); ++r) {
    if (address < kControlStoreEnd) renderers_[r].store(clock_now(), address - kControlStore, value);
    if (address == kFifo) offer(renderers_[r], value);
  }
}

std::uint32_t ClockedEngine::load(std::uint32_t address) {
  if (address < kControlStoreEnd) return renderers_[selection_.first(renderers_.size())].load(address - kControlStore);
  if (address == kStatus) {
    time_read_ = true;
    return idle_at(clock_now()) ? 0 : 1;
  }
  if (address == kSelect) return selection_.number;
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
  if (address >= kFramePixels) return frame_.peek(address - kFramePixels, function);
  const auto width = static_cast<std::uint32_t>(spec_.array.width), pixels = static_cast<std::uint32_t>(spec_.pixels());
  if (address / pixels >= renderers_.size()) return 0;
  const std::uint32_t pixel = address % pixels;
  return renderers_[address / pixels].array().planes().memory_word(function, pixel % width, pixel / width);
}

}  // namespace dendro::pixel_planes
