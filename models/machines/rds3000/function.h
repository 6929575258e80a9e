#pragma once

#include <vector>

#include "models/machines/rds3000/devices.h"
#include "models/machines/machine.h"
#include "models/parts/bps32/bps32.h"

namespace dendro::rds3000 {

/// The `function` level: words one after the other, accesses complete at once, no time. Vertical blank toggles
/// every 4,096 words. The host's calls are plain calls.
class FunctionEngine : public HostPort {
 public:
  FunctionEngine(const Spec& spec, const MachineOptions& options);

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
  std::uint32_t peek(std::uint32_t address, unsigned function) const override;
  void program(std::string_view name, std::uint32_t first) override;

  const ProcessorState& processor() const { return processor_; }
  const Devices& devices() const { return devices_; }
  std::uint64_t words() const { return words_; }
  /// How often each control word was executed, by word index.
  const std::vector<std::uint64_t>& executions() const { return executions_; }
  const std::vector<MarkEvent>& marks() const { return marks_; }  ///< `tick` counts words
  bool time_dependent() const { return time_dependent_; }

 private:
  void run_to_halt();

  Spec spec_;
  MachineOptions options_;
  ProcessorState processor_;
  Devices devices_;
  std::uint64_t words_ = 0;
  std::vector<std::uint64_t> executions_;
  std::vector<MarkEvent> marks_;
  bool time_dependent_ = false;
};

}  // namespace dendro::rds3000
