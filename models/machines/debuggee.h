#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace dendro {

/// A machine's program as a debugger sees it, between two words. Looking changes nothing and takes no simulated time.
class Debuggee {
 public:
  /// Why the program stands: a signal by GDB's numbers. `ended`: no word executes any more.
  struct Stop {
    int signal = 0;
    bool ended = false;
  };
  static constexpr int kInterrupted = 2, kIllegal = 4, kTrap = 5, kArithmetic = 8, kBus = 10, kSegment = 11, kLimit = 24;

  virtual ~Debuggee() = default;

  /// GDB's XML of the registers, whose numbers are the places in registers().
  virtual const std::string& description() const = 0;
  virtual std::vector<std::uint32_t> registers() const = 0;
  virtual std::size_t program_counter() const = 0;  ///< its number
  /// False: there is none, or it cannot be written.
  virtual bool set_register(std::size_t number, std::uint32_t value) = 0;

  /// By the program's addresses: how many bytes from the first on are memory, which are read or written.
  virtual std::size_t read(std::uint32_t address, std::uint8_t* to, std::size_t bytes) const = 0;
  virtual std::size_t write(std::uint32_t address, const std::uint8_t* from, std::size_t bytes) = 0;

  /// Words before which run() stops.
  virtual void set_breakpoint(std::uint32_t address, bool on) = 0;

  /// One word, with all that the machine's monitor does for it.
  virtual Stop step() = 0;
  /// At least one word, up to a breakpoint, the end, or `interrupted`, which is asked now and then.
  virtual Stop run(const std::function<bool()>& interrupted) = 0;
};

class Debugger {
 public:
  virtual ~Debugger() = default;
  /// Called once, before the program's first word. True: the program goes on alone; false: it is given up.
  virtual bool debug(Debuggee& program) = 0;
};

}  // namespace dendro
