#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "firmware/half_space/host/plane_program.h"
#include "models/parts/host/host_port.h"
#include "sim/scene/plane_set.h"
#include "sim/scene/scene.h"

namespace dendro::half_space {

/// A scene made ready for the host program: planes in the world, on the screen, and as records.
struct Prepared {
  scene::PlaneSet world;            ///< one per plane of the object, in its order
  std::vector<ScreenPlane> screen;  ///< same order
  PlaneProgram program;
  std::uint64_t setup_flops = 0;   ///< floating-point operations of S2 and S4 on the host computer
  Work growth;                     ///< of splitting normals on the host computer (S1)
  std::vector<std::string> files;  ///< what was read
};

/// Steps S2 and S4 for the scene's one object. Throws UserError for everything that the algorithm or the
/// frame buffer cannot do: camera, image size, more or fewer than one object, more than one light, plane
/// counts, unbounded or empty sets, more than 255 front faces, an object outside the picture, wrong or
/// unknown options.
Prepared prepare(const scene::Scene& scene);

}  // namespace dendro::half_space
