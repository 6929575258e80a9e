#include "firmware/half_space/host/tree_object.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "sim/base/error.h"
#include "sim/base/random.h"

namespace dendro::half_space {
namespace {

constexpr double kRadiansPerDegree = 3.14159265358979323846 / 180.0;
constexpr double kPineStretch = 2.5;  // ASSUMED DEV-045
constexpr int kMostStarts = 64;
constexpr double kShortestStart = 1e-9, kLongestStart = 1e9;  // their squares are far from a double's ends
constexpr int kMostGenerations = 8;
constexpr int kMostCopies = 2000;

// Defaults and ranges: ASSUMED DEV-045
GrowthParameters read_growth(const scene::Object& object, scene::Options& options) {
  GrowthParameters p;
  const double radius = options.real("radius", 1.0, kShortestStart, kLongestStart);
  const auto count = static_cast<int>(options.integer("start_normals", 6, 1, kMostStarts));
  for (const std::vector<double>& row : options.vectors("start", 3)) {
    p.start.emplace_back(row[0], row[1], row[2]);
    const double length = glm::length(p.start.back());
    if (!(length >= kShortestStart && length <= kLongestStart))
      options.fail("start", "a start normal must be 1e-9 to 1e9 long, not zero");
  }
  if (options.has("start") && p.start.empty())
    options.fail("start", "the list is empty: 0 normals bound nothing");
  if (p.start.empty())
    p.start = start_normals(object.tree, count, radius);
  else if (options.has("start_normals") || options.has("radius"))
    options.fail("start", "goes without start_normals and radius: the vectors say both");
  if (p.start.size() > static_cast<std::size_t>(kMostStarts))
    options.fail("start", fmt::format("{} start normals are more than {}", p.start.size(), kMostStarts));
  p.generations = static_cast<int>(options.integer("generations", 1, 0, kMostGenerations));
  if (options.has("splits")) p.splits = static_cast<int>(options.integer("splits", 0, 0, 1 << 20));
  p.mean_b = options.real("mu_b", 0.8, 0.01, 2.0);
  p.sigma_b = options.real("sigma_b", 0.05, 0, 1);
  p.mean_angle = options.real("mu_alpha", 30, -89, 89) * kRadiansPerDegree;
  p.sigma_angle = options.real("sigma_alpha", 5, 0, 90) * kRadiansPerDegree;
  p.sigma_length = options.real("sigma_l", 0.05, 0, 1);
  p.ratio = options.real("ratio", 0.7, 0, 1);
  p.angle_limit = options.real("alpha_max", 80, 1, 89.9) * kRadiansPerDegree;
  p.length_limit = options.real("length_limit", 4, 0.1, 100);
  p.prune = options.boolean("prune", true);
  p.keep_parent = options.boolean("keep_parent", true);
  return p;
}

struct Copies {
  int count = 1;
  std::vector<double> area, scale;
};

Copies read_copies(scene::Options& options) {
  Copies copies;
  copies.count = static_cast<int>(options.integer("copies", 1, 1, kMostCopies));
  copies.area = options.vector("copies_area", {1, 1}, 1e-9, 1e9);
  copies.scale = options.vector("copies_scale", {1, 1}, 1e-9, 1e9);
  for (const char* key : {"copies_area", "copies_scale"})
    if (copies.count == 1 && options.has(key)) options.fail(key, "goes with more than one of `copies`");
  if (copies.count > 1 && !options.has("copies_area"))
    options.fail("copies_area", "is needed with `copies`: [width, depth] of the ground they stand on");
  if (copies.scale[0] > copies.scale[1]) options.fail("copies_scale", "must be [smallest, largest]");
  return copies;
}

/// One tree somewhere in each cell of a grid over the area; cells that stay free are the last ones.
std::vector<Tree> lay_out(const Copies& copies, const Tree& first) {
  const int columns =
      std::max(1, static_cast<int>(std::ceil(std::sqrt(copies.count * copies.area[0] / copies.area[1]))));
  const int rows = (copies.count + columns - 1) / columns;
  std::mt19937_64 random(first.growth.seed);
  std::vector<Tree> trees;
  for (int i = 0; i < copies.count; ++i) {
    Tree tree = first;
    tree.growth.seed = random();
    const double column = i % columns + base::uniform(random, 0, 1), row = i / columns + base::uniform(random, 0, 1);
    tree.placed.at[0] += copies.area[0] * (column / columns - 0.5);
    tree.placed.at[2] += copies.area[1] * (row / rows - 0.5);
    tree.placed.rotate[1] += base::uniform(random, 0, 360);
    tree.placed.scale *= base::uniform(random, copies.scale[0], copies.scale[1]);
    trees.push_back(std::move(tree));
  }
  return trees;
}

}  // namespace

const std::vector<std::string>& tree_kinds() {
  static const std::vector<std::string> kinds{"round", "pine"};
  return kinds;
}

std::vector<glm::dvec3> start_normals(const std::string& kind, int count, double radius) {
  std::vector<glm::dvec3> start = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  if (count != 6) start = scene::sphere_directions(static_cast<std::size_t>(count));
  for (glm::dvec3& normal : start) {
    if (kind == "pine" && normal.y > 0) normal.y *= kPineStretch;
    normal *= radius;
  }
  return start;
}

std::vector<Tree> trees_of(const scene::Object& object, std::uint64_t seed) {
  const scene::Where& where = object.source_where;
  const auto& kinds = tree_kinds();
  if (std::find(kinds.begin(), kinds.end(), object.tree) == kinds.end())
    throw UserError(
        where.file, where.line, "object.tree",
        fmt::format("\"{}\" is not known; must be one of {}", object.tree, fmt::join(kinds, ", ")));
  scene::Options options("object", where);
  for (const auto& [key, value] : object.tree_parameters) options.set(key, value);
  Tree tree{read_growth(object, options), object};
  tree.growth.seed = static_cast<std::uint64_t>(
      options.integer("seed", static_cast<std::int64_t>(seed & INT64_MAX), 0, INT64_MAX));
  const Copies copies = read_copies(options);
  options.finish();
  if (copies.count == 1) return {tree};
  return lay_out(copies, tree);
}

}  // namespace dendro::half_space
