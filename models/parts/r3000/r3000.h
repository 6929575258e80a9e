#pragma once

#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <vector>

#include "models/parts/r3000/r3000_state.h"

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

/// The processor without time: executes decoded words, one after another. Data sheet: README.md.
template <class Port>
class Core {
 public:
  Core(const Spec& spec, Port& port) : spec_(spec), port_(port) { forget(); }

  /// After a change of the state from outside, or of memory that holds code, call forget().
  State& state() { return s_; }
  const State& state() const { return s_; }
  void forget();

  /// Executes up to `budget` words; one that raises an exception counts. Returns what is left of the budget,
  /// more than 0 only if the port stopped the machine.
  std::uint64_t run(std::uint64_t budget);

 private:
  struct Mapping {
    std::uint32_t tag = 1;          ///< page of the virtual address; 1: none
    std::uint8_t* bytes = nullptr;  ///< of its page
  };
  static constexpr unsigned kMappings = 256, kPageWords = 1024;
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
  static std::uint32_t load16(const std::uint8_t* p) { return static_cast<std::uint32_t>(p[0] << 8 | p[1]); }

  Maps& maps() { return maps_[s_.user()]; }
  void forget_maps();
  bool load(std::uint32_t address, unsigned size, std::uint32_t& value);
  bool store(std::uint32_t address, unsigned size, std::uint32_t value);
  bool slow_load(std::uint32_t address, unsigned size, std::uint32_t& value);
  bool slow_store(std::uint32_t address, unsigned size, std::uint32_t value);
  bool misaligned(std::uint32_t address, unsigned size, Access access);
  const Decoded* fetch_page(std::uint32_t address);
  bool coprocessor1();
  std::uint64_t run_plain(std::uint64_t budget);
  void run_after_load();
  bool execute_cp0(const Decoded& d);
  bool execute_fp(const Decoded& d);
  void fpu_line();
  bool control_to_fpu(std::uint32_t value);
  void multiply_divide(const Decoded& d);
  bool load_part(const Decoded& d, bool left, std::uint32_t& value);
  bool store_part(const Decoded& d, bool left);

  const Spec spec_;
  Port& port_;
  State s_;
  Fault fault_;
  bool leave_ = false;   ///< run_plain() ends after this word: interrupts or the port want to be looked at
  bool merge_ = false;   ///< lwl or lwr merges into the load before it, whose value is `merge_value_`
  std::uint32_t merge_value_ = 0;
  bool refetch_ = true;  ///< the page of the program counter must be found anew
  Maps maps_[2];
  std::map<std::uint32_t, std::unique_ptr<std::array<Decoded, kPageWords>>> code_;  ///< by physical page
};

}  // namespace dendro::r3000

#include "models/parts/r3000/r3000_memory.h"
#include "models/parts/r3000/r3000_run.h"
