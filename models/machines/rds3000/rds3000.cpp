#include "models/machines/rds3000/rds3000.h"

#include <algorithm>

#include "models/machines/rds3000/boundaries.h"
#include "models/machines/rds3000/clocked.h"
#include "models/machines/rds3000/cycle.h"
#include "models/machines/rds3000/function.h"
#include "models/machines/rds3000/host_recorder.h"
#include "models/machines/rds3000/pixel_cost.h"
#include "models/machines/rds3000/timeline.h"

namespace dendro::rds3000 {
namespace {

Picture picture_of(const video::State& video, const dr64::Core& memory) {
  video::Frame frame = video::monitor(video, memory);
  return {frame.width, frame.height, std::move(frame.rgb)};
}

class FunctionMachine : public Machine {
 public:
  FunctionMachine(const Spec& spec, const MachineOptions& options) : spec_(spec), options_(options), engine_(spec, options) {}

  void run(const std::function<void(HostPort&)>& host_program) override { host_program(engine_); }
  double clock_hz() const override { return 1e12 / static_cast<double>(spec_.processor.tick_ps); }
  std::int64_t cycles() const override { return 0; }
  std::int64_t machine_cycles() const override { return 0; }
  std::uint64_t instructions() const override { return engine_.words(); }
  std::vector<Phase> phases() const override { return {}; }
  std::vector<UnitStats> units() const override { return {}; }
  std::vector<MarkEvent> marks() const override { return engine_.marks(); }
  std::vector<std::pair<std::string, std::uint64_t>> executions() const override {
    std::vector<std::pair<std::string, std::uint64_t>> counts;
    for (const auto& [index, name] : options_.counted) counts.emplace_back(name, engine_.executions().at(index));
    return counts;
  }
  std::vector<std::string> elaborated() const override {
    return {"rds3000.processor", "rds3000.frame_memory", "rds3000.video"};
  }
  bool time_dependent() const override { return engine_.time_dependent(); }
  Picture picture() const override { return picture_of(engine_.devices().video, engine_.devices().memory); }
  std::uint32_t peek(std::uint32_t address, unsigned function) const override {
    return engine_.peek(address, function);
  }

 private:
  Spec spec_;
  MachineOptions options_;
  FunctionEngine engine_;
};

class TimedMachine : public Machine {
 public:
  TimedMachine(const Spec& spec, Level level, const MachineOptions& options) : spec_(spec), options_(options) {
    sc_core::sc_set_time_resolution(1, sc_core::SC_PS);
    if (level == Level::kClocked) {
      engine_ = std::make_unique<ClockedEngine>("rds3000", spec, options);
    } else {
      engine_ = std::make_unique<CycleEngine>(spec, options);
    }
    engine_->set_marks(options.marks);
    engine_->set_programs(options.programs);
  }

  void run(const std::function<void(HostPort&)>& host_program) override {
    if (options_.recorder && options_.recorder->boundary() == kHostBoundary) {
      host_recorder_ = std::make_unique<HostRecorder>(*options_.recorder, spec_, *engine_);
      shell_ = std::make_unique<ik11b::Shell>("host", spec_.host, *host_recorder_,
                                              [&](HostPort& port) { host_recorder_->run(port, host_program); });
    } else {
      shell_ = std::make_unique<ik11b::Shell>("host", spec_.host, *engine_, host_program);
    }
    sc_core::sc_start();
    if (shell_->error()) std::rethrow_exception(shell_->error());
    end_ = (shell_->ended_ps() + spec_.processor.tick_ps - 1) / spec_.processor.tick_ps;
    engine_->finish(end_);
  }

  double clock_hz() const override { return 1e12 / static_cast<double>(spec_.processor.tick_ps); }
  std::int64_t cycles() const override { return end_; }
  std::int64_t machine_cycles() const override {
    return end_ - static_cast<std::int64_t>(engine_->processor_counters().idle);
  }
  std::uint64_t instructions() const override { return engine_->processor_counters().busy; }
  std::vector<Phase> phases() const override {
    return timeline(shell_->phases(), spec_.processor.tick_ps, engine_->runs(), engine_->marks(), end_);
  }
  std::vector<UnitStats> units() const override;
  std::vector<MarkEvent> marks() const override { return engine_->marks(); }
  std::vector<std::string> elaborated() const override {
    std::vector<std::string> units{"rds3000.processor", "rds3000.bus", "rds3000.frame_memory", "rds3000.host"};
    if (spec_.video.mode != video::DisplayMode::kBlanked || options_.all_units) units.push_back("rds3000.video");
    return units;
  }
  bool time_dependent() const override { return engine_->time_dependent(); }
  Picture picture() const override { return picture_of(engine_->video(), engine_->memory()); }
  PixelCosts costs() const override;
  std::uint32_t peek(std::uint32_t address, unsigned function) const override {
    return engine_->peek(address, function);
  }

