#pragma once

#include <memory>

#include "firmware/job.h"
#include "firmware/lib/rds3000/rds_driver.h"
#include "sim/scene/scene.h"

namespace dendro::half_space {

using lib::ProgramImage;

/// What the host program must know of the RDS-3000 it drives.
struct Site {
  std::uint32_t scratch_words = 8192;
  bool repeat_field = false;  ///< the display shows every line in both fields
};

/// The job that draws `scene` with the microprogram. Throws UserError for everything that prepare() or check_fits()
/// refuse.
std::unique_ptr<Job> make_job(const scene::Scene& scene, ProgramImage image, const Site& site = {});

/// The job that draws `scene`, one hull or more, with the microprogram for three registers (hulls.gia).
std::unique_ptr<Job> make_hulls_job(const scene::Scene& scene, ProgramImage image, const Site& site = {});

/// True when the scene takes make_hulls_job. Throws UserError.
bool needs_three_registers(const scene::Scene& scene);

}  // namespace dendro::half_space
