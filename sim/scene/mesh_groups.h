#pragma once

#include <string>
#include <vector>

#include "sim/scene/mesh.h"
#include "sim/scene/scene.h"

namespace dendro::scene {

/// For every triangle of the object's mesh, whether it is in a group that the object's pattern (shell wildcards) for `meaning`
/// names; `meaning` must be a key of the object's groups. Throws UserError with the names there are when no group matches.
std::vector<bool> triangles_in_groups(const Mesh& mesh, const Object& object, const std::string& meaning);

}  // namespace dendro::scene
