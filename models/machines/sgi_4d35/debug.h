#pragma once

#include <functional>
#include <set>

#include "models/machines/debuggee.h"
#include "models/machines/sgi_4d35/board.h"

namespace dendro::sgi_4d35 {

/// A core that executes word by word, for a debugger. At `cycle` and `clocked` the clocks are those of a run without one,
/// unless the debugger writes; at `clocked`, where the next words are under way, it cannot.
class ElfDebuggee : public Debuggee {
 public:
  struct Core {
    r3000::State& state;
    /// Executes up to so many words and returns how many are left, more than 0 also behind one that reached a device.
    std::function<std::uint64_t(std::uint64_t)> run;
    /// Memory there has changed. Empty: nothing can be written.
    std::function<void(std::uint32_t physical)> forget_code;
    std::function<void(std::uint32_t address)> jump;
  };

  ElfDebuggee(Core core, Board& board, std::uint64_t limit);

  /// Executes the monitor's first words, up to the program's entry.
  void enter();
  std::uint64_t left() const { return left_; }  ///< of the limit

  const std::string& description() const override;
  std::vector<std::uint32_t> registers() const override;
  std::size_t program_counter() const override;
  bool set_register(std::size_t number, std::uint32_t value) override;
  std::size_t read(std::uint32_t address, std::uint8_t* to, std::size_t bytes) const override;
  std::size_t write(std::uint32_t address, const std::uint8_t* from, std::size_t bytes) override;
  void set_breakpoint(std::uint32_t address, bool on) override;
  Stop step() override;
  Stop run(const std::function<bool()>& interrupted) override;

 private:
  /// Main memory behind a virtual address, by the TLB, the monitor's page table, or where it will lie in the stack.
  bool physical_of(std::uint32_t address, std::uint32_t& physical) const;
  bool over() const { return left_ == 0 || board_.stopped(); }
  bool in_program() const { return core_.state.status & r3000::kStatusIec; }
  bool at_breakpoint() const { return breakpoints_.count(core_.state.pc) != 0; }
  bool leave_monitor();
  Stop stop(int signal);
  r3000::State state_at_fault() const;
  unsigned fault_code() const { return board_.block.arguments[0] >> 2 & 31; }
  int fault_signal() const;

  Core core_;
  Board& board_;
  std::uint64_t left_;
  std::set<std::uint32_t> breakpoints_;
  bool monitored_ = false;  ///< interrupts are enabled in the program and not in the monitor
  bool faulted_ = false;  ///< the monitor gave the program up; it is seen at the word that faulted
};

/// Lets the debugger, if there is one, drive `core` by `run`, and returns what is left of the limit; 0 if it gives the
/// program up.
std::uint64_t debugged(Debugger* debugger, ElfDebuggee::Core core, Board& board, std::uint64_t limit);

/// The same for a core of any kind.
template <class Core, class Run>
std::uint64_t debugged(Debugger* debugger, Core& core, const Run& run, Board& board, std::uint64_t limit) {
  return debugged(debugger,
                  {core.state(), run, [&core](std::uint32_t physical) { core.forget_code(physical); },
                   [&core](std::uint32_t address) { core.jump(address); }},
                  board, limit);
}

}  // namespace dendro::sgi_4d35
