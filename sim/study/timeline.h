#pragma once

#include <string>

#include "sim/stats/run_object.h"

namespace dendro::study {

/// A run's phases on the tracks `host` and `machine`, its marks, and for every unit how its time was spent over the
/// whole run (percent), as a Chrome trace for Perfetto.
std::string timeline_json(const stats::RunObject& run);

}  // namespace dendro::study
