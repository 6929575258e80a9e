#pragma once

#include "sim/study/algorithms.h"

namespace dendro::study {

/// FGHS85's primitives on Pixel-Planes.
Algorithm raster_primitives_algorithm();

/// Its micro-programs, as pictures with none, spheres, shadows, or both need them.
std::vector<Firmware> raster_primitives_firmware();

}  // namespace dendro::study
