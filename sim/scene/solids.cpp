#include <cmath>
#include <glm/geometric.hpp>

#include "sim/base/check.h"
#include "sim/scene/plane_set.h"

namespace dendro::scene {
namespace {

/// All sign changes of (a, b, c), cyclically permuted as well when `cyclic`. Zeros stay exact zeros.
std::vector<glm::dvec3> signed_points(double a, double b, double c, bool cyclic) {
  std::vector<glm::dvec3> points;
  for (int turn = 0; turn < (cyclic ? 3 : 1); ++turn) {
    for (int signs = 0; signs < 8; ++signs) {
      const bool repeats = (a == 0 && (signs & 1)) || (b == 0 && (signs & 2)) || (c == 0 && (signs & 4));
      if (!repeats) points.emplace_back(signs & 1 ? -a : a, signs & 2 ? -b : b, signs & 4 ? -c : c);
    }
    const double last = c;
    c = b, b = a, a = last;
  }
  return points;
}

std::vector<glm::dvec3> joined(std::vector<glm::dvec3> first, const std::vector<glm::dvec3>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

std::vector<glm::dvec3> directions_of(const std::string& name) {
  const double phi = (1.0 + std::sqrt(5.0)) / 2.0;
  if (name == "tetrahedron") return {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  if (name == "cube") return signed_points(1, 0, 0, true);
  if (name == "octahedron") return signed_points(1, 1, 1, false);
  if (name == "dodecahedron") return signed_points(0, 1, phi, true);
  DENDRO_CHECK(name == "icosahedron", "solid {}", name);
  return joined(signed_points(1, 1, 1, false), signed_points(1 / phi, 0, phi, true));
}

double inradius_of(const std::string& name) {
  if (name == "tetrahedron") return 1.0 / 3.0;
  if (name == "cube" || name == "octahedron") return 1.0 / std::sqrt(3.0);
  return std::sqrt((5.0 + 2.0 * std::sqrt(5.0)) / 15.0);  // icosahedron and dodecahedron share it
}

}  // namespace

const std::vector<std::string>& solid_names() {
  static const std::vector<std::string> names{"tetrahedron", "cube", "octahedron", "dodecahedron",
                                              "icosahedron"};
  return names;
}

PlaneSet solid_planes(const std::string& name) {
  PlaneSet planes;
  for (const glm::dvec3& direction : directions_of(name))
    planes.push_back({direction / glm::length(direction), inradius_of(name)});
  return planes;
}

}  // namespace dendro::scene
