#pragma once

#include <cstdint>
#include <vector>

#include "models/parts/r3000_bus/r3000_bus_counters.h"
#include "models/parts/r3000_bus/r3000_bus_spec.h"

namespace dendro::r3000_bus {

/// Write buffer and memory in closed form, in absolute clocks: every entry knows when its write begins and
/// ends as if no read came any more; a read that overtakes moves the entries behind it. Calls come in the
/// order of their clocks. Rules: README.md.
class Bus {
 public:
  /// Main memory lies below `main_bytes`; anything else is a device, or nothing.
  Bus(const Spec& spec, std::uint32_t main_bytes);

  /// The first clock from `now` on in which a store finds an entry free.
  std::uint64_t free_from(std::uint64_t now) const {
    const std::uint64_t end = entries_[(count_ - spec_.entries) & kMask].end;
    return end > now ? end : now;
  }
  /// A store leaves MEM in clock `now`.
  void store(std::uint32_t address, std::uint64_t now) {
    Entry& entry = entries_[count_ & kMask];
    entry.address = address;
    entry.enter = now;
    const Entry& before = entries_[(count_ - 1) & kMask];
    ++count_;
    const bool first = count_ - 1 == first_after_read_;
    schedule(entry, first ? read_end_ : before.end, first ? read_page_ : before.page);
  }
  /// The newest store left MEM in `now` and not in `then`, as it was said when it was not known better.
  /// Nothing happens if the newest store is of another clock.
  void delay_newest(std::uint64_t then, std::uint64_t now) {
    if (newest().enter == then && count_ != 0) enter_newest(now);
  }
  /// The processor asks in clock `now` for a block that begins at `address`. Returns the clock in which the
  /// read starts. A store that is said to leave MEM in `now` has not yet entered.
  std::uint64_t read_block(std::uint32_t address, unsigned words, std::uint64_t now);
  /// The same for a word that is not cached, or where nothing answers.
  std::uint64_t read_uncached(std::uint32_t address, std::uint64_t now);

  /// What has happened when a run ends with clock `last`; operations that start later are not counted.
  Counters counters(std::uint64_t last) const;

 private:
  struct Entry {
    std::uint64_t enter = 0, start = 0, end = 0;
    std::uint32_t address = 0, page = kNoPage;
    bool in_page = false;  ///< takes the time of a write in the open page
  };
  static constexpr unsigned kEntries = 128, kMask = kEntries - 1;
  static constexpr std::uint32_t kNoPage = ~0u;

  const Entry& newest() const { return entries_[(count_ - 1) & kMask]; }
  std::uint32_t page_of(std::uint32_t address) const {
    return address < main_bytes_ ? address >> page_shift_ : kNoPage;
  }
  void schedule(Entry& entry, std::uint64_t free, std::uint32_t open) {
    entry.page = page_of(entry.address);
    entry.in_page = entry.page == open && open != kNoPage;
    entry.start = free > entry.enter ? free : entry.enter + 1;
    entry.end = entry.start + (entry.in_page ? spec_.page_write_cycles : spec_.write_cycles);
    page_writes_ += entry.in_page;
  }
  void reschedule(std::uint64_t index);
  void enter_newest(std::uint64_t now);
  std::uint64_t read(std::uint32_t address, std::uint32_t block_bytes, unsigned words, std::uint64_t now);

  Spec spec_;
  std::uint32_t main_bytes_;
  unsigned page_shift_ = 0;
  std::uint64_t count_ = 0;             ///< stores so far; entry i is entries_[i & kMask]
  std::uint64_t first_after_read_ = 0;  ///< first entry whose write comes after the last read
  std::uint64_t read_end_ = 0, read_start_ = 0;
  std::uint32_t read_page_ = kNoPage;
  std::uint64_t read_busy_ = 0, reads_ = 0, read_words_ = 0, page_writes_ = 0, overtaken_ = 0;
  std::vector<Entry> entries_;
};

}  // namespace dendro::r3000_bus
