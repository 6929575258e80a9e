#include "firmware/zbuffer_views/host/tree_object.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>

#include "firmware/zbuffer_views/host/fir.h"
#include "firmware/zbuffer_views/host/magnolia.h"
#include "sim/base/error.h"
#include "sim/scene/mesh.h"
#include "sim/scene/mesh_groups.h"
#include "sim/scene/view.h"

namespace dendro::zbuffer_views {
namespace {

/// So many triangles and three vertices each are still a file that a machine of 128 MB holds.
constexpr std::size_t kMostTriangles = 1'500'000;

[[noreturn]] void blame(const scene::Object& object, const std::string& key, const std::string& message) {
  throw UserError(object.source_where.file, object.source_where.line, key, message);
}

template <class Parameters>
struct RealKey {
  const char* key;
  double Parameters::*member;
  double low, high;
};

template <class Parameters>
void read_reals(scene::Options& options, Parameters& p, const std::vector<RealKey<Parameters>>& keys) {
  for (const RealKey<Parameters>& k : keys) p.*k.member = options.real(k.key, p.*k.member, k.low, k.high);
}

/// Keys that both kinds have.
template <class Parameters>
void read_common(scene::Options& options, Parameters& p, std::uint64_t seed) {
  p.age = static_cast<int>(options.integer("age", p.age, 1, 25));
  p.whorl = static_cast<int>(options.integer("whorl", p.whorl, 1, 12));
  p.seed = static_cast<std::uint64_t>(
      options.integer("seed", static_cast<std::int64_t>(seed & INT64_MAX), 0, INT64_MAX));
  read_reals<Parameters>(options, p,
                         {{"increment", &Parameters::increment, 0.05, 3},
                          {"establishment", &Parameters::establishment, 0, 1000},
                          {"whorl_share", &Parameters::whorl_share, 0.05, 1.5},
                          {"insertion", &Parameters::insertion, 5, 120},
                          {"fork_share", &Parameters::fork_share, 0.05, 1},
                          {"vigour", &Parameters::vigour, 0.3, 1.05},
                          {"shortest_shoot", &Parameters::shortest_shoot, 0.005, 1},
                          {"triangles", &Parameters::triangles, 0, kMostTriangles}});
}

// Defaults and ranges: ASSUMED DEV-160
TreeModel read_fir(scene::Options& options, std::uint64_t seed) {
  FirParameters p;
  read_common(options, p, seed);
  read_reals<FirParameters>(options, p,
                            {{"sag", &FirParameters::sag, 0, 90},
                             {"fork", &FirParameters::fork, 5, 90},
                             {"needle_length", &FirParameters::needle_length, 0.002, 0.2},
                             {"needle_width", &FirParameters::needle_width, 0.0002, 0.05},
                             {"needles_per_metre", &FirParameters::needles_per_metre, 0, 5000}});
  p.needle_years = static_cast<int>(options.integer("needle_years", p.needle_years, 1, 25));
  options.finish();
  return grow_fir(p);
}

// Defaults and ranges: ASSUMED DEV-161
TreeModel read_magnolia(scene::Options& options, std::uint64_t seed) {
  MagnoliaParameters p;
  read_common(options, p, seed);
  read_reals<MagnoliaParameters>(options, p,
                                 {{"rise", &MagnoliaParameters::rise, 0, 1},
                                  {"fork_chance", &MagnoliaParameters::fork_chance, 0, 1},
                                  {"leaves", &MagnoliaParameters::leaves, 1, 30},
                                  {"leaf_length", &MagnoliaParameters::leaf_length, 0.02, 1},
                                  {"leaf_width", &MagnoliaParameters::leaf_width, 0.01, 1}});
  p.leaf_rows = static_cast<int>(options.integer("leaf_rows", p.leaf_rows, 2, 200));
  options.finish();
  return grow_magnolia(p);
}

TreeModel grown_model(const scene::Object& object, std::uint64_t seed) {
  scene::Options options("object", object.source_where);
  for (const auto& [key, value] : object.tree_parameters) options.set(key, value);
  if (object.tree == "fir") return read_fir(options, seed);
  if (object.tree == "magnolia") return read_magnolia(options, seed);
  blame(object, "object.tree",
        fmt::format("\"{}\" is not known; must be one of {}", object.tree, fmt::join(tree_kinds(), ", ")));
}

std::vector<Part> parts_of(const scene::Mesh& mesh, const scene::Object& object) {
  static const std::map<std::string, Part> kParts = {
      {"trunk", Part::kTrunk}, {"branch", Part::kBranch}, {"leaf", Part::kLeaf}};
  std::vector<Part> parts(mesh.triangles.size(), object.groups.empty() ? Part::kLeaf : Part::kBranch);
  for (const auto& [meaning, pattern] : object.groups) {
    const auto known = kParts.find(meaning);
    if (known == kParts.end())
      blame(object, "object.groups", fmt::format("\"{}\" is not known; must be trunk, branch or leaf", meaning));
    const std::vector<bool> in_group = scene::triangles_in_groups(mesh, object, meaning);
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (in_group[i]) parts[i] = known->second;
  }
  return parts;
}

TreeModel read_model(const scene::Object& object) {
  const scene::Mesh mesh = scene::load_mesh(object.mesh, object.source_where, "object.mesh");
  if (mesh.triangles.size() > kMostTriangles)
    blame(object, "object.mesh",
          fmt::format("{}: {} triangles are more than {}", object.mesh, mesh.triangles.size(), kMostTriangles));
  const std::vector<Part> parts = parts_of(mesh, object);
  TreeModel model;
  model.files = mesh.files;
  for (const glm::dvec3& p : mesh.vertices) model.add_vertex(p);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    model.add_triangle(t[0], t[1], t[2], parts[i]);
  }
  return model;
}

/// Triangles without an area have no normal and cover nothing.
void drop_empty_triangles(TreeModel& model) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < model.triangles.size(); ++i) {
    const auto& t = model.triangles[i];
    const glm::dvec3& a = model.vertices[t[0]];
    const glm::dvec3 n = glm::cross(model.vertices[t[1]] - a, model.vertices[t[2]] - a);
    if (!(glm::length(n) > 0)) continue;
    model.triangles[kept] = t;
    model.parts[kept++] = model.parts[i];
  }
  model.triangles.resize(kept);
  model.parts.resize(kept);
}

