#pragma once

#include <string>
#include <vector>

#include "firmware/half_space/host/growth.h"
#include "sim/scene/plane_set.h"
#include "sim/scene/scene.h"

namespace dendro::half_space {

/// One convex object as half-spaces in world space, and the files read for it.
struct ObjectPlanes {
  scene::PlaneSet planes;
  std::vector<std::string> files;
  bool grown = false;     ///< a tree: may be unbounded, `bound` and `growth` hold
  scene::PlaneSet bound;  ///< trees: the relaxed start planes, which contain the crown
  Grown growth;           ///< in the tree's own axes
  glm::dvec3 centre{};    ///< trees: where the start normals begin, and how far the longest reaches
  double reach = 0;
  std::vector<glm::dvec3> trunk_points;  ///< meshes with groups.trunk: corners of that group in world space
};

/// The convex objects of an object of the scene: one, or the copies of a tree. Reads the options `planes`,
/// `plane_source` and `directions`; `seed` is for a tree that has none of its own. Throws UserError for a
/// mesh, list or tree that gives no such planes.
std::vector<ObjectPlanes> object_planes(const scene::Object& object, scene::Options& options,
                                        std::uint64_t seed);

/// The key of the scene that says what the object is: "object.mesh", ...
const char* source_key(const scene::Object& object);

/// Throws UserError for options of meshes in a scene without any.
void check_mesh_options(const scene::Scene& scene, const scene::Options& options);

}  // namespace dendro::half_space
