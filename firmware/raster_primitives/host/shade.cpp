#include "firmware/raster_primitives/host/shade.h"

#include <glm/geometric.hpp>

#include "sim/scene/view.h"

namespace dendro::raster_primitives {

Shader::Shader(const scene::Scene& scene) {
  scene::check_one_light(scene, "raster_primitives");
  to_light_ = scene::to_light(scene);
  if (!scene.lights.empty()) ambient_ = scene.lights[0].ambient;
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
