#pragma once

#include "sim/study/algorithms.h"

namespace dendro::study {

/// The entry of the list of algorithms.
Algorithm zbuffer_views_algorithm();

/// What `dendro firmware` lists of it.
std::vector<Firmware> zbuffer_views_firmware();

}  // namespace dendro::study
