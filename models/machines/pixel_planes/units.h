#pragma once

#include <string>
#include <vector>

#include "models/machines/machine.h"
#include "models/machines/pixel_planes/pixel_planes_state.h"

namespace dendro::pixel_planes {

/// "pixel_planes.controller", "pixel_planes.array"; of several renderers with their numbers behind; then the host's.
std::vector<std::string> unit_names(std::size_t renderers);

/// A renderer's two units.
void add_units(const std::string& controller, const std::string& array, std::uint64_t cycles, const ControllerCounters& counters,
               std::uint64_t commands, std::vector<UnitStats>& units);

/// `fifo`: sums over all renderers.
UnitStats host_unit(std::uint64_t cycles, std::uint64_t busy, const FifoCounters& fifo);

}  // namespace dendro::pixel_planes
