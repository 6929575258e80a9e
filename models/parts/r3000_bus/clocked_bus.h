#pragma once

#include <cstdint>
#include <deque>

#include "models/parts/r3000_bus/r3000_bus_counters.h"
#include "models/parts/r3000_bus/r3000_bus_spec.h"

namespace dendro::r3000_bus {

/// A read that the processor waits for.
struct Read {
  std::uint32_t address = 0;  ///< physical, of the first word
  unsigned words = 1;
  bool instruction = false;  ///< who asks: the fetch, or a load
  bool cached = false;       ///< a block; otherwise one word
  bool memory = true;        ///< false: a device, or nothing
};

/// Write buffer and memory, a clock at a time: `begin`, then what the processor asks and stores, then `end`.
/// Rules: README.md.
class ClockedBus {
 public:
  explicit ClockedBus(const Spec& spec) : spec_(spec) {}

  /// The state of memory moves on into this clock.
  void begin();
  /// The read whose last word is there in this clock, or nullptr.
  const Read* ended() const { return ended_ ? &read_ : nullptr; }
  /// A read is under way, its last word not there yet.
  const Read* reading() const { return state_ == State::kReading ? &read_ : nullptr; }
  /// The word of the block under way comes in exactly this clock.
  bool arrives(std::uint32_t address) const;

  /// Asks once; at most one read may wait.
  void ask(const Read& read);
  bool entry_free() const { return entries_.size() < spec_.entries; }
  /// A store of the word that leaves MEM in this clock.
  void enter(std::uint32_t address, bool memory);

  /// Starts what may start in this clock. The read that did, or nullptr.
  const Read* end();

  const Counters& counters() const { return counters_; }
  std::size_t entries() const { return entries_.size(); }
  unsigned state_number() const { return static_cast<unsigned>(state_); }
  std::uint32_t address() const { return address_; }

 private:
  enum class State : std::uint8_t { kFree, kReading, kWriting };
  struct Entry {
    std::uint32_t address;
    bool memory;
  };
  bool may_start(const Read& read) const;
  void start_read();
  void start_write();
  void start(State state, unsigned clocks, std::uint32_t address, bool memory);

  Spec spec_;
  State state_ = State::kFree;
  unsigned elapsed_ = 0, length_ = 0;  ///< clocks of the operation
  std::uint32_t address_ = 0;          ///< of the last operation
  bool page_open_ = false;
  Read read_, waiting_;
  bool waits_ = false, ended_ = false;
  std::deque<Entry> entries_;  ///< the one that is being written first
  bool entered_ = false;       ///< the last entry came in this clock
  Counters counters_;
};

}  // namespace dendro::r3000_bus
