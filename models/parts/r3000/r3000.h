#pragma once

#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "models/parts/r3000/r3000_block.h"
#include "models/parts/r3000/r3000_state.h"
#include "models/parts/r3010/r3010_quick.h"

namespace dendro::r3000 {

/// What the core needs from outside. A Port has the same members; addresses are physical.
struct PortConcept {
  /// The 4,096 bytes of main memory that hold the address, big-endian, or nullptr where there is none.
  std::uint8_t* page(std::uint32_t physical);
  /// Devices and what is not there: 1, 2 or 4 bytes, aligned. False is a bus error.
  bool read(std::uint32_t physical, unsigned size, std::uint32_t& value);
  bool write(std::uint32_t physical, unsigned size, std::uint32_t value);
  /// Asked after each access to a device: true ends run().
  bool stopped() const;
};

/// What the core tells of a word to a model of time, and the clocks that it gets back. The timed core knows
/// positions, translation and order; Timing knows caches, buffer and units. A Timing has the members that
/// machines/sgi_4d35/pipeline.h documents; this one has none.
struct NoTiming {
  static constexpr bool kTimed = false;
  struct Issue {};
};

/// kFast: words of pages that cannot change translation, fetched from the cache. kCareful: all that may
/// happen, a fetch put off until it is known how it is translated. kWarm: fast, and nothing takes time.
enum class Pace { kFunction, kFast, kCareful, kWarm };

/// Executes decoded words, one after another; with a Timing also knows in which clock. Data sheet: README.md.
template <class Port, class Timing = NoTiming>
class Core {
 public:
  template <class... Arguments>
  Core(const Spec& spec, Port& port, Arguments&&... timing)
      : time_{std::forward<Arguments>(timing)...}, spec_(spec), port_(port) {
    forget();
  }

  /// After a change of the state from outside, or of memory that holds code, call forget().
  State& state() { return s_; }
  const State& state() const { return s_; }
  void forget();

  /// Executes up to `budget` words; one that raises an exception counts. Returns what is left of the budget,
  /// more than 0 only if the port stopped the machine.
  std::uint64_t run(std::uint64_t budget);

  /// As run(), but ends also behind each word that may have reached a device.
  std::uint64_t run_to_service(std::uint64_t budget);

  Timing& time() { return time_; }
  /// Timed: after the last word, all that comes before the machine stops; time_.clock() is then the last clock.
  void settle();
  /// Timed: from here on caches are kept up to date and nothing takes time, or no more so.
  void warm(bool on) { warm_ = on; }

 private:
  static constexpr bool kTimed = Timing::kTimed;
  struct CodePage {
    std::array<Decoded, kPageWords> words;
    std::uint32_t physical = 0;
    bool plain = true;  ///< no word of it changes translation
    std::vector<typename Timing::Issue> issues;
    std::array<std::unique_ptr<Block>, kPageWords> blocks;  ///< by their first word, made when asked for
  };
  struct FetchMapping {
    std::uint32_t tag = 1, physical = 0;
    CodePage* page = nullptr;
  };
  struct Mapping {
    std::uint32_t tag = 1;          ///< page of the virtual address; 1: none
    std::uint32_t physical = 0;     ///< its address
    std::uint8_t* bytes = nullptr;  ///< of its page
  };
  static constexpr unsigned kMappings = 256;
  struct Maps {
    std::array<Mapping, kMappings> read, write;
  };

  static std::uint32_t load32(const std::uint8_t* p) {
    std::uint32_t value;
    std::memcpy(&value, p, 4);
    return __builtin_bswap32(value);
  }
  static void store32(std::uint8_t* p, std::uint32_t value) {
    value = __builtin_bswap32(value);
    std::memcpy(p, &value, 4);
  }
  static void store16(std::uint8_t* p, std::uint32_t value) {
    p[0] = static_cast<std::uint8_t>(value >> 8);
    p[1] = static_cast<std::uint8_t>(value);
  }
  static std::uint32_t load16(const std::uint8_t* p) { return static_cast<std::uint32_t>(p[0] << 8 | p[1]); }

