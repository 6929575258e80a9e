#include "firmware/zbuffer_views/host/wood.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "sim/base/check.h"

namespace dendro::zbuffer_views {
Across::Across(const glm::dvec3& along) {
  const glm::dvec3 other = std::abs(along.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  a = glm::normalize(glm::cross(other, along));
  b = glm::cross(along, a);
}

Across::Across(const glm::dvec3& along, const Across& before) {
  const glm::dvec3 across = before.a - along * glm::dot(before.a, along);
  if (glm::length(across) < 1e-6) {
    *this = Across(along);
    return;
  }
  a = glm::normalize(across);
  b = glm::cross(along, a);
}

glm::dvec3 bent(const glm::dvec3& direction, double angle, double azimuth) {
  const Across frame(direction);
  return direction * std::cos(angle) +
         (frame.a * std::cos(azimuth) + frame.b * std::sin(azimuth)) * std::sin(angle);
}

void add_wood(TreeModel& tree, const std::vector<WoodNode>& nodes, int sides, Part part) {
  DENDRO_CHECK(nodes.size() >= 2 && sides >= 3, "{} nodes, {} sides", nodes.size(), sides);
  const auto count = static_cast<std::uint32_t>(sides);
  std::uint32_t below = 0;
  Across frame(glm::normalize(nodes[1].at - nodes[0].at));
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    const glm::dvec3 before = nodes[i].at - nodes[i == 0 ? 0 : i - 1].at, after = nodes[i + 1].at - nodes[i].at;
    frame = Across(glm::normalize(before + after), frame);
    const auto ring = static_cast<std::uint32_t>(tree.vertices.size());
    for (std::uint32_t s = 0; s < count; ++s) {
      const double angle = 2 * kPi * s / count;
      tree.add_vertex(nodes[i].at + nodes[i].radius * (frame.a * std::cos(angle) + frame.b * std::sin(angle)));
    }
    for (std::uint32_t s = 0; i > 0 && s < count; ++s) {
      const std::uint32_t next = (s + 1) % count;
      tree.add_triangle(below + s, below + next, ring + next, part);
      tree.add_triangle(below + s, ring + next, ring + s, part);
    }
    below = ring;
  }
  const std::uint32_t tip = tree.add_vertex(nodes.back().at);
  for (std::uint32_t s = 0; s < count; ++s) tree.add_triangle(below + s, below + (s + 1) % count, tip, part);
}

}  // namespace dendro::zbuffer_views
