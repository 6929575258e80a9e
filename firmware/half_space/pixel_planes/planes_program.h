#pragma once

#include "firmware/half_space/pixel_planes/prepare_planes.h"
#include "firmware/lib/pixel_planes/igc_driver.h"

namespace dendro::half_space {

/// What the host of a Pixel-Planes machine does: loads the micro-programs, clears, then streams the hulls one after
/// another: back, edge-on and front planes, the test against the nearest depth, the colours.
void run(HostPort& host, const PreparedPlanes& prepared, const lib::IgcPrograms& programs, const lib::ArraySite& site);

}  // namespace dendro::half_space
