#include "firmware/half_space/host/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "firmware/half_space/host/scene_setup.h"
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
    const scene::Object& object = scene_.objects[0];
    std::vector<ObjectPlanes> objects = object_planes(object, options_, scene_.seed);
    if (objects.size() > 1) blame(object, "copies need the third register");
    const ObjectPlanes& planes = objects.front();
    result_.world = planes.planes;
    result_.files = planes.files;
    if (planes.grown) result_.growth = growth_work(planes.growth);
    const ScanSettings settings = read_scan_settings(options_, kFrontBits);
    const Extent extent = extent_of(planes, view_);
    check_extent(object, planes, extent, options_);
    if (!options_.has("depth_range")) result_.setup_flops += extent.flops;
    result_.screen = to_screen(result_.world, view_, scene_.image.height / scene_.camera.height,
                               read_depth_map(options_, extent.nearest, extent.farthest, settings.maxdepth));
    std::optional<PlaneProgram> program =
        make_program(scene_.image, settings, result_.screen, extent, true, result_.setup_flops);
    if (!program) blame(object, "the object lies outside the picture");
    result_.program = std::move(*program);
    check_faces();
    make_shades();
    options_.finish();
    return std::move(result_);
  }

 private:
  void check_faces() const {
    const auto faces = std::count_if(result_.screen.begin(), result_.screen.end(),
                                     [](const ScreenPlane& p) { return p.kind == PlaneKind::kFront; });
    if (faces > kLargestFaces)
      blame(scene_.objects[0],
            fmt::format("{} front faces are more than the {} that a face number can tell apart", faces,
                        kLargestFaces));
  }

  void make_shades() {
    const glm::dvec3 light = scene::to_light(scene_);
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
};

}  // namespace

Prepared prepare(const scene::Scene& scene) { return Preparation(scene).make(); }

}  // namespace dendro::half_space
