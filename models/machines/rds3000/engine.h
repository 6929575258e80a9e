#pragma once

#include <cstdint>
#include <exception>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "models/machines/machine.h"
#include "models/machines/rds3000/devices.h"
#include "models/machines/rds3000/rds3000_spec.h"
#include "models/machines/rds3000/rds3000_state.h"
#include "models/parts/ik11b/ik11b_shell.h"

namespace dendro::rds3000 {

class PixelCost;

/// Ticks [from, to) in which the processor ran.
struct RunInterval {
  std::int64_t from = 0, to = 0;
};

/// The RDS-3000 behind its host interface at a level with time. Tick n is the SystemC time n x tick_ps. Timing: the
/// README.md of the parts.
class Engine : public ik11b::Target {
 public:
  /// The host is done: brings every counter to the state before tick `end`. Called once.
  virtual void finish(std::int64_t end) = 0;

  virtual const ProcessorState& processor() const = 0;
  virtual const ProcessorCounters& processor_counters() const = 0;
  virtual const BusCounters& bus_counters() const = 0;
  virtual const MemoryCounters& memory_counters() const = 0;
  virtual const dr64::Core& memory() const = 0;
  virtual const video::State& video() const = 0;
  /// nullptr unless it was asked for, and at levels that keep none.
  virtual const PixelCost* cost() const { return nullptr; }

  const std::vector<RunInterval>& runs() const { return runs_; }
  const std::vector<MarkEvent>& marks() const { return marks_; }
  bool time_dependent() const { return time_dependent_; }
  std::uint32_t peek(std::uint32_t address, unsigned function) const override {
    return peek_at(processor(), video(), memory(), address, function);
  }
  /// The tick limit was hit (UserError) or nothing.
  std::exception_ptr error() const override { return error_; }

  /// Names of marked words by word index (page x 4096 + address); set before the run. A mark is logged with the tick in which its word executes.
  void set_marks(std::map<std::uint32_t, std::string> names) { mark_names_ = std::move(names); }
  /// The marks that a program brings when the host loads it: MachineOptions::programs.
  void set_programs(std::map<std::string, std::map<std::uint32_t, std::string>> programs) {
    programs_ = std::move(programs);
  }
  void program(std::string_view name, std::uint32_t first) override {
    if (const auto known = programs_.find(std::string(name)); known != programs_.end())
      replace_marks(mark_names_, known->second, first);
  }

 protected:
  std::vector<RunInterval> runs_;
  std::vector<MarkEvent> marks_;
  std::map<std::uint32_t, std::string> mark_names_;
  std::map<std::string, std::map<std::uint32_t, std::string>> programs_;
  bool time_dependent_ = false;
  std::exception_ptr error_;
};

}  // namespace dendro::rds3000
