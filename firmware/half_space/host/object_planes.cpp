#include "firmware/half_space/host/object_planes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "firmware/half_space/host/tree_object.h"
#include "sim/base/error.h"
#include "sim/scene/mesh.h"
#include "sim/scene/mesh_groups.h"
#include "sim/scene/view.h"

namespace dendro::half_space {
namespace {

/// The scratchpad's 8K words hold no more, whatever the kinds; check_fits() knows what the program leaves of
/// them.
constexpr int kMostPlanes = 2048;

/// What a mesh's hull is merged down to unless the scene says otherwise: with many more facets neighbours
/// meet at less than a depth unit a pixel, and a 12-bit register cannot tell which of two faces is in front.
constexpr std::size_t kDefaultPlanes = 32;

[[noreturn]] void blame(const scene::Object& object, const std::string& key, const std::string& message) {
  throw UserError(object.source_where.file, object.source_where.line, key, message);
}

/// The corners of the triangles in the groups that the object's pattern for `meaning` names.
std::vector<glm::dvec3> points_of(const scene::Mesh& mesh, const scene::Object& object,
                                  const std::string& meaning) {
  const std::vector<bool> in_group = scene::triangles_in_groups(mesh, object, meaning);
  std::vector<bool> wanted(mesh.vertices.size(), false);
  for (std::size_t i = 0; i < in_group.size(); ++i)
    if (in_group[i])
      for (const std::uint32_t corner : mesh.triangles[i]) wanted[corner] = true;
  std::vector<glm::dvec3> points;
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (wanted[i]) points.push_back(mesh.vertices[i]);
  return points;
}

/// What the hull is drawn around: the groups named in groups.crown, else all of the mesh.
std::vector<glm::dvec3> crown_of(const scene::Mesh& mesh, const scene::Object& object) {
  for (const auto& [meaning, pattern] : object.groups)
    if (meaning != "crown" && meaning != "trunk")
      blame(object, "object.groups", fmt::format("\"{}\" is not known; must be crown or trunk", meaning));
  return object.groups.count("crown") != 0 ? points_of(mesh, object, "crown") : mesh.vertices;
}

scene::PlaneSet mesh_planes(const scene::Object& object, scene::Options& options, ObjectPlanes& result) {
  const auto count = static_cast<std::size_t>(options.integer("planes", 0, 4, kMostPlanes));
  const std::string source = options.choice("plane_source", "hull", {"hull", "support"});
  std::vector<glm::dvec3> directions;
  for (const std::vector<double>& row : options.vectors("directions", 3)) {
    directions.emplace_back(row[0], row[1], row[2]);
    if (!(glm::length(directions.back()) > 0)) options.fail("directions", "a direction must not be zero");
  }
  if (!directions.empty() && source != "support")
    options.fail("directions", "goes with plane_source = \"support\" only");
  if (!directions.empty() && options.has("planes") && count != directions.size())
    options.fail("planes",
                 fmt::format("{} planes are wanted but {} directions are given", count, directions.size()));

  const scene::Mesh mesh = scene::load_mesh(object.mesh, object.source_where, "object.mesh");
  result.files = mesh.files;
  const std::vector<glm::dvec3> vertices = crown_of(mesh, object);
  if (object.groups.count("trunk") != 0) {
    const scene::Placement place(object);
    for (const glm::dvec3& p : points_of(mesh, object, "trunk")) result.trunk_points.push_back(place(p));
  }
  if (source == "support") {
    if (directions.empty() && count == 0) options.fail("planes", "is needed with plane_source = \"support\"");
    return scene::support_planes(vertices, directions.empty() ? scene::sphere_directions(count) : directions);
  }
  try {
    scene::PlaneSet planes = scene::hull_planes(vertices, count);
    if (options.has("planes") || planes.size() <= kDefaultPlanes) return planes;
    return scene::hull_planes(vertices, kDefaultPlanes);
  } catch (const std::invalid_argument& error) {
    if (options.has("planes")) options.fail("planes", fmt::format("{}: {}", object.mesh, error.what()));
    blame(object, "object.mesh", fmt::format("{}: {}", object.mesh, error.what()));
  }
}

scene::PlaneSet listed_planes(const scene::Object& object) {
  scene::PlaneSet planes;
  for (const scene::PlaneEntry& entry : object.planes) {
    const double largest =
        std::max({std::abs(entry.normal[0]), std::abs(entry.normal[1]), std::abs(entry.normal[2])});
    // A power of two, which rounds nothing, keeps the squares of very small and large numbers in a double.
    const int exponent = largest > 0 && std::isfinite(largest) ? std::ilogb(largest) : 0;
    const auto scaled = [&](double value) { return std::scalbn(value, -exponent); };
    const glm::dvec3 normal(scaled(entry.normal[0]), scaled(entry.normal[1]), scaled(entry.normal[2]));
    const double length = glm::length(normal), offset = scaled(entry.offset) / length;
    if (!(length > 0) || !std::isfinite(length) || !std::isfinite(offset))
      blame(object, "object.planes",
            fmt::format("plane {}: the normal must be finite and not zero and the offset "
                        "finite",
                        planes.size() + 1));
    // A unit axis keeps its exact zeros and ones, which makes edge-on planes exactly edge-on.
    planes.push_back({normal / length, offset});
  }
  return planes;
}

scene::PlaneSet placed(const scene::PlaneSet& own, const scene::Object& object) {
  const scene::Placement place(object);
  scene::PlaneSet planes;
  for (const scene::HalfSpace& plane : own) planes.push_back(place(plane));
  return planes;
}

ObjectPlanes grown_planes(const Tree& tree) {
  ObjectPlanes result;
  result.grown = true;
  try {
    result.growth = grow(tree.growth);
  } catch (const GrowthError& error) {
    blame(tree.placed, "object.tree", error.what());
  }
  result.planes = placed(result.growth.planes, tree.placed);
  result.bound = placed(result.growth.relaxed, tree.placed);
  const scene::Placement place(tree.placed);
  result.centre = place(glm::dvec3(0.0));
  for (const glm::dvec3& start : tree.growth.start)
    result.reach = std::max(result.reach, glm::length(start) * place.scale);
  return result;
}

ObjectPlanes given_planes(const scene::Object& object, scene::Options& options) {
  ObjectPlanes result;
  scene::PlaneSet own;
  if (!object.mesh.empty()) {
    own = mesh_planes(object, options, result);
  } else if (!object.solid.empty()) {
    const auto& names = scene::solid_names();
    if (std::find(names.begin(), names.end(), object.solid) == names.end())
      blame(object, "object.solid",
            fmt::format("\"{}\" is not known; must be one of {}", object.solid, fmt::join(names, ", ")));
    own = scene::solid_planes(object.solid);
  } else {
    own = listed_planes(object);
  }
  result.planes = placed(own, object);
  return result;
}

}  // namespace

const char* source_key(const scene::Object& object) {
  if (!object.mesh.empty()) return "object.mesh";
  if (!object.solid.empty()) return "object.solid";
  return object.tree.empty() ? "object.planes" : "object.tree";
}

void check_mesh_options(const scene::Scene& scene, const scene::Options& options) {
  for (const scene::Object& object : scene.objects)
    if (!object.mesh.empty()) return;
  for (const char* meshes_only : {"planes", "plane_source", "directions"})
    if (options.has(meshes_only)) options.fail(meshes_only, "goes with an object that is a mesh only");
}

std::vector<ObjectPlanes> object_planes(const scene::Object& object, scene::Options& options,
                                        std::uint64_t seed) {
  std::vector<ObjectPlanes> result;
  if (object.tree.empty())
    result.push_back(given_planes(object, options));
  else
    for (const Tree& tree : trees_of(object, seed)) result.push_back(grown_planes(tree));
  const char* key = source_key(object);
  for (const ObjectPlanes& one : result) {
    if (one.planes.empty())
      blame(object, key,
            one.grown ? "splitting leaves no plane: all are pruned; see keep_parent"
                      : "the object has no planes; give mesh, solid, planes or tree");
    if (one.planes.size() > static_cast<std::size_t>(kMostPlanes))
      blame(object, key,
            fmt::format("{} planes are more than the scratchpad's {}", one.planes.size(), kMostPlanes));
  }
  return result;
}

}  // namespace dendro::half_space
