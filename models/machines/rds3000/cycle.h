#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "models/machines/rds3000/devices.h"
#include "models/machines/rds3000/engine.h"
#include "models/machines/rds3000/pixel_cost.h"
#include "models/machines/rds3000/recorder.h"
#include "models/parts/bps32/bps32_timing.h"
#include "models/parts/dr64/dr64_timing.h"

namespace dendro::rds3000 {

/// The `cycle` level: the processor strides from one tick to the next word that can execute, memory and video are
/// closed forms, and nothing happens until the host acts or waits. Exact: equal to ClockedEngine in every tick.
class CycleEngine : public Engine {
 public:
  CycleEngine(const Spec& spec, const MachineOptions& options);

  std::uint32_t transfer(bool write, std::uint32_t address, std::uint32_t data, unsigned function) override;
  void command(bool run, bool reset) override;
  void host_sleeps() override;
  sc_core::sc_event& interrupt_event() override { return interrupt_event_; }
  bool interrupt() const override { return processor_.interrupt; }
  void clear_interrupt() override { processor_.interrupt = false; }
  bool running() const override { return processor_.running; }
  void finish(std::int64_t end) override;

  const ProcessorState& processor() const override { return processor_; }
  const ProcessorCounters& processor_counters() const override { return counters_; }
  const BusCounters& bus_counters() const override { return bus_counters_; }
  const MemoryCounters& memory_counters() const override { return timing_.counters(); }
  const dr64::Core& memory() const override { return devices_.memory; }
  const video::State& video() const override { return devices_.video; }
  const PixelCost* cost() const override { return cost_.get(); }

 private:
  friend struct CyclePort;
  friend struct RecordingPort;
  friend struct CostPort;

  std::int64_t now_tick() const;
  void wait_until(std::int64_t tick);

  void run_until(std::int64_t end);
  void run_to(std::int64_t end);
  ProcessorCounters counters_before(std::int64_t tick) const;
  void stride(std::int64_t end);
  template <class Port>
  void stride_with(Port port, std::int64_t end);
  void run_recorded(std::int64_t end);
  void reach(std::int64_t tick);
  bool hold(const bps32::Decoded& word, std::int64_t end);
  std::uint64_t& counter(bps32::Cause cause);
  void passed(const bps32::Decoded& word);
  void stopped(std::int64_t at);
  void find_loop();
  void decode(std::size_t word);

  void start_pixel_access(bool write, bool masked);
  std::int64_t start_access(bool write, std::uint32_t address, unsigned function);
  void book_access(bool write, std::int64_t asked, std::int64_t granted, int read_ticks);
  std::int64_t grant(std::int64_t at, bool write, std::uint32_t address, unsigned function, int& read_ticks);
  void change_video(std::uint32_t address, std::int64_t tick);
  std::int64_t tick_ps() const { return spec_.processor.tick_ps; }

  Spec spec_;
  MachineOptions options_;
  ProcessorState processor_;
  Devices devices_;
  dr64::Timing timing_;
  video::Phase raster_, raster_before_;
  std::int64_t raster_from_ = INT64_MIN;  ///< raster_ holds for later ticks, raster_before_ up to this one

  std::vector<bps32::Decoded> decoded_;
  ProcessorCounters counters_;
  BusCounters bus_counters_;
  sc_core::sc_event interrupt_event_;

  std::int64_t now_ = 0;            ///< next tick the processor has not lived through, while it runs
  std::int64_t run_from_ = 0;
  std::int64_t bus_free_ = 0;
  bps32::Holds holds_;
  std::unique_ptr<Recorder> recorder_;  ///< or nothing
  std::unique_ptr<PixelCost> cost_;  ///< only when it was asked for
};

}  // namespace dendro::rds3000
