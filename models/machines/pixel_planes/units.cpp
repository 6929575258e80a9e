#include "models/machines/pixel_planes/units.h"

namespace dendro::pixel_planes {

std::vector<std::string> unit_names(std::size_t renderers) {
  std::vector<std::string> names;
  for (std::size_t r = 0; r < renderers; ++r) {
    const std::string number = renderers > 1 ? std::to_string(r) : "";
    names.push_back("pixel_planes.controller" + number);
    names.push_back("pixel_planes.array" + number);
  }
  names.emplace_back("pixel_planes.host");
  return names;
}

void add_units(const std::string& controller, const std::string& array, std::uint64_t cycles, const ControllerCounters& c,
               std::uint64_t commands, std::vector<UnitStats>& units) {
  units.push_back({controller,
                   {{"cycles", cycles}, {"busy", c.busy}, {"stall_refresh", c.stall_refresh}, {"stall_video", c.stall_video},
                    {"stall_translator", c.stall_translator}, {"stall_drain", c.stall_drain}, {"idle", c.idle},
                    {"commands", commands}}});
  units.push_back({array, {{"cycles", cycles}, {"busy", c.busy}, {"idle", cycles - c.busy}}});
}

UnitStats host_unit(std::uint64_t cycles, std::uint64_t busy, const FifoCounters& fifo) {
  return {"pixel_planes.host",
          {{"cycles", cycles}, {"busy", busy}, {"idle", cycles - busy}, {"fifo_words", fifo.words},
           {"fifo_full_clocks", fifo.full_clocks}}};
}

}  // namespace dendro::pixel_planes
