#include "firmware/half_space/host/screen_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "sim/base/error.h"

namespace dendro::half_space {
namespace {

/// Scale, convert, index, load: a table look-up on the VAX.
constexpr std::uint64_t kInstructionsPerLookUp = 4;

}  // namespace

std::uint64_t corner_flops(std::size_t planes) {
  std::uint64_t flops = 0;
  for (std::uint64_t k = 4; k <= planes; ++k) flops += (2 * k - 4) * kFlopsSideOfPlane + k * kFlopsCutEdge;
  return flops;
}

void check_picture(const scene::Scene& scene) {
  const scene::Where& at = scene.image.where;
  for (const auto& [key, side] :
       {std::pair("image.width", scene.image.width), {"image.height", scene.image.height}})
    if (side < 1 || side > kLargestSide)
      throw UserError(
          at.file, at.line, key,
          fmt::format("{} is outside the allowed 1..{} pixels of a 24-bit frame", side, kLargestSide));
  check_objects(scene);
}

void check_objects(const scene::Scene& scene) {
  if (scene.objects.empty()) throw UserError(scene.file, 0, "object", "the scene has no object");
  scene::check_one_light(scene, "half_space");
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

Rgb to_rgb(const std::vector<double>& colour, double shade) {
  Rgb rgb{};
  for (int i = 0; i < 3; ++i)
    rgb[i] = static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(colour[i] * shade, 0.0, 1.0)));
  return rgb;
}

Extent extent_of(const ObjectPlanes& object, const scene::Affine& view) {
  Extent extent;
  extent.bounded = scene::is_bounded(object.planes);
  const scene::PlaneSet* around = nullptr;
  if (object.grown && scene::is_bounded(object.bound))
    around = &object.bound;
  else if (extent.bounded)
    around = &object.planes;
  if (around == nullptr && object.grown) {
    const double depth = view(object.centre).z;
    extent.nearest = depth - 2 * object.reach, extent.farthest = depth + 2 * object.reach;
  }
  if (around == nullptr) return extent;
  const auto corners = scene::intersection_vertices(*around);
  extent.empty = !corners;
  if (!corners) return extent;
  for (const glm::dvec3& corner : *corners) {
    extent.corners.push_back(view(corner));
    extent.nearest = std::min(extent.nearest, extent.corners.back().z);
    extent.farthest = std::max(extent.farthest, extent.corners.back().z);
  }
  extent.flops = corner_flops(around->size()) + corners->size() * kFlopsProjectVertex;
  return extent;
}

SteepPolicy read_steep(scene::Options& options) {
  const std::string steep = options.choice("steep", "wide", {"wide", "saturate", "wrap"});
  return steep == "wide"       ? SteepPolicy::kWide
         : steep == "saturate" ? SteepPolicy::kSaturate
                               : SteepPolicy::kWrap;
}

Work growth_work(const Grown& growth) {
  Work work;
  for (const GrowthCount* part : {&growth.printed, &growth.vectors, &growth.pruning}) {
    work.flops += part->flops + part->comparisons;
    work.instructions += part->look_ups * kInstructionsPerLookUp;
  }
  return work;
}

}  // namespace dendro::half_space