  Maps& maps() { return maps_[s_.user()]; }
  void forget_maps();
  bool load(std::uint32_t address, unsigned size, std::uint32_t& value);
  bool store(std::uint32_t address, unsigned size, std::uint32_t value);
  bool slow_load(std::uint32_t address, unsigned size, std::uint32_t& value);
  bool slow_store(std::uint32_t address, unsigned size, std::uint32_t value);
  bool misaligned(std::uint32_t address, unsigned size, Access access);
  CodePage* fetch_page(std::uint32_t address);
  CodePage* decode_code(std::uint32_t physical);
  bool coprocessor1();
  template <Pace kPace>
  std::uint64_t run_plain(std::uint64_t budget);
  /// Words one by one, at the pace of the moment.
  std::uint64_t run_words(std::uint64_t budget);
  std::uint64_t run_paced(std::uint64_t budget);

  // Blocks: r3000_blocks.h.
  template <Pace kPace>
  std::uint64_t run_blocks(std::uint64_t budget);
  CodePage* known_page(std::uint32_t address);
  Block* block_at(CodePage& page, unsigned index);
  bool slow_fp(std::uint32_t word);

  void run_after_load();
  bool execute_cp0(const Decoded& d);
  bool execute_fp(const Decoded& d);
  void fpu_line();
  bool control_to_fpu(std::uint32_t value);
  void multiply_divide(Op op, std::uint32_t a, std::uint32_t b);
  bool load_part(const Decoded& d, bool left, std::uint32_t& value);
  bool store_part(const Decoded& d, bool left);

  // Time: r3000_time.h. `left` is what is left of the budget; run_plain() counts clocks with it.
  bool fetched(std::uint32_t address, std::uint64_t left);
  void fetch_slowly(std::uint32_t address, std::uint64_t left);
  bool is_plain(std::uint32_t address) const;
  std::uint64_t fetch_at(std::uint32_t address, std::uint64_t now);
  void finish_careful(std::uint32_t pc, std::uint32_t next, std::uint32_t npc, bool rfe, std::uint64_t left);
  void finish_fault(std::uint32_t pc, std::uint32_t npc, bool refill, std::uint64_t left);
  void catch_up(std::uint64_t left);
  void lose_positions();
  void interrupted();
  bool may_hurry() const;
  void hurry();

  Timing time_;
  const Spec spec_;
  Port& port_;
  State s_;
  Fault fault_;
  bool leave_ = false;   ///< run_plain() ends after this word: interrupts or the port want to be looked at
  bool touched_ = false;  ///< a device, or where there is none
  bool merge_ = false;   ///< lwl or lwr merges into the load before it, whose value is `merge_value_`
  std::uint32_t merge_value_ = 0;
  bool refetch_ = true;  ///< the page of the program counter must be found anew
  Maps maps_[2];
  std::map<std::uint32_t, std::unique_ptr<CodePage>> code_;  ///< by physical page
  bool careful_ = true, warm_ = false;
  bool deferred_ = false;  ///< the fetch of the word behind the next is put off, and what comes behind it
  std::uint32_t deferred_address_ = 0;
  unsigned lost_ = 0;  ///< positions before the word at pc in which nothing executes
  std::array<FetchMapping, kMappings> fetches_[2];  ///< decoded pages; timed: plain cached ones
  bool short_ = false;   ///< run_blocks() ended before a block that was longer than what was left
  r3010::Quick quick_;
};

}  // namespace dendro::r3000

#include "models/parts/r3000/r3000_memory.h"
#include "models/parts/r3000/r3000_time.h"
#include "models/parts/r3000/r3000_blocks.h"
#include "models/parts/r3000/r3000_words.h"
#include "models/parts/r3000/r3000_run.h"
