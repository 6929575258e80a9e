#pragma once

#include <cstdint>

#include "models/machines/rds3000/rds3000_spec.h"
#include "models/parts/host/host_port.h"
#include "models/parts/ik11b/ik11b_shell.h"
#include "sim/trace/trace_file.h"

namespace dendro::rds3000 {

/// Writes down both sides of the host's interface: what the program asks for, and what goes over the bus. It stands
/// between program and interface as a HostPort, and between interface and machine as a Target. The window opens with
/// the program's first request in it.
class HostRecorder : public ik11b::Target {
 public:
  HostRecorder(trace::Writer& out, const Spec& spec, ik11b::Target& machine)
      : out_(out), tick_ps_(spec.processor.tick_ps), machine_(machine) {}

  /// Runs the program on a port that writes down its requests.
  void run(HostPort& port, const std::function<void(HostPort&)>& program);

  std::uint32_t transfer(bool write, std::uint32_t address, std::uint32_t data, unsigned function) override;
  void command(bool run, bool reset) override;
  void host_sleeps() override { machine_.host_sleeps(); }
  sc_core::sc_event& interrupt_event() override { return machine_.interrupt_event(); }
  bool interrupt() const override { return machine_.interrupt(); }
  void clear_interrupt() override;
  bool running() const override { return machine_.running(); }
  std::exception_ptr error() const override { return machine_.error(); }
  std::uint32_t peek(std::uint32_t address, unsigned function) const override {
    return machine_.peek(address, function);
  }
  void program(std::string_view name, std::uint32_t first) override { machine_.program(name, first); }

 private:
  class Port;

  std::int64_t edge() const;
  /// Called before each request: opens and closes the window.
  void request();
  bool active() const { return begun_ && !ended_; }
  void add(const trace::Record& record) {
    if (active()) out_.add(record);
  }
  void end();

  trace::Writer& out_;
  std::int64_t tick_ps_;
  ik11b::Target& machine_;
  bool begun_ = false, ended_ = false;
};

}  // namespace dendro::rds3000
