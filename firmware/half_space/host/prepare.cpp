#include "firmware/half_space/host/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "firmware/half_space/host/object_planes.h"
#include "sim/base/error.h"
#include "sim/scene/view.h"

namespace dendro::half_space {
namespace {

// Floating-point operations, counted from the formulas of S2 and S4.
constexpr std::uint64_t kFlopsTransformPlane =
    15 + 3 + 6 + 1;                                    // 3x3 product, its scaling, n'·t, the sum with e
constexpr std::uint64_t kFlopsSlopes = 1 + 2 + 4 + 1;  // reciprocal, two steps, a·x0 + b·y0 + d, product
constexpr std::uint64_t kFlopsRound = 3;               // scaling of three values to 2^-16
constexpr std::uint64_t kFlopsSteepTest = 4 * 4;       // depth at four corners
constexpr std::uint64_t kFlopsShade = 3 + 2 + 2;       // n·L, ambient + diffuse·, and to 8 bits
constexpr std::uint64_t kFlopsProjectVertex = 18;      // 3x3 product and shift
constexpr std::uint64_t kFlopsSideOfPlane = 6;
constexpr std::uint64_t kFlopsCutEdge = 10;

struct DepthMap {
  double scale = 1, shift = 0;  ///< register = scale · metres along the view + shift
};

/// Flops of finding the corners of N planes by cutting the polyhedron with one plane after another: every
/// plane is compared with the at most 2k - 4 corners so far and makes at most k new ones.
std::uint64_t corner_flops(std::size_t planes) {
  std::uint64_t flops = 0;
  for (std::uint64_t k = 4; k <= planes; ++k) flops += (2 * k - 4) * kFlopsSideOfPlane + k * kFlopsCutEdge;
  return flops;
}

void check_scene(const scene::Scene& scene) {
  const scene::Where& at = scene.image.where;
  for (const auto& [key, side] :
       {std::pair("image.width", scene.image.width), {"image.height", scene.image.height}})
    if (side < 1 || side > kLargestSide)
      throw UserError(
          at.file, at.line, key,
          fmt::format("{} is outside the allowed 1..{} pixels of a 24-bit frame", side, kLargestSide));
  if (scene.objects.size() != 1)
    throw UserError(scene.file, scene.objects.size() < 2 ? 0 : scene.objects[1].where.line, "object",
                    fmt::format("half_space draws exactly one object, not {}", scene.objects.size()));
  if (scene.lights.size() > 1)
    throw UserError(scene.lights[1].where.file, scene.lights[1].where.line, "light",
                    fmt::format("half_space takes at most one light, not {}", scene.lights.size()));
}

/// Screen planes from world planes. The linear part of a parallel view is a rotation with scaled rows, so its
/// inverse transpose is the same rotation with the rows divided instead; that keeps exact zeros exact.
std::vector<ScreenPlane> to_screen(const scene::PlaneSet& world, const scene::Affine& view,
                                   double pixels_per_metre, const DepthMap& depth) {
  const glm::dmat3 rows = glm::transpose(view.linear);
  const glm::dvec3 scales(pixels_per_metre * pixels_per_metre, pixels_per_metre * pixels_per_metre,
                          depth.scale);
  const glm::dvec3 shift(view.shift.x, view.shift.y, view.shift.z * depth.scale + depth.shift);
  std::vector<ScreenPlane> screen;
  int face = 0;
  for (const scene::HalfSpace& plane : world) {
    ScreenPlane out;
    out.a = glm::dot(rows[0], plane.normal) / scales.x;
    out.b = glm::dot(rows[1], plane.normal) / scales.y;
    out.c = glm::dot(rows[2], plane.normal) / scales.z;
    out.d = -(plane.offset + out.a * shift.x + out.b * shift.y + out.c * shift.z);
    out.kind = out.c > 0 ? PlaneKind::kBack : out.c < 0 ? PlaneKind::kFront : PlaneKind::kEdgeOn;
    if (out.kind == PlaneKind::kFront) out.face = ++face;
    screen.push_back(out);
  }
  return screen;
}

DepthMap map_depth(double nearest, double farthest, double margin, int maxdepth) {
  const double extra = margin * (farthest - nearest);
  DepthMap depth;
  depth.scale = maxdepth / (farthest - nearest + 2 * extra);
  depth.shift = -(nearest - extra) * depth.scale;
  return depth;
}

/// A corner of the real polyhedron can be covered in fixed point one pixel further out, hence the margin.
std::optional<Box> box_around(const std::vector<glm::dvec3>& corners, int width, int height) {
  glm::dvec3 lowest(INFINITY), highest(-INFINITY);
  for (const glm::dvec3& p : corners) lowest = glm::min(lowest, p), highest = glm::max(highest, p);
  const auto pixel = [](double v, int most) { return static_cast<int>(std::clamp(v, -1.0, most + 0.0)); };
  Box box{std::max(0, pixel(std::floor(lowest.x) - 1, width)),
          std::max(0, pixel(std::floor(lowest.y) - 1, height)),
          std::min(width - 1, pixel(std::ceil(highest.x) + 1, width)),
          std::min(height - 1, pixel(std::ceil(highest.y) + 1, height))};
  if (box.x0 > box.x1 || box.y0 > box.y1) return std::nullopt;
  return box;
}

/// The direction to the light in world space; without a light the one of FG86's chapter: left, up, to the
/// viewer.
glm::dvec3 to_light(const scene::Scene& scene) {
  if (scene.lights.empty()) {
    const scene::CameraAxes axes(scene.camera);
    return (-axes.right + 2.0 * axes.up - 2.0 * axes.forward) / 3.0;
  }
  const scene::Light& light = scene.lights[0];
  const glm::dvec3 direction(light.direction[0], light.direction[1], light.direction[2]);
  const double length = glm::length(direction);
  if (!(length > 0) || !std::isfinite(length))
    throw UserError(light.where.file, light.where.line, "light.direction", "must be finite and not zero");
  if (!(light.ambient >= 0 && light.ambient <= 1))
    throw UserError(light.where.file, light.where.line, "light.ambient", "must be in 0..1");
  return -direction / length;
}

Rgb to_rgb(const std::vector<double>& colour, double shade) {
  Rgb rgb{};
  for (int i = 0; i < 3; ++i)
    rgb[i] = static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(colour[i] * shade, 0.0, 1.0)));
  return rgb;
}