bool same_value(const scene::OptionValue& a, const scene::OptionValue& b) {
  using Array = scene::OptionValue::Array;
  if (a.value.index() != b.value.index()) return false;
  if (const auto* items = std::get_if<Array>(&a.value)) {
    const auto& others = std::get<Array>(b.value);
    return std::equal(items->begin(), items->end(), others.begin(), others.end(), same_value);
  }
  return std::visit(
      [&](const auto& value) {
        using T = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<T, Array>)
          return false;
        else
          return value == std::get<T>(b.value);
      },
      a.value);
}

}  // namespace

const std::vector<std::string>& tree_kinds() {
  static const std::vector<std::string> kinds{"fir", "magnolia"};
  return kinds;
}

TreeModel model_of(const scene::Object& object, std::uint64_t seed) {
  if (object.tree.empty() && object.mesh.empty())
    blame(object, object.solid.empty() ? "object.planes" : "object.solid", "is not for this algorithm: give mesh or tree");
  if (!object.trunk_parameters.empty())
    blame(object, "object." + object.trunk_parameters.begin()->first, "is not for this algorithm");
  TreeModel model = object.tree.empty() ? read_model(object) : grown_model(object, seed);
  scene::Object upright = object;
  upright.rotate = upright.at = {0, 0, 0};
  const scene::Placement place(upright);
  TreeModel placed;
  for (const glm::dvec3& p : model.vertices) placed.add_vertex(place(p));
  model.vertices = std::move(placed.vertices);
  drop_empty_triangles(model);
  if (model.triangles.empty()) blame(object, object.mesh.empty() ? "object.tree" : "object.mesh", "has no triangles");
  if (model.triangles.size() > kMostTriangles)
    blame(object, "object.tree", fmt::format("{} triangles are more than {}", model.triangles.size(), kMostTriangles));
  return model;
}

bool same_tree(const scene::Object& a, const scene::Object& b) {
  const auto& x = a.tree_parameters;
  const auto& y = b.tree_parameters;
  return a.mesh == b.mesh && a.tree == b.tree && a.scale == b.scale && a.units == b.units && a.up_axis == b.up_axis &&
         a.groups == b.groups &&
         std::equal(x.begin(), x.end(), y.begin(), y.end(),
                    [](const auto& p, const auto& q) { return p.first == q.first && same_value(p.second, q.second); });
}

Tree tree_of(TreeModel model, const std::array<Rgb, 4>& colours) {
  Tree tree;
  tree.colours = {{Part::kTrunk, colours[0], 0}, {Part::kBranch, colours[1], 1}, {Part::kLeaf, colours[2], 3}, {Part::kLeaf, colours[3], 2}};
  glm::dvec3 low = model.vertices[model.triangles.front()[0]], high = low;
  for (const auto& triangle : model.triangles)
    for (const std::uint32_t corner : triangle) {
      low = glm::min(low, model.vertices[corner]);
      high = glm::max(high, model.vertices[corner]);
    }
  // A grown trunk stands at the origin; of a mesh only the middle is known.
  const bool grown = model.files.empty();
  tree.centre = {grown ? 0 : single((low.x + high.x) / 2), single((low.y + high.y) / 2), grown ? 0 : single((low.z + high.z) / 2)};
  for (const auto& triangle : model.triangles)
    for (const std::uint32_t corner : triangle) {
      const glm::dvec3 p = model.vertices[corner] - tree.centre;
      tree.radius = std::max(tree.radius, std::hypot(p.x, p.z));
      tree.half_height = std::max(tree.half_height, std::abs(p.y));
    }
  for (const Part part : model.parts) tree.colour_of.push_back(static_cast<std::uint8_t>(part));
  tree.model = std::move(model);
  return tree;
}

}  // namespace dendro::zbuffer_views
