#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vec3.hpp>

namespace dendro::zbuffer_views {

/// Calls visit(i, j, weights) for every sample (i, j) of width x height that the triangle covers: corners in units of samples,
/// y up; left edge <= x < right edge, lower end <= y < upper end. The weights of the corners add up to 1.
template <class Visit>
void scan_triangle(std::array<glm::dvec3, 3> p, int width, int height, const Visit& visit) {
  const auto cross = [](const glm::dvec3& a, const glm::dvec3& b, double x, double y) {
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
  };
  double area = cross(p[0], p[1], p[2].x, p[2].y);
  const bool swapped = area < 0;
  if (swapped) std::swap(p[1], p[2]), area = -area;
  if (!(area > 0)) return;
  const auto clamped = [](double v, int high) { return static_cast<int>(std::clamp(v, -1.0, double(high))); };
  const int x0 = std::max(0, clamped(std::ceil(std::min({p[0].x, p[1].x, p[2].x})), width));
  const int x1 = std::min(width - 1, clamped(std::floor(std::max({p[0].x, p[1].x, p[2].x})), width));
  const int y0 = std::max(0, clamped(std::ceil(std::min({p[0].y, p[1].y, p[2].y})), height));
  const int y1 = std::min(height - 1, clamped(std::floor(std::max({p[0].y, p[1].y, p[2].y})), height));
  for (int j = y0; j <= y1; ++j)
    for (int i = x0; i <= x1; ++i) {
      std::array<double, 3> weight{};
      bool inside = true;
      for (int e = 0; e < 3 && inside; ++e) {
        const glm::dvec3 &a = p[(e + 1) % 3], &b = p[(e + 2) % 3];
        const double value = cross(a, b, i, j);
        // Counter-clockwise a left edge goes down and a lower one to the right.
        const bool owns = b.y < a.y || (b.y == a.y && b.x > a.x);
        inside = value > 0 || (value == 0 && owns);
        weight[static_cast<std::size_t>(e)] = value / area;
      }
      if (!inside) continue;
      if (swapped) std::swap(weight[1], weight[2]);
      visit(i, j, weight);
    }
}

}  // namespace dendro::zbuffer_views
