#pragma once

#include <string>
#include <vector>

#include "sim/scene/plane_set.h"
#include "sim/scene/scene.h"

namespace dendro::half_space {

/// The object as half-spaces in world space, and the files read for it. Reads the options `planes`,
/// `plane_source` and `directions`. Throws UserError for a mesh or list that gives no such planes.
struct ObjectPlanes {
  scene::PlaneSet planes;
  std::vector<std::string> files;
};

ObjectPlanes object_planes(const scene::Object& object, scene::Options& options);

}  // namespace dendro::half_space
