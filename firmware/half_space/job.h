#pragma once

#include <functional>
#include <memory>
#include <string>

#include "firmware/job.h"
#include "firmware/lib/rds3000/rds_driver.h"
#include "sim/scene/scene.h"

namespace dendro::half_space {

using lib::ProgramImage;

/// What the host program must know of the RDS-3000 it drives.
struct Site {
  std::uint32_t scratch_words = 8192;
  bool repeat_field = false;  ///< the display shows every line in both fields
  std::uint32_t control_store_words = 4096;
  unsigned pixel_bits = 24;
};

/// The job that draws `scene` with the microprogram. Throws UserError for everything that prepare() or
/// check_fits() refuse.
std::unique_ptr<Job> make_job(const scene::Scene& scene, ProgramImage image, const Site& site = {});

/// The job that draws `scene`, one hull or more, with the microprogram for three registers (hulls.gia).
std::unique_ptr<Job> make_hulls_job(const scene::Scene& scene, ProgramImage image, const Site& site = {});

/// A microprogram of this folder, assembled for the machine at hand, by its name: "hulls", "roughen", ...
using ProgramSource = std::function<ProgramImage(const std::string& name)>;

/// The job that draws `scene`, complete trees with texture, roughness or trunks. Asks only for programs that
/// it needs.
std::unique_ptr<Job> make_tree_job(const scene::Scene& scene, const ProgramSource& program,
                                   const Site& site = {});

/// True when the scene takes make_tree_job. Throws UserError.
bool is_complete_tree(const scene::Scene& scene);

/// True when the scene, if no complete tree, takes make_hulls_job. Throws UserError.
bool needs_three_registers(const scene::Scene& scene);

}  // namespace dendro::half_space