 private:
  Spec spec_;
  MachineOptions options_;
  std::unique_ptr<Engine> engine_;
  std::unique_ptr<HostRecorder> host_recorder_;
  std::unique_ptr<ik11b::Shell> shell_;
  std::int64_t end_ = 0;
};

std::vector<UnitStats> TimedMachine::units() const {
  const auto total = static_cast<std::uint64_t>(end_);
  const ProcessorCounters& p = engine_->processor_counters();
  const BusCounters& b = engine_->bus_counters();
  const MemoryCounters& m = engine_->memory_counters();
  const std::uint64_t cards = spec_.memory.cards();
  const std::uint64_t memory_busy = m.busy_access + m.busy_video + m.busy_refresh;
  const std::uint64_t host_busy = shell_->busy_ps() / static_cast<std::uint64_t>(spec_.processor.tick_ps);
  std::vector<UnitStats> units{
      {"rds3000.processor",
       {{"cycles", total}, {"busy", p.busy}, {"stall_host", p.stall_host}, {"stall_branch", p.stall_branch},
        {"stall_data", p.stall_data}, {"stall_bus", p.stall_bus}, {"stall_scratch", p.stall_scratch},
        {"idle", p.idle}}},
      {"rds3000.bus",
       {{"cycles", total}, {"busy", b.busy}, {"idle", total - b.busy}, {"processor_reads", b.processor_reads},
        {"processor_writes", b.processor_writes}, {"host_reads", b.host_reads}, {"host_writes", b.host_writes}}},
      // Card-ticks: every card counts every tick.
      {"rds3000.frame_memory",
       {{"cycles", total * cards}, {"busy", memory_busy}, {"idle", total * cards - memory_busy},
        {"busy_access", m.busy_access}, {"busy_video", m.busy_video}, {"busy_refresh", m.busy_refresh},
        {"reads", m.reads}, {"writes", m.writes}, {"masked_writes", m.masked_writes}, {"fetches", m.fetches},
        {"refreshes", m.refreshes}, {"wait_ticks", m.wait_ticks}}},
      {"rds3000.host",
       {{"cycles", total}, {"busy", host_busy}, {"idle", total - host_busy}, {"dma_words", shell_->dma_words()}}}};
  return units;
}

PixelCosts TimedMachine::costs() const {
  PixelCosts costs;
  const PixelCost* account = engine_->cost();
  if (account == nullptr) return costs;
  costs.elsewhere = account->elsewhere();
  const std::vector<std::uint32_t> shown = video::shown_pixels(engine_->video());
  std::vector<bool> seen(account->ticks().size(), false);
  for (const std::uint32_t pixel : shown) {
    costs.ticks.push_back(static_cast<float>(account->ticks()[pixel]));
    costs.visits.push_back(static_cast<float>(account->visits()[pixel]));
    seen[pixel] = true;
  }
  for (std::size_t pixel = 0; pixel < seen.size(); ++pixel)
    if (!seen[pixel]) costs.elsewhere += account->ticks()[pixel];
  return costs;
}

std::unique_ptr<Machine> make(const config::ParameterSet& parameters, Level level, const MachineOptions& options) {
  const Spec spec = resolve(parameters);
  if (level == Level::kFunction) return std::make_unique<FunctionMachine>(spec, options);
  return std::make_unique<TimedMachine>(spec, level, options);
}

}  // namespace

MachineType rds3000_type() {
  MachineType type;
  type.name = "rds3000";
  type.summary = "Adage RDS-3000: bit-slice processor, 512x512x24 frame buffer, VAX-11/780 host (FG86)";
  type.presets = {"fg86", "32-bit", "48-bit", "big-store"};
  type.levels = {Level::kFunction, Level::kCycle, Level::kClocked};
  type.folder = "models/machines/rds3000";
  type.make = make;
  type.boundaries = boundaries();
  type.replay = [](const config::ParameterSet& parameters, Level level, trace::Reader& trace) {
    return replay(resolve(parameters), level, trace);
  };
  return type;
}

}  // namespace dendro::rds3000
