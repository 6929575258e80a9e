#pragma once

#include <memory>

#include "firmware/half_space/host/rds_driver.h"
#include "firmware/job.h"
#include "sim/scene/scene.h"

namespace dendro::half_space {

/// The job that draws `scene` with the microprogram on an RDS-3000 with `scratch_words` of scratchpad. Throws
/// UserError for everything that prepare() or check_fits() refuse.
std::unique_ptr<Job> make_job(const scene::Scene& scene, ProgramImage image,
                              std::uint32_t scratch_words = 8192);

}  // namespace dendro::half_space
