#include "sim/scene/plane_set.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "sim/base/check.h"
#include "sim/scene/hull.h"

namespace dendro::scene {
namespace {

/// Normals closer than this to leaving a direction open count as leaving it open.
constexpr double kSpanTolerance = 1e-9;

}  // namespace

bool is_bounded(const PlaneSet& planes) {
  std::vector<glm::dvec3> normals;
  for (const HalfSpace& plane : planes) normals.push_back(plane.normal);
  const std::optional<Hull> hull = convex_hull(normals);
  return hull && std::all_of(hull->facets.begin(), hull->facets.end(),
                             [](const HullFacet& facet) { return facet.offset > kSpanTolerance; });
}

std::optional<std::vector<glm::dvec3>> intersection_vertices(const PlaneSet& planes) {
  const Ball ball = chebyshev_ball(planes);
  if (!(ball.radius > 0)) return std::nullopt;
  std::vector<glm::dvec3> dual;
  for (const HalfSpace& plane : planes)
    // Scaled by the radius, so that Qhull sees numbers near 1 whatever the size of the object.
    dual.push_back(plane.normal * (ball.radius / (plane.offset - glm::dot(plane.normal, ball.centre))));
  const std::optional<Hull> hull = convex_hull(dual);
  if (!hull) return std::nullopt;
  std::vector<glm::dvec3> vertices;
  for (const HullFacet& facet : hull->facets) {
    if (!(facet.offset > 0)) return std::nullopt;
    vertices.push_back(ball.centre + facet.normal * (ball.radius / facet.offset));
  }
  return vertices;
}

PlaneSet support_planes(const std::vector<glm::dvec3>& points, const std::vector<glm::dvec3>& directions) {
  PlaneSet planes;
  for (const glm::dvec3& direction : directions) {
    HalfSpace plane{glm::normalize(direction), -INFINITY};
    for (const glm::dvec3& p : points) plane.offset = std::max(plane.offset, glm::dot(plane.normal, p));
    planes.push_back(plane);
  }
  return planes;
}

std::vector<glm::dvec3> sphere_directions(std::size_t count) {
  const double golden_angle = std::acos(-1.0) * (3.0 - std::sqrt(5.0));
  std::vector<glm::dvec3> directions;
  for (std::size_t i = 0; i < count; ++i) {
    const double y = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(count);
    const double ring = std::sqrt(1.0 - y * y);
    const double angle = golden_angle * static_cast<double>(i);
    directions.emplace_back(ring * std::cos(angle), y, ring * std::sin(angle));
  }
  return directions;
}

}  // namespace dendro::scene
