#include "sim/scene/view.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "sim/base/error.h"

namespace dendro::scene {
namespace {

glm::dvec3 vec(const Vector3& v) { return {v[0], v[1], v[2]}; }

bool finite(const Vector3& v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

double metres_per_unit(const Object& object) {
  if (object.units == "m") return 1.0;
  if (object.units == "cm") return 0.01;
  if (object.units == "mm") return 0.001;
  if (object.units == "in") return 0.0254;
  if (object.units == "ft") return 0.3048;
  throw UserError(object.where.file, object.where.line, "object.units",
                  fmt::format("\"{}\" is not known; must be one of m, cm, mm, in, ft", object.units));
}

/// Columns are the images of the object's axes.
glm::dmat3 upright(const Object& object) {
  if (object.up_axis == "y") return glm::dmat3(1.0);
  if (object.up_axis == "z") return {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
  if (object.up_axis == "x") return {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
  throw UserError(object.where.file, object.where.line, "object.up_axis",
                  fmt::format("\"{}\" is not known; must be one of x, y, z", object.up_axis));
}

glm::dmat3 rotation_of(const Vector3& degrees) {
  const double cx = cosine_of_degrees(degrees[0]), sx = sine_of_degrees(degrees[0]);
  const double cy = cosine_of_degrees(degrees[1]), sy = sine_of_degrees(degrees[1]);
  const double cz = cosine_of_degrees(degrees[2]), sz = sine_of_degrees(degrees[2]);
  const glm::dmat3 about_x{{1, 0, 0}, {0, cx, sx}, {0, -sx, cx}};
  const glm::dmat3 about_y{{cy, 0, -sy}, {0, 1, 0}, {sy, 0, cy}};
  const glm::dmat3 about_z{{cz, sz, 0}, {-sz, cz, 0}, {0, 0, 1}};
  return about_y * about_x * about_z;
}

}  // namespace

double sine_of_degrees(double degrees) {
  const double turn = std::remainder(degrees, 360.0);
  if (std::fmod(turn, 90.0) == 0.0) return turn == 90.0 ? 1.0 : turn == -90.0 ? -1.0 : 0.0;
  return std::sin(turn * std::acos(-1.0) / 180.0);
}

double cosine_of_degrees(double degrees) { return sine_of_degrees(degrees + 90.0); }

Placement::Placement(const Object& object) {
  const Where& where = object.where;
  if (!finite(object.at)) throw UserError(where.file, where.line, "object.at", "must be finite");
  if (!finite(object.rotate)) throw UserError(where.file, where.line, "object.rotate", "must be finite");
  if (!(object.scale > 0) || !std::isfinite(object.scale))
    throw UserError(where.file, where.line, "object.scale", "must be a positive number");
  rotation = rotation_of(object.rotate) * upright(object);
  scale = object.scale * metres_per_unit(object);
  shift = vec(object.at);
}

HalfSpace Placement::operator()(const HalfSpace& plane) const {
  const glm::dvec3 normal = rotation * plane.normal;
  return {normal, scale * plane.offset + glm::dot(normal, shift)};
}

CameraAxes::CameraAxes(const Camera& camera) {
  const auto fail = [&](const char* key, const char* message) {
    throw UserError(camera.where.file, camera.where.line, key, message);
  };
  if (!finite(camera.position)) fail("camera.position", "must be finite");
  if (!finite(camera.target)) fail("camera.target", "must be finite");
  if (!finite(camera.up)) fail("camera.up", "must be finite");
  const glm::dvec3 sight = vec(camera.target) - vec(camera.position);
  if (!(glm::length(sight) > 0)) fail("camera.target", "must differ from camera.position");
  forward = sight / glm::length(sight);
  const glm::dvec3 sideways = glm::cross(forward, vec(camera.up));
  if (!(glm::length(sideways) > 1e-9 * glm::length(vec(camera.up))))
    fail("camera.up", "must not be zero or parallel to the line of sight");
  right = sideways / glm::length(sideways);
  up = glm::cross(right, forward);
}

Affine parallel_view(const Camera& camera, const Image& image) {
  if (camera.projection != Camera::Projection::kParallel)
    throw UserError(camera.where.file, camera.where.line, "camera.projection",
                    "perspective is not available here; must be \"parallel\"");
  if (!(camera.height > 0) || !std::isfinite(camera.height))
    throw UserError(camera.where.file, camera.where.line, "camera.height",
                    "must be a positive number of metres");
  const CameraAxes axes(camera);
  const double pixels_per_metre = image.height / camera.height;
  const glm::dvec3 rows[3] = {axes.right * pixels_per_metre, -axes.up * pixels_per_metre, axes.forward};
  Affine view;
  for (int column = 0; column < 3; ++column)
    view.linear[column] = {rows[0][column], rows[1][column], rows[2][column]};
  view.shift =
      glm::dvec3((image.width - 1) / 2.0, (image.height - 1) / 2.0, 0.0) - view.linear * vec(camera.position);
  return view;
}

void check_one_light(const Scene& scene, const char* algorithm) {
  if (scene.lights.size() > 1)
    throw UserError(scene.lights[1].where.file, scene.lights[1].where.line, "light",
                    fmt::format("{} takes at most one light, not {}", algorithm, scene.lights.size()));
}

glm::dvec3 to_light(const Scene& scene) {
  if (scene.lights.empty()) {
    const CameraAxes axes(scene.camera);
    return (-axes.right + 2.0 * axes.up - 2.0 * axes.forward) / 3.0;
  }
  const Light& light = scene.lights[0];
  const glm::dvec3 direction = vec(light.direction);
  const double length = glm::length(direction);
  if (!(length > 0) || !std::isfinite(length))
    throw UserError(light.where.file, light.where.line, "light.direction", "must be finite and not zero");
  if (!(light.ambient >= 0 && light.ambient <= 1))
    throw UserError(light.where.file, light.where.line, "light.ambient", "must be in 0..1");
  return -direction / length;
}

}  // namespace dendro::scene
