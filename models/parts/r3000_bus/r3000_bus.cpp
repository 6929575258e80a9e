#include "models/parts/r3000_bus/r3000_bus.h"

#include <algorithm>

namespace dendro::r3000_bus {

Bus::Bus(const Spec& spec, std::uint32_t main_bytes)
    : spec_(spec), main_bytes_(main_bytes), entries_(kEntries) {
  while ((std::uint32_t{1} << page_shift_) < spec.page_bytes) ++page_shift_;
}

void Bus::reschedule(std::uint64_t index) {
  Entry& entry = entries_[index & kMask];
  page_writes_ -= entry.in_page;
  const Entry& before = entries_[(index - 1) & kMask];
  const bool first = index == first_after_read_;
  schedule(entry, first ? read_end_ : before.end, first ? read_page_ : before.page);
}

void Bus::enter_newest(std::uint64_t now) {
  entries_[(count_ - 1) & kMask].enter = now;
  reschedule(count_ - 1);
}

std::uint64_t Bus::read(std::uint32_t address, std::uint32_t block_bytes, unsigned words, std::uint64_t now) {
  const std::uint64_t visible = count_ - (count_ != 0 && newest().enter == now);
  std::uint64_t waiting = visible;  // first entry whose write has not begun before this clock
  while (waiting > first_after_read_ && entries_[(waiting - 1) & kMask].start >= now) --waiting;
  std::uint64_t behind = visible;  // first entry that this read may overtake
  const bool may_overtake = block_bytes != 0 && spec_.read_bypass;
  while (may_overtake && behind > waiting &&
         (entries_[(behind - 1) & kMask].address & ~(block_bytes - 1)) != address)
    --behind;
  if (!may_overtake) behind = visible;
  const std::uint64_t free =
      behind > first_after_read_ ? entries_[(behind - 1) & kMask].end : read_end_;
  read_start_ = std::max(free, now);
  const std::uint64_t cycles = spec_.first_word_cycles + std::uint64_t{words} * spec_.word_cycles;
  read_end_ = read_start_ + cycles;
  read_page_ = page_of(address);
  first_after_read_ = behind;
  overtaken_ += behind < visible;
  for (std::uint64_t i = behind; i < count_; ++i) reschedule(i);
  ++reads_;
  read_words_ += words;
  read_busy_ += cycles;
  return read_start_;
}

std::uint64_t Bus::read_block(std::uint32_t address, unsigned words, std::uint64_t now) {
  return read(address, 4 * words, words, now);
}

std::uint64_t Bus::read_uncached(std::uint32_t address, std::uint64_t now) {
  return read(address, 0, 1, now);
}

Counters Bus::counters(std::uint64_t last) const {
  Counters c;
  c.reads = reads_;
  c.read_words = read_words_;
  c.overtaken = overtaken_;
  c.writes = count_;
  c.page_writes = page_writes_;
  c.busy = read_busy_ + c.page_writes * spec_.page_write_cycles +
           (c.writes - c.page_writes) * spec_.write_cycles;
  if (reads_ != 0 && read_end_ > last + 1) c.busy -= read_end_ - (last + 1);
  for (std::uint64_t i = count_; i > first_after_read_; --i) {
    const Entry& entry = entries_[(i - 1) & kMask];
    if (entry.end <= last + 1) break;
    c.busy -= entry.end - std::max(entry.start, last + 1);
    if (entry.start <= last) continue;
    --c.writes;
    c.page_writes -= entry.in_page;
  }
  return c;
}

}  // namespace dendro::r3000_bus
