#include "firmware/zbuffer_views/host/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "firmware/zbuffer_views/host/tree_object.h"
#include "firmware/zbuffer_views/sgi_4d35/format.h"
#include "sim/base/error.h"
#include "sim/scene/view.h"

namespace dendro::zbuffer_views {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kLightMargin = 1.02;

glm::dvec3 about_vertical(const glm::dvec3& p, double degrees) {
  const double c = scene::cosine_of_degrees(degrees), s = scene::sine_of_degrees(degrees);
  return {c * p.x + s * p.z, p.y, c * p.z - s * p.x};
}

Rgb read_colour(scene::Options& options, const char* key, const std::vector<double>& otherwise) {
  const std::vector<double> shares = options.vector(key, otherwise, 0, 1);
  Rgb rgb{};
  for (std::size_t c = 0; c < 3; ++c) rgb[c] = static_cast<std::uint8_t>(std::lround(shares[c] * 255));
  return rgb;
}

/// By eye.  ASSUMED DEV-162
std::array<Rgb, 4> read_colours(scene::Options& options, bool magnolia) {
  const std::vector<double> leaf = magnolia ? std::vector{0.36, 0.56, 0.20} : std::vector{0.20, 0.40, 0.22};
  const Rgb top = read_colour(options, "leaf_colour", leaf);
  const Rgb below = read_colour(options, "leaf_below",
                                magnolia ? std::vector{0.68, 0.76, 0.60} : std::vector{top[0] / 255.0, top[1] / 255.0, top[2] / 255.0});
  return {read_colour(options, "trunk_colour", {0.45, 0.38, 0.32}), read_colour(options, "branch_colour", {0.40, 0.31, 0.24}), top,
          below};
}

/// Threshold: ASSUMED DEV-163. The rest: [MO95 5, 8].
ViewSettings read_views(scene::Options& options, const Tree& tree) {
  ViewSettings views;
  views.bands = static_cast<int>(options.integer("bands", views.bands, kZbvLeastBands, kZbvMostBands));
  views.layers = static_cast<int>(options.integer("layers", views.layers, 1, kZbvMostLayers));
  views.width = static_cast<int>(options.integer("view_width", views.width, kZbvLeastSide, kZbvMostSide));
  views.height = static_cast<int>(options.integer("view_height", views.height, kZbvLeastSide, kZbvMostSide));
  if (views.width % 4 != 0) options.fail("view_width", "must be a multiple of 4");
  views.threshold = single(options.real("threshold", 0.01, 0, 1) * 2 * tree.half_height);
  views.pitch = single(options.real("pitch", 0, 0, 1e6));
  views.peel = options.choice("rule", "insert", {"insert", "peel"}) == "peel";
  views.early = options.choice("leaf_side", "late", {"late", "early"}) == "early";
  return views;
}

std::vector<Placement> placements_of(const scene::Scene& scene, const Tree& tree) {
  std::vector<Placement> placements;
  for (const scene::Object& object : scene.objects) {
    const auto blame = [&](const char* key, const std::string& message) {
      throw UserError(object.where.file, object.where.line, key, message);
    };
    if (!same_tree(object, scene.objects.front()))
      blame("object", "all objects must be the same tree at other places: views are made of one only");
    if (object.rotate[0] != 0 || object.rotate[2] != 0)
      blame("object.rotate", "a tree turns about its trunk only: [0, degrees, 0]");
    // Normals are turned by adding to their longitude byte.  [MO95-K9]
    const double turns = object.rotate[1] / 360 * kZbvTurns;
    Placement place;
    place.turn = static_cast<int>(static_cast<long long>(std::floor(turns + 0.5)) & (kZbvTurns - 1));
    const glm::dvec3 centre = about_vertical(tree.centre, 360.0 * place.turn / kZbvTurns);
    place.at = single(glm::dvec3(object.at[0], object.at[1], object.at[2]) + centre);
    placements.push_back(place);
  }
  if (placements.size() > kZbvMostTrees)
    throw UserError(scene.objects.back().where.file, scene.objects.back().where.line, "object",
                    fmt::format("{} trees are more than {}", placements.size(), int(kZbvMostTrees)));
  return placements;
}

bool far(const glm::dvec3& p) { return !(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < kZbvMostDistance); }

/// Where single precision and the depths of the programs end.
void check_near(const scene::Scene& scene, const Prepared& p) {
  const std::string message = fmt::format("lies {} m or more from the origin", int(kZbvMostDistance));
  const scene::Object& first = scene.objects.front();
  if (far(p.tree.centre) || !(std::max(p.tree.radius, p.tree.half_height) < kZbvMostDistance))
    throw UserError(first.source_where.file, first.source_where.line, first.mesh.empty() ? "object.tree" : "object.mesh",
                    "a part of it " + message);
  for (std::size_t i = 0; i < p.placements.size(); ++i)
    if (far(p.placements[i].at)) throw UserError(scene.objects[i].where.file, scene.objects[i].where.line, "object.at", message);
  for (const Frame& frame : p.frames)
    if (far(frame.eye)) throw UserError(scene.camera.where.file, scene.camera.where.line, "camera.position", message);
}

glm::dvec3 middle_of(const std::vector<Placement>& placements) {
  glm::dvec3 low = placements.front().at, high = low;
  for (const Placement& place : placements) low = glm::min(low, place.at), high = glm::max(high, place.at);
  return (low + high) / 2.0;
}

void read_camera(const scene::Scene& scene, Prepared& p) {
  const scene::Camera& camera = scene.camera;
  p.width = scene.image.width, p.height = scene.image.height;
  if (std::max(p.width, p.height) > kZbvMostSide)
    throw UserError(scene.image.where.file, scene.image.where.line, "image", fmt::format("a picture has at most {0}x{0} pixels", int(kZbvMostSide)));
  p.centre_x = (p.width - 1) / 2.0, p.centre_y = (p.height - 1) / 2.0;
  p.perspective = camera.projection == scene::Camera::Projection::kPerspective;
  p.scale = single(p.perspective ? p.height / 2.0 / std::tan(camera.fov_y / 2 * kPi / 180) : p.height / camera.height);
}

/// A sequence: the camera goes round, or the trees turn, which is the same with the light going round, too.
void read_frames(const scene::Scene& scene, scene::Options& options, Prepared& p) {
  if (scene.lights.size() > 1)
    throw UserError(scene.lights[1].where.file, scene.lights[1].where.line, "light", "one light at most");
  const scene::Light light = scene.lights.empty() ? scene::Light{{-1, -2, -1}, 0.3, {}} : scene.lights.front();
  p.ambient = single(light.ambient);
  p.diffuse = single(options.real("diffuse", 1 - light.ambient, 0, 1));
  if (p.ambient + p.diffuse > 1.0001) options.fail("diffuse", "together with the light's ambient it must not be above 1");
  const scene::CameraAxes axes(scene.camera);
  const glm::dvec3 eye(scene.camera.position[0], scene.camera.position[1], scene.camera.position[2]);
  const glm::dvec3 to_light = -glm::normalize(glm::dvec3(light.direction[0], light.direction[1], light.direction[2]));
  const auto count = static_cast<int>(options.integer("frames", 1, 1, kZbvMostFrames));
  const double turn = options.real("turn", 360, -3600, 3600);
  const bool light_turns = options.choice("turns", "tree", {"tree", "camera"}) == "tree";
  const glm::dvec3 axis = middle_of(p.placements);
  const Frame first = {eye, {axes.right, axes.up, axes.forward}, to_light};
  for (int k = 0; k < count; ++k)
    p.frames.push_back(turned(first, axis, (light_turns ? -turn : turn) * k / count, light_turns));
}

void check_outside(const scene::Scene& scene, const Prepared& p) {
  if (!p.perspective) return;
  for (const Frame& frame : p.frames)
    for (const Placement& place : p.placements) {
      const glm::dvec3 d = frame.eye - place.at;
      if (std::hypot(d.x, d.z) <= p.tree.radius && std::abs(d.y) <= p.tree.half_height)
        throw UserError(scene.camera.where.file, scene.camera.where.line, "camera.position",
                        "is inside the tree: views from outside do not show what is seen from there");
    }
}

/// Light pixels a metre so that all trees fit in every frame.
double fitting_scale(const Prepared& p) {
  double wide = 0, high = 0;
  const glm::dvec3 middle = middle_of(p.placements);
  for (const Frame& frame : p.frames) {
    const glm::dvec3& d = frame.to_light;
    const Axes axes = view_axes(std::atan2(std::hypot(d.x, d.z), d.y), std::atan2(d.x, d.z));
    for (const Placement& place : p.placements) {
      const glm::dvec3 q = axes(place.at - middle);
      wide = std::max(wide, std::abs(q.x) + p.tree.radius);
      high = std::max(high, std::abs(q.y) + p.tree.radius * std::hypot(axes.up.x, axes.up.z) + p.tree.half_height * axes.up.y);
    }
  }
  return single(std::min((p.light_width - 1) / (2 * wide), (p.light_height - 1) / (2 * high)) / kLightMargin);
}

/// Size of the light's picture and the threshold: ASSUMED DEV-164
void read_shadows(scene::Options& options, Prepared& p) {
  p.shadows = options.boolean("shadows", false);
  p.light_width = static_cast<int>(options.integer("light_width", std::max<int>(p.width, kZbvLeastSide), kZbvLeastSide, kZbvMostLightSide));
  p.light_height = static_cast<int>(options.integer("light_height", std::max<int>(p.height, kZbvLeastSide), kZbvLeastSide, kZbvMostLightSide));
  p.epsilon = single(options.real("epsilon", 2.6, 0, 1000));
  p.reuse_light = options.boolean("reuse_light", false);
  p.light_scale = p.shadows ? fitting_scale(p) : 0;
}

RunSettings read_run(scene::Options& options, const Prepared& p) {
  RunSettings run;
  run.polygons = options.choice("draw", "views", {"views", "polygons"}) == "polygons";
  run.time_precompute = options.choice("precompute", "untimed", {"untimed", "timed"}) == "timed";
  run.views_file = options.text("views", "");
  run.save_views = options.boolean("save_views", false);
  run.animate = p.frames.size() > 1;
  for (const char* key : {"views", "save_views"})
    if (run.polygons && options.has(key)) options.fail(key, "goes with draw = \"views\" only");
  if (!run.views_file.empty() && run.time_precompute) options.fail("precompute", "has nothing to time when saved views are loaded");
  if (run.polygons && p.perspective) options.fail("draw", "polygons are drawn in parallel projection");
  if (run.polygons && p.shadows) options.fail("draw", "polygons are drawn without shadows");
  return run;
}

}  // namespace

