#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <utility>
#include <vector>

#include "sim/scene/scene.h"

namespace dendro::raster_primitives {

/// Colours from normals: ambient + (1 - ambient)(1 + n·L) / 2, which is never negative, so that a sphere's shade is one
/// expression without a case; kept off both ends of the byte by kColourMargin.  ASSUMED DEV-096
class Shader {
 public:
  static constexpr double kColourMargin = 4;

  /// Throws UserError for more than one light or a wrong one. Without a light it comes from the left, above, behind the viewer.
  explicit Shader(const scene::Scene& scene);

  /// Of a unit normal in world space; 0..255.
  std::array<double, 3> operator()(const glm::dvec3& normal, const std::vector<double>& colour) const;

  /// The shade of one part of a colour is level + swing · n·L.
  std::pair<double, double> level_and_swing(double colour) const;

  /// Unit, in world space.
  const glm::dvec3& to_light() const { return to_light_; }

 private:
  glm::dvec3 to_light_{};
  double ambient_ = 0.3;
};

}  // namespace dendro::raster_primitives
