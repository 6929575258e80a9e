#pragma once

#include <memory>

#include "firmware/half_space/pixel_planes/prepare_planes.h"
#include "firmware/job.h"

namespace dendro::half_space {

/// The job that draws `scene` on a Pixel-Planes machine. Throws UserError for everything that prepare_planes() refuses.
std::unique_ptr<Job> make_planes_job(const scene::Scene& scene, lib::IgcPrograms programs, const ArraySite& site);

}  // namespace dendro::half_space
