#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "firmware/zbuffer_views/host/tree_model.h"

namespace dendro::zbuffer_views {

constexpr double kPi = 3.14159265358979323846, kDegree = kPi / 180;
constexpr double kGoldenAngle = 2.39996322972865332;
constexpr glm::dvec3 kUp(0, 1, 0);

/// A leader's growth in its year `year`, from 1: it tends to `increment` the later the greater `establishment` is.
constexpr double leader_growth(double increment, double establishment, int year) {
  const double square = double(year) * year;
  return increment * square / (square + establishment);
}

struct WoodNode {
  glm::dvec3 at{};
  double radius = 0;
};

/// Two unit vectors across a direction and each other, right-handed with it.
struct Across {
  glm::dvec3 a{}, b{};

  explicit Across(const glm::dvec3& along);
  /// The frame of `along` that is turned least against `before`.
  Across(const glm::dvec3& along, const Across& before);
};

/// `direction` turned by `angle` radians away from itself, towards the side of `azimuth` in its Across.
glm::dvec3 bent(const glm::dvec3& direction, double angle, double azimuth);

/// Wood along a line of two or more nodes: a prism of `sides` sides that ends in a point at the last node.
void add_wood(TreeModel& tree, const std::vector<WoodNode>& nodes, int sides, Part part);

}  // namespace dendro::zbuffer_views