Frame turned(const Frame& frame, const glm::dvec3& axis, double degrees, bool light_too) {
  const auto turn = [&](const glm::dvec3& v) { return single(about_vertical(v, degrees)); };
  return {single(about_vertical(frame.eye - axis, degrees) + axis),
          {turn(frame.axes.right), turn(frame.axes.up), turn(frame.axes.forward)},
          light_too ? turn(frame.to_light) : single(frame.to_light)};
}

Prepared prepare(const scene::Scene& scene, RunSettings& settings) {
  scene::Options options = scene.options;
  if (scene.objects.empty()) throw UserError(scene.file, 0, "object", "the scene needs an [[object]]");
  Prepared p;
  const scene::Object& first = scene.objects.front();
  TreeModel model = model_of(first, scene.seed);
  p.tree = tree_of(std::move(model), read_colours(options, first.tree == "magnolia"));
  p.placements = placements_of(scene, p.tree);
  p.views = read_views(options, p.tree);
  read_camera(scene, p);
  p.near = single(options.real("near", 0.05, 1e-3, 1e6));
  read_frames(scene, options, p);
  check_near(scene, p);
  check_outside(scene, p);
  read_shadows(options, p);
  p.background = read_colour(options, "background", {0.75, 0.82, 0.90});
  p.skip_empty = options.boolean("skip_empty", false);
  p.full_product = options.boolean("full_product", false);
  settings = read_run(options, p);
  // Which programs are run is not a matter of the scene's content.
  const std::string compiler = options.choice("compiler", "O2", {"O2", "O1", "fcr31"});
  if (!options.boolean("mapped", true) && compiler != "O2")
    options.fail("mapped", "unmapped programs exist with compiler = \"O2\" only");
  options.finish();
  return p;
}

}  // namespace dendro::zbuffer_views
