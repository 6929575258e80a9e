#include <cmath>
#include <glm/geometric.hpp>

#include "firmware/zbuffer_views/host/prepared.h"

namespace dendro::zbuffer_views {

glm::dvec3 Axes::operator()(const glm::dvec3& p) const {
  return {glm::dot(right, p), glm::dot(up, p), glm::dot(forward, p)};
}

glm::dvec3 Axes::inverse(const glm::dvec3& q) const { return right * q.x + up * q.y + forward * q.z; }

Axes view_axes(double theta, double phi) {
  const double st = std::sin(theta), ct = std::cos(theta), sp = std::sin(phi), cp = std::cos(phi);
  return {{cp, 0, -sp}, {-ct * sp, st, -ct * cp}, {-st * sp, -ct, -st * cp}};
}

}  // namespace dendro::zbuffer_views
