#include "firmware/half_space/host/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "firmware/half_space/host/screen_setup.h"
#include "sim/base/error.h"
#include "sim/scene/view.h"

namespace dendro::half_space {
namespace {

void check_scene(const scene::Scene& scene) {
  if (scene.objects.size() != 1)
    throw UserError(scene.file, scene.objects.size() < 2 ? 0 : scene.objects[1].where.line, "object",
                    fmt::format("half_space draws exactly one object, not {}, in two registers a pixel",
                                scene.objects.size()));
  check_picture(scene);
}

class Preparation {
 public:
  explicit Preparation(const scene::Scene& scene)
      : scene_(scene),
        options_(scene.options),
        view_((check_scene(scene), scene::parallel_view(scene.camera, scene.image))) {}

  Prepared make() {
    options_.integer("registers", 2, 2, 3);
    check_mesh_options(scene_, options_);
    std::vector<ObjectPlanes> objects = object_planes(scene_.objects[0], options_, scene_.seed);
    if (objects.size() > 1) blame_object("copies need the third register");
    object_ = std::move(objects.front());
    result_.world = object_.planes;
    result_.files = object_.files;
    if (object_.grown) result_.growth = growth_work(object_.growth);
    PlaneProgram& program = result_.program;
    program.width = scene_.image.width, program.height = scene_.image.height;
    program.maxdepth = (1 << options_.integer("depth_bits", kFrontBits, 6, kFrontBits)) - 1;
    program.boxing = options_.boolean("boxing", true);
    program.steep = read_steep(options_);
    find_corners();
    result_.screen =
        to_screen(result_.world, view_, scene_.image.height / scene_.camera.height, map_depth_of_scene());
    choose_box();
    make_records();
    make_shades();
    options_.finish();
    return std::move(result_);
  }

 private:
  [[noreturn]] void blame_object(const std::string& message) const {
    const scene::Object& object = scene_.objects[0];
    const char* key = !object.mesh.empty()    ? "object.mesh"
                      : !object.solid.empty() ? "object.solid"
                      : !object.tree.empty()  ? "object.tree"
                                              : "object.planes";
    throw UserError(object.source_where.file, object.source_where.line, key, message);
  }

  void find_corners() {
    const bool background =
        options_.choice("unbounded", object_.grown ? "background" : "error", {"error", "background"}) == "background";
    extent_ = extent_of(object_, view_);
    if (!extent_.bounded && !background)
      blame_object(fmt::format("the intersection of the {} planes is unbounded", result_.world.size()));
    if (extent_.empty) blame_object(fmt::format("no point lies inside all {} planes", result_.world.size()));
      }

  DepthMap map_depth_of_scene() {
    const std::vector<double> given = options_.vector("depth_range", {0, 0}, -1e9, 1e9);
    const double margin = options_.real("depth_margin", 0.05, 0, 10);
    if (options_.has("depth_range")) {
      if (!(given[0] < given[1]))
        options_.fail("depth_range", "must be [nearest, farthest] with nearest < farthest");
      if (options_.has("depth_margin")) options_.fail("depth_margin", "goes without depth_range only");
      return map_depth(given[0], given[1], 0, result_.program.maxdepth);
    }
    if (!extent_.has_depth())
      options_.fail("depth_range", "is needed when the planes are unbounded: [nearest, farthest] metres");
    result_.setup_flops += extent_.flops;
    return map_depth(extent_.nearest, extent_.farthest, margin, result_.program.maxdepth);
  }

  void choose_box() {
    PlaneProgram& program = result_.program;
    const bool full = options_.choice("starting_box", "vertices", {"vertices", "full"}) == "full";
    program.box = {0, 0, program.width - 1, program.height - 1};
    if (extent_.corners.empty()) return;
    const std::optional<Box> around = box_around(extent_.corners, program.width, program.height);
    if (!around) blame_object("the object lies outside the picture");
    if (!full) program.box = *around;
  }

  void make_records() {
    PlaneProgram& program = result_.program;
    for (const ScreenPlane& plane : result_.screen) {
      const PlaneRecord record = make_record(plane, program.box, program.steep, program.maxdepth / 2.0);
      (record.kind == PlaneKind::kBack    ? program.back
       : record.kind == PlaneKind::kFront ? program.front
                                          : program.edge_on)
          .push_back(record);
      result_.setup_flops += kFlopsTransformPlane + kFlopsSlopes + kFlopsRound + kFlopsSteepTest;
    }
    const auto faces = std::count_if(result_.screen.begin(), result_.screen.end(),
                                     [](const ScreenPlane& p) { return p.kind == PlaneKind::kFront; });
    if (faces > kLargestFaces)
      blame_object(fmt::format("{} front faces are more than the {} that a face number can tell apart", faces,
                               kLargestFaces));
  }

  void make_shades() {
    const glm::dvec3 light = to_light(scene_);
    const double ambient = scene_.lights.empty() ? 0.3 : scene_.lights[0].ambient;
    const double diffuse = options_.real("diffuse", 1.0 - ambient, 0, 10);
    const std::vector<double> colour = options_.vector("colour", {1, 1, 1}, 0, 1);
    result_.program.shades = {to_rgb(options_.vector("background", {0, 0, 0}, 0, 1), 1.0)};
    for (std::size_t i = 0; i < result_.screen.size(); ++i) {
      if (result_.screen[i].kind != PlaneKind::kFront) continue;
      const double facing = std::max(0.0, glm::dot(result_.world[i].normal, light));
      result_.program.shades.push_back(to_rgb(colour, ambient + diffuse * facing));
      result_.setup_flops += kFlopsShade;
    }
  }

  const scene::Scene& scene_;
  scene::Options options_;
  scene::Affine view_;
  Prepared result_;
  ObjectPlanes object_;
  Extent extent_;
};

}  // namespace

Prepared prepare(const scene::Scene& scene) { return Preparation(scene).make(); }

}  // namespace dendro::half_space
