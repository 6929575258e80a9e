#pragma once

#include <cstdint>

#include "models/machines/sgi_4d35/sgi_4d35.h"
#include "models/parts/r3000_bus/clocked_bus.h"
#include "models/parts/r3000_cache/clocked_tags.h"

namespace dendro::sgi_4d35 {

/// Both caches, write buffer and memory as the stages IF and MEM find them, a clock at a time: begin(), what the stages
/// ask, end(). Addresses are physical; `cached` is of main memory, `memory` false where a device or nothing answers.
/// Each stage waits for one access at most. Rules: README.md of r3000_cache, r3000_bus and r3000.
class ClockedCaches {
 public:
  explicit ClockedCaches(const Spec& spec);

  /// Memory moves on into this clock; the read that ends in it changes the tags.
  void begin();
  /// What may start in this clock does.
  void end();

  /// IF looks at a word for the first time. Returns true for a miss.
  bool fetch(std::uint32_t physical, bool cached, bool memory);
  /// IF may go on with it in this clock.
  bool fetched() const;
  bool fetch_missing() const { return fetch_.missing; }

  /// MEM looks at an access of a cached address for the first time, isolated or not.
  void count_data() { ++counters_.data_accesses; }
  /// MEM looks at a load for the first time. Returns true for a miss.
  bool load(std::uint32_t physical, bool cached, bool memory);
  bool loaded() const { return data_.cached ? !data_.missing : data_.read_done; }
  bool load_missing() const { return data_.missing; }
  /// MEM looks at a cached store for the first time. Returns true for a miss.
  bool look_up_store(std::uint32_t physical);
  bool entry_free() const { return bus_.entry_free(); }
  /// A store leaves MEM in this clock; `partial`: of less than a word.
  void store(std::uint32_t physical, bool partial, bool cached, bool memory);
  /// A cached store with Status.IsC, and with `swapped` Status.SwC, leaves MEM.
  void isolated_store(std::uint32_t physical, bool partial, bool swapped);

  /// Those of caches and memory.
  Counters counters() const;
  const r3000_bus::ClockedBus& bus() const { return bus_; }

  // Before the first clock.
  void open_page(std::uint32_t physical) { bus_.open_page(physical); }
  r3000_cache::ClockedTags& tags(bool instruction) { return instruction ? instruction_tags_ : data_tags_; }

 private:
  struct Waiting {
    std::uint32_t physical = 0;
    bool cached = false, missing = false, read_done = false;
    bool asked = false;  ///< IF: its block has been asked for, and memory has not begun
  };
  bool streaming() const;
  void take_read(const r3000_bus::Read& read);

  const r3000_cache::Spec instruction_spec_, data_spec_;
  r3000_cache::ClockedTags instruction_tags_, data_tags_;
  r3000_bus::ClockedBus bus_;
  Waiting fetch_, data_;
  Counters counters_;
};

}  // namespace dendro::sgi_4d35
