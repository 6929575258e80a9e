#include "firmware/raster_primitives/host/shade.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "sim/base/error.h"
#include "sim/scene/view.h"

namespace dendro::raster_primitives {

Shader::Shader(const scene::Scene& scene) {
  if (scene.lights.size() > 1)
    throw UserError(scene.lights[1].where.file, scene.lights[1].where.line, "light",
                    fmt::format("raster_primitives takes at most one light, not {}", scene.lights.size()));
  if (scene.lights.empty()) {
    const scene::CameraAxes axes(scene.camera);
    to_light_ = glm::normalize(-axes.right + 2.0 * axes.up - 2.0 * axes.forward);
    return;
  }
  const scene::Light& light = scene.lights[0];
  const glm::dvec3 direction(light.direction[0], light.direction[1], light.direction[2]);
  const double length = glm::length(direction);
  if (!(length > 0) || !std::isfinite(length))
    throw UserError(light.where.file, light.where.line, "light.direction", "must be finite and not zero");
  if (!(light.ambient >= 0 && light.ambient <= 1))
    throw UserError(light.where.file, light.where.line, "light.ambient", "must be in 0..1");
  to_light_ = -direction / length;
  ambient_ = light.ambient;
}

std::array<double, 3> Shader::operator()(const glm::dvec3& normal, const std::vector<double>& colour) const {
  std::array<double, 3> out{};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto [level, swing] = level_and_swing(colour[c]);
    out[c] = level + swing * glm::dot(normal, to_light_);
  }
  return out;
}

std::pair<double, double> Shader::level_and_swing(double colour) const {
  const double range = (255 - 2 * kColourMargin) * colour;
  return {kColourMargin + range * (1 + ambient_) / 2, range * (1 - ambient_) / 2};
}

}  // namespace dendro::raster_primitives
