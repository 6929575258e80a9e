#pragma once

#include <cstdint>
#include <memory>

#include "models/machines/sgi_4d35/sgi_4d35.h"

namespace dendro::sgi_4d35 {

/// Caches, write buffer and memory at one level, as the stages of a processor that is not there look at them: IF in one
/// clock after the other, MEM before IF in the same. What asks too early takes its turn. Addresses are physical, clocks
/// absolute.
class MemorySide {
 public:
  struct Place {
    std::uint32_t address = 0;
    bool cached = true, memory = true;  ///< main memory; otherwise a device, or nothing
  };
  struct Told {
    std::uint64_t looked = 0;  ///< the clock in which the stage looked first
    std::uint64_t clock = 0;   ///< the clock in which it goes on
    bool miss = false;
  };

  virtual ~MemorySide() = default;

  Told fetch(const Place& place, std::uint64_t at);
  /// IF looks once more at the word of the last fetch, which ALU held up.
  Told fetch_again(std::uint64_t at);
  Told load(const Place& place, std::uint64_t at);
  /// `partial`: of less than a word. It leaves MEM in clock `leaves` if it can; a fetch that waits holds it up.
  Told store(const Place& place, bool partial, std::uint64_t at, std::uint64_t leaves);
  /// Status.IsC. The tags change as the store leaves.
  Told isolated_load(std::uint64_t at);
  Told isolated_store(std::uint32_t address, bool partial, bool swapped, std::uint64_t at, std::uint64_t leaves);

  /// A store is in MEM, and leaves it in this clock as far as it is known.
  bool in_mem() const { return in_mem_; }
  std::uint64_t leaves() const { return leaves_; }

  /// Counters of caches and memory as if the run ended with clock `last`.
  Counters counters(std::uint64_t last);

  // Before everything else.
  virtual void open_page(std::uint32_t address) = 0;
  /// The cache holds this word.
  virtual void hold(bool instruction, std::uint32_t address) = 0;

 protected:
  /// What leaves MEM.
  struct Leaving {
    enum Kind : std::uint8_t { kStore, kIsolated } kind = kStore;
    Place place;
    bool partial = false, swapped = false;
  };
  virtual Told do_fetch(const Place& place, std::uint64_t now) = 0;
  virtual Told do_fetch_again(std::uint64_t now) = 0;
  virtual Told do_load(const Place& place, std::uint64_t now) = 0;
  /// Waits for an entry of the buffer.
  virtual Told do_store(const Leaving& store, std::uint64_t now) = 0;
  virtual void do_isolated_load() = 0;
  /// The store leaves MEM in clock leaves().
  virtual void do_leave(const Leaving& store) = 0;
  virtual Counters counters_at(std::uint64_t last) = 0;
  /// The clock in which IF or MEM went on is no run clock.
  void hold_up(std::uint64_t until) {
    if (in_mem_ && leaves_ < until) leaves_ = until;
  }

 private:
  std::uint64_t turn_of_mem(std::uint64_t at);
  std::uint64_t turn_of_fetch(std::uint64_t at);
  Told mem_went_on(const Told& told);
  Told fetch_went_on(const Told& told);
  Told put(const Leaving& store, std::uint64_t at, std::uint64_t leaves);

  std::uint64_t next_mem_ = 0, next_fetch_ = 0;
  bool in_mem_ = false;
  std::uint64_t leaves_ = 0;
  Leaving leaving_;
};

/// Level is cycle or clocked.
std::unique_ptr<MemorySide> make_memory_side(const Spec& spec, Level level);

}  // namespace dendro::sgi_4d35
