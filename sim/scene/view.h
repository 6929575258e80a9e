#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "sim/scene/plane_set.h"
#include "sim/scene/scene.h"

namespace dendro::scene {

/// s = linear·p + shift.
struct Affine {
  glm::dmat3 linear{1.0};
  glm::dvec3 shift{};

  glm::dvec3 operator()(const glm::dvec3& p) const { return linear * p + shift; }
};

/// sin and cos of degrees, exact at multiples of 90.
double sine_of_degrees(double degrees);
double cosine_of_degrees(double degrees);

/// Object to world: a rotation times one scale, and a shift. Throws UserError for unknown units or axes, a
/// scale that is not positive, or numbers that are not finite.
struct Placement {
  glm::dmat3 rotation{1.0};
  double scale = 1.0;
  glm::dvec3 shift{};

  explicit Placement(const Object& object);
  glm::dvec3 operator()(const glm::dvec3& p) const { return rotation * (p * scale) + shift; }
  HalfSpace operator()(const HalfSpace& plane) const;
};

/// The camera's axes in world space: unit, orthogonal, `right` to the right on the screen, `up` up, `forward`
/// away. Throws UserError when position, target and up do not fix them.
struct CameraAxes {
  glm::dvec3 right{}, up{}, forward{};

  explicit CameraAxes(const Camera& camera);
};

/// World to screen for a parallel camera: x right and y down in pixels, (0, 0) the centre of the top left
/// pixel, z the distance along the view in metres from the camera's position. Throws UserError for a
/// perspective camera or a height that is not positive.
Affine parallel_view(const Camera& camera, const Image& image);

/// Throws UserError, which names the algorithm, for more than one light.
void check_one_light(const Scene& scene, const char* algorithm);

/// The unit direction to the scene's first light in world space; without a light FG86's: from the left, above, behind the
/// viewer. Throws UserError for a direction or ambient that is none.
glm::dvec3 to_light(const Scene& scene);

}  // namespace dendro::scene
