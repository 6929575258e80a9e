#pragma once

#include "firmware/lib/pixel_planes/igc_driver.h"
#include "firmware/raster_primitives/host/prepare.h"
#include "models/parts/host/host_port.h"

namespace dendro::raster_primitives {

/// Values of the controller's registers by name, the same from the first command to the last.
std::map<std::string, unsigned> register_values(const Layout& layout);

/// Draws the scene and waits until the machine is idle.
void run(HostPort& host, const Prepared& prepared, const lib::IgcPrograms& programs, const lib::ArraySite& site);

}  // namespace dendro::raster_primitives
