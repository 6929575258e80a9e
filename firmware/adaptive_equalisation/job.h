#pragma once

#include <memory>

#include "firmware/adaptive_equalisation/host/prepare.h"
#include "firmware/job.h"

namespace dendro::adaptive_equalisation {

/// The job that equalises the scene's picture on a Pixel-Planes machine. Throws UserError for everything that prepare() refuses.
std::unique_ptr<Job> make_job(const scene::Scene& scene, lib::IgcPrograms programs, const lib::ArraySite& site);

}  // namespace dendro::adaptive_equalisation
