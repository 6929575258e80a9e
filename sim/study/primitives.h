#pragma once

#include "sim/study/algorithms.h"

namespace dendro::study {

/// FGHS85's primitives on Pixel-Planes.
Algorithm raster_primitives_algorithm();

}  // namespace dendro::study