class Preparation {
 public:
  explicit Preparation(const scene::Scene& scene)
      : scene_(scene),
        options_(scene.options),
        view_((check_scene(scene), scene::parallel_view(scene.camera, scene.image))) {}

  Prepared make() {
    ObjectPlanes object = object_planes(scene_.objects[0], options_);
    result_.world = std::move(object.planes);
    result_.files = std::move(object.files);
    PlaneProgram& program = result_.program;
    program.width = scene_.image.width, program.height = scene_.image.height;
    program.maxdepth = (1 << options_.integer("depth_bits", kFrontBits, 6, kFrontBits)) - 1;
    program.boxing = options_.boolean("boxing", true);
    const std::string steep = options_.choice("steep", "wide", {"wide", "saturate", "wrap"});
    program.steep = steep == "wide"       ? SteepPolicy::kWide
                    : steep == "saturate" ? SteepPolicy::kSaturate
                                          : SteepPolicy::kWrap;
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
                                              : "object.planes";
    throw UserError(object.source_where.file, object.source_where.line, key, message);
  }

  void find_corners() {
    const bool background = options_.choice("unbounded", "error", {"error", "background"}) == "background";
    bounded_ = scene::is_bounded(result_.world);
    if (!bounded_ && !background)
      blame_object(fmt::format("the intersection of the {} planes is unbounded", result_.world.size()));
    if (!bounded_) return;
    const auto corners = scene::intersection_vertices(result_.world);
    if (!corners) blame_object(fmt::format("no point lies inside all {} planes", result_.world.size()));
    for (const glm::dvec3& corner : *corners) corners_.push_back(view_(corner));
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
    if (corners_.empty())
      options_.fail("depth_range", "is needed when the planes are unbounded: [nearest, farthest] metres");
    double nearest = INFINITY, farthest = -INFINITY;
    for (const glm::dvec3& corner : corners_)
      nearest = std::min(nearest, corner.z), farthest = std::max(farthest, corner.z);
    result_.setup_flops += corner_flops(result_.world.size()) + corners_.size() * kFlopsProjectVertex;
    return map_depth(nearest, farthest, margin, result_.program.maxdepth);
  }

  void choose_box() {
    PlaneProgram& program = result_.program;
    const bool full = options_.choice("starting_box", "vertices", {"vertices", "full"}) == "full";
    program.box = {0, 0, program.width - 1, program.height - 1};
    if (!bounded_) return;
    const std::optional<Box> around = box_around(corners_, program.width, program.height);
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
  std::vector<glm::dvec3> corners_;  ///< x, y in pixels, z in metres along the view
  bool bounded_ = true;
};

}  // namespace

Prepared prepare(const scene::Scene& scene) { return Preparation(scene).make(); }

}  // namespace dendro::half_space
