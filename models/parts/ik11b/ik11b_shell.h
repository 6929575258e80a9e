#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <string>
#include <string_view>
#include <systemc>
#include <vector>

#include "models/parts/host/host_port.h"
#include "models/parts/ik11b/ik11b_spec.h"

namespace dendro::ik11b {

/// The machine's bus as the interface reaches it. Called from the host's SC_THREAD; calls may wait().
class Target {
 public:
  virtual ~Target() = default;

  /// One bus access, asked for now; returns when it is complete, with the word read.
  virtual std::uint32_t transfer(bool write, std::uint32_t address, std::uint32_t data, unsigned function) = 0;
  /// The run and reset bits of the command register, as of the tick edge at or after now.
  virtual void command(bool run, bool reset) = 0;
  /// The host will do nothing before the interrupt: a machine that only acts when asked goes ahead.
  virtual void host_sleeps() {}
  /// Notified at the tick after the one in which a program halts, or when `error` was set.
  virtual sc_core::sc_event& interrupt_event() = 0;
  virtual bool interrupt() const = 0;
  virtual void clear_interrupt() = 0;
  /// True while an interrupt can still come.
  virtual bool running() const = 0;
  /// The machine gave up (UserError), or nothing.
  virtual std::exception_ptr error() const = 0;
  /// A word as a debugger sees it.
  virtual std::uint32_t peek(std::uint32_t address, unsigned function) const = 0;
  /// The control store is about to hold the program `name` from word `first` on.
  virtual void program(std::string_view name, std::uint32_t first) = 0;
};

/// A named stretch of the host's program.
struct HostPhase {
  std::string name;
  std::int64_t from_ps = 0;
};

/// The interface and the host computer behind it: runs one host program as an SC_THREAD, then stops the simulation.
class Shell : public sc_core::sc_module, public HostPort {
 public:
  Shell(sc_core::sc_module_name name, const HostSpec& spec, Target& target,
        std::function<void(HostPort&)> program);

  std::uint32_t read(std::uint32_t address, unsigned function) override;
  void write(std::uint32_t address, std::uint32_t value, unsigned function) override;
  void dma_to(std::uint32_t address, const std::uint32_t* words, std::size_t count, unsigned function,
              std::uint32_t step) override;
  void dma_from(std::uint32_t address, std::uint32_t* words, std::size_t count, unsigned function,
                std::uint32_t step) override;
  void command(std::uint32_t bits) override;
  void wait_interrupt() override;
  void compute(const Work& work) override;
  void phase(std::string_view name) override;
  std::uint32_t peek(std::uint32_t address, unsigned function) const override {
    return target_.peek(address, function);
  }
  void program(std::string_view name, std::uint32_t first) override { target_.program(name, first); }

  const std::vector<HostPhase>& phases() const { return phases_; }
  std::int64_t ended_ps() const { return ended_ps_; }
  /// What the host program threw, or nothing.
  std::exception_ptr error() const { return error_; }

  std::uint64_t dma_words() const { return dma_words_; }
  std::uint64_t busy_ps() const { return busy_ps_; }

 private:
  void thread();
  void pause(std::int64_t ps);
  template <class Move>
  void dma(std::size_t count, const Move& move);

  HostSpec spec_;
  Target& target_;
  std::function<void(HostPort&)> program_;
  std::vector<HostPhase> phases_;
  std::int64_t ended_ps_ = 0;
  std::uint64_t dma_words_ = 0, busy_ps_ = 0;
  std::exception_ptr error_;
};

}  // namespace dendro::ik11b
