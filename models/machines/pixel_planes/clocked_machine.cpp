#include <algorithm>

#include "models/machines/pixel_planes/clocked.h"
#include "models/machines/pixel_planes/frame_store.h"
#include "models/machines/pixel_planes/pixel_planes_map.h"
#include "models/machines/pixel_planes/units.h"

namespace dendro::pixel_planes {
namespace {

class ClockedMachine : public Machine {
 public:
  ClockedMachine(const Spec& spec, const MachineOptions& options) : spec_(spec) {
    sc_core::sc_set_time_resolution(1, sc_core::SC_PS);
    engine_ = std::make_unique<ClockedEngine>("pixel_planes", spec, options);
  }

  void run(const std::function<void(HostPort&)>& host_program) override { engine_->simulate(host_program); }
  double clock_hz() const override { return 1e12 / static_cast<double>(spec_.tick_ps); }
  std::int64_t cycles() const override { return engine_->clocks(); }
  std::int64_t machine_cycles() const override {
    std::uint64_t idle = static_cast<std::uint64_t>(engine_->clocks());
    for (const ClockedRenderer& renderer : engine_->renderers()) idle = std::min(idle, renderer.counters.idle);
    return engine_->clocks() - static_cast<std::int64_t>(idle);
  }
  std::uint64_t instructions() const override {
    std::uint64_t words = 0;
    for (const ClockedRenderer& renderer : engine_->renderers()) words += renderer.counters.busy;
    return words;
  }
  std::vector<Phase> phases() const override;
  std::vector<UnitStats> units() const override;
  std::vector<MarkEvent> marks() const override { return {}; }
  std::vector<std::string> elaborated() const override { return unit_names(engine_->renderers().size()); }
  bool time_dependent() const override { return engine_->time_read(); }
  Picture picture() const override;
  std::uint32_t peek(std::uint32_t address, unsigned function) const override;

 private:
  Spec spec_;
  std::unique_ptr<ClockedEngine> engine_;
};

std::vector<Phase> ClockedMachine::phases() const {
  std::vector<Phase> phases;
  const auto add = [&](const std::string& name, std::int64_t clocks, bool on_host) {
    if (clocks == 0) return;
    const bool same = !phases.empty() && phases.back().name == name && phases.back().on_host == on_host;
    if (!same) phases.push_back({name, 0, on_host});
    phases.back().cycles += clocks;
  };
  const auto& host = engine_->host_phases();
  std::string name = "host";
  std::size_t next = 0;
  std::int64_t at = 0;
  const auto host_until = [&](std::int64_t end) {
    while (at < end) {
      while (next < host.size() && host[next].from <= at) name = host[next++].name;
      const std::int64_t until = next < host.size() ? std::min(end, host[next].from) : end;
      add(name, until - at, true);
      at = until;
    }
  };
  for (const ClockedEngine::Stretch& stretch : engine_->machine_phases()) {
    host_until(stretch.from);
    add(stretch.name, stretch.to - stretch.from, false);
    at = stretch.to;
  }
  host_until(engine_->clocks());
  return phases;
}

std::vector<UnitStats> ClockedMachine::units() const {
  const auto total = static_cast<std::uint64_t>(engine_->clocks());
  const std::vector<std::string> names = unit_names(engine_->renderers().size());
  std::vector<UnitStats> units;
  FifoCounters fifo;
  for (const ClockedRenderer& renderer : engine_->renderers()) {
    const std::size_t at = units.size();
    add_units(names[at], names[at + 1], total, renderer.counters, renderer.fifo_counters.commands, units);
    fifo.words += renderer.fifo_counters.words, fifo.full_clocks += renderer.fifo_counters.full_clocks;
  }
  const std::uint64_t host_busy =
      std::min(total, static_cast<std::uint64_t>(engine_->host_busy_ps() / spec_.tick_ps));
  units.push_back(host_unit(total, host_busy, fifo));
  return units;
}

std::uint32_t ClockedMachine::peek(std::uint32_t address, unsigned function) const {
  return engine_->peek(address, function);
}

Picture ClockedMachine::picture() const {
  const VideoState& video = engine_->video();
  const bool frame = spec_.frame.exists();
  const int width = frame ? spec_.frame.width : spec_.array.width;
  return shown(video, width, frame ? spec_.frame.height : spec_.array.height, [&](int x, int y) {
    return peek((frame ? kFramePixels : 0) + static_cast<std::uint32_t>(y * width + x), video.base);
  });
}

}  // namespace

std::unique_ptr<Machine> make_clocked(const Spec& spec, const MachineOptions& options) {
  return std::make_unique<ClockedMachine>(spec, options);
}

}  // namespace dendro::pixel_planes
