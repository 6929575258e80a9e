#pragma once

#include <cstdint>
#include <vector>

#include "firmware/half_space/host/growth.h"
#include "sim/scene/scene.h"

namespace dendro::half_space {

/// One tree of a scene's object: how it is grown, and where it stands.
struct Tree {
  GrowthParameters growth;
  scene::Object placed;  ///< the object with the place, turn and size of this copy
};

/// Reads the parameters of an object that is a tree (README: keys, defaults, ranges) and lays out its copies.
/// `seed` is used where the object has none of its own. Throws UserError.
std::vector<Tree> trees_of(const scene::Object& object, std::uint64_t seed);

/// The kinds that `tree` may name.
const std::vector<std::string>& tree_kinds();

/// Start normals of a kind: the cube's axes for 6, directions spread evenly for other counts, all of length
/// `radius`; a pine's are stretched upwards.
std::vector<glm::dvec3> start_normals(const std::string& kind, int count, double radius);

}  // namespace dendro::half_space
