#pragma once

#include <memory>

#include "firmware/job.h"
#include "firmware/lib/pixel_planes/igc_driver.h"
#include "firmware/raster_primitives/host/prepare.h"

namespace dendro::raster_primitives {

/// The job that draws `scene` on a Pixel-Planes machine. Throws UserError for everything that prepare() refuses.
std::unique_ptr<Job> make_job(const scene::Scene& scene, lib::IgcPrograms programs, const ArraySite& site);

}  // namespace dendro::raster_primitives
