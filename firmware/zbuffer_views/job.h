#pragma once

#include <memory>

#include "firmware/job.h"
#include "sim/scene/scene.h"

namespace dendro::zbuffer_views {

/// Programs for a workstation and what they are made from; `suffix` is that of the variant ("-O1-unmapped").
struct Programs {
  std::string suffix;
  std::vector<FirmwareImage> images;  ///< precompute, reconstruct, polygons, in this order
};

/// The variant of the programs that the scene asks for: keys `compiler`, `mapped`. Throws UserError.
std::string program_suffix(const scene::Scene& scene);

/// The job that draws `scene` with those programs. Throws UserError for everything that prepare() refuses and for saved views
/// that do not suit.
std::unique_ptr<ProgramJob> make_job(const scene::Scene& scene, Programs programs);

}  // namespace dendro::zbuffer_views
