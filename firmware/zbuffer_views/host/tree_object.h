#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "firmware/zbuffer_views/host/prepared.h"
#include "sim/scene/scene.h"

namespace dendro::zbuffer_views {

/// "fir" and "magnolia".
const std::vector<std::string>& tree_kinds();

/// The triangles of an object, grown or read, in the object's scale and units but not at its place. Throws UserError. `seed` is
/// that of trees without one.
TreeModel model_of(const scene::Object& object, std::uint64_t seed);

/// True if two objects differ in place and rotation only.
bool same_tree(const scene::Object& a, const scene::Object& b);

/// Centre and extents of a model; its colour table is trunk, branch, leaf, and the leaves' lower side.
Tree tree_of(TreeModel model, const std::array<Rgb, 4>& colours);

}  // namespace dendro::zbuffer_views
