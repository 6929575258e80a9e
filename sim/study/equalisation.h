#pragma once

#include "sim/study/algorithms.h"

namespace dendro::study {

/// FGHS85's adaptive histogram equalisation on Pixel-Planes.
Algorithm equalisation_algorithm();

/// Its micro-programs.
Firmware equalisation_firmware();

}  // namespace dendro::study
