#include "models/parts/r3000_bus/clocked_bus.h"

#include <algorithm>

#include "sim/base/check.h"

namespace dendro::r3000_bus {

void ClockedBus::begin() {
  ended_ = entered_ = false;
  if (state_ == State::kFree || ++elapsed_ < length_) return;
  if (state_ == State::kReading)
    ended_ = true;
  else
    entries_.pop_front();
  state_ = State::kFree;
}

bool ClockedBus::arrives(std::uint32_t address) const {
  const std::uint32_t word = (address - read_.address) / 4;
  return state_ == State::kReading && word < read_.words &&
         elapsed_ == spec_.first_word_cycles + (word + 1) * spec_.word_cycles;
}

void ClockedBus::ask(const Read& read) {
  DENDRO_CHECK(!waits_, "a read of 0x{:x} while one of 0x{:x} waits", read.address, waiting_.address);
  waiting_ = read;
  waits_ = true;
}

void ClockedBus::enter(std::uint32_t address, bool memory) {
  DENDRO_CHECK(entry_free(), "a store to 0x{:x} with {} entries", address, entries_.size());
  entries_.push_back({address, memory});
  entered_ = true;
}

bool ClockedBus::may_start(const Read& read) const {
  if (entries_.empty()) return true;
  if (!read.cached || !spec_.read_bypass) return false;
  return std::none_of(entries_.begin(), entries_.end(),
                      [&](const Entry& e) { return (e.address - read.address) / 4 < read.words; });
}

const Read* ClockedBus::end() {
  const Read* started = nullptr;
  if (state_ == State::kFree) {
    if (waits_ && may_start(waiting_)) {
      start_read();
      started = &read_;
    } else if (entries_.size() > (entered_ ? 1 : 0)) {
      start_write();
    }
  }
  counters_.busy += state_ != State::kFree;
  return started;
}

void ClockedBus::start(State state, unsigned clocks, std::uint32_t address, bool memory) {
  state_ = state;
  elapsed_ = 0;
  length_ = clocks;
  address_ = address;
  page_open_ = memory;
}

void ClockedBus::start_read() {
  read_ = waiting_;
  waits_ = false;
  ++counters_.reads;
  counters_.read_words += read_.words;
  counters_.overtaken += !entries_.empty();
  start(State::kReading, spec_.first_word_cycles + read_.words * spec_.word_cycles, read_.address,
        read_.memory);
}

void ClockedBus::start_write() {
  const Entry& entry = entries_.front();
  const bool same_page =
      page_open_ && entry.memory && ((entry.address ^ address_) & ~(spec_.page_bytes - 1)) == 0;
  ++counters_.writes;
  counters_.page_writes += same_page;
  start(State::kWriting, same_page ? spec_.page_write_cycles : spec_.write_cycles, entry.address,
        entry.memory);
}

}  // namespace dendro::r3000_bus
