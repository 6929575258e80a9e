#pragma once

#include "models/machines/machine.h"

namespace dendro::pixel_planes {

/// Pixel-Planes: presets pxpl4, pxpl4-8mhz, pxpl5; levels function, cycle, clocked.
MachineType pixel_planes_type();

}  // namespace dendro::pixel_planes
