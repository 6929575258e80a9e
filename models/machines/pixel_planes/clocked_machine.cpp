#include <algorithm>

#include "models/machines/pixel_planes/clocked.h"

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
    return engine_->clocks() - static_cast<std::int64_t>(engine_->controller_counters().idle);
  }
  std::uint64_t instructions() const override { return engine_->controller_counters().busy; }
  std::vector<Phase> phases() const override;
  std::vector<UnitStats> units() const override;
  std::vector<MarkEvent> marks() const override { return {}; }
  std::vector<std::string> elaborated() const override {
    return {"pixel_planes.controller", "pixel_planes.array", "pixel_planes.host"};
  }
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
  const ControllerCounters& c = engine_->controller_counters();
  const FifoCounters& f = engine_->fifo_counters();
  const std::uint64_t host_busy =
      std::min(total, static_cast<std::uint64_t>(engine_->host_busy_ps() / spec_.tick_ps));
  return {{"pixel_planes.controller",
           {{"cycles", total},
            {"busy", c.busy},
            {"stall_refresh", c.stall_refresh},
            {"stall_video", c.stall_video},
            {"stall_translator", c.stall_translator},
            {"stall_drain", c.stall_drain},
            {"idle", c.idle},
            {"commands", f.commands}}},
          {"pixel_planes.array", {{"cycles", total}, {"busy", c.busy}, {"idle", total - c.busy}}},
          {"pixel_planes.host",
           {{"cycles", total},
            {"busy", host_busy},
            {"idle", total - host_busy},
            {"fifo_words", f.words},
            {"fifo_full_clocks", f.full_clocks}}}};
}

std::uint32_t ClockedMachine::peek(std::uint32_t address, unsigned function) const {
  const auto width = static_cast<std::uint32_t>(spec_.array.width);
  if (address >= static_cast<std::uint32_t>(spec_.pixels())) return 0;
  return engine_->planes().memory_word(function, address % width, address / width);
}

Picture ClockedMachine::picture() const {
  const VideoState& video = engine_->video();
  Picture picture;
  picture.width = video.width == 0 ? spec_.array.width : std::min(video.width, spec_.array.width);
  picture.height = video.height == 0 ? spec_.array.height : std::min(video.height, spec_.array.height);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const std::uint32_t colour = peek(static_cast<std::uint32_t>(y * spec_.array.width + x), video.base);
      for (unsigned channel = 0; channel < 3; ++channel)
        picture.rgb.push_back(static_cast<std::uint8_t>(colour >> (8 * channel)));
    }
  }
  return picture;
}

}  // namespace

std::unique_ptr<Machine> make_clocked(const Spec& spec, const MachineOptions& options) {
  return std::make_unique<ClockedMachine>(spec, options);
}

}  // namespace dendro::pixel_planes
