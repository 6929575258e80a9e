#pragma once

#include <cstddef>
#include <string>

#include "sim/scene/image_io.h"
#include "sim/study/run.h"

namespace dendro::study {

/// Most windows in which a timeline shows the activity of units; there are more than half as many.
constexpr std::size_t kTimelineWindows = 1000;

/// A run as a Chrome trace for Perfetto: its phases one after another on the tracks `host` and `machine`, its marks, for
/// every unit how its time was spent over the whole run, and counters that say the same of short windows (percent of the
/// window's ticks). The run was made with MachineOptions::activity.
std::string timeline_json(const RunOutput& run);

/// How busy every unit is, window by window: a curve each.
scene::RgbImage timeline_picture(const RunOutput& run);

}  // namespace dendro::study
