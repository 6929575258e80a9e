#include "firmware/raster_primitives/reference/shadow_reference.h"

#include <algorithm>
#include <cmath>

namespace dendro::raster_primitives {
namespace {

/// Casters by cells of a grid across the light: points in a line with the light fall together.
class Grid {
 public:
  explicit Grid(const Prepared& prepared) : prepared_(prepared) {
    const glm::dvec3 units(1, 1, prepared.depth_scale);
    for (int k = 1; k < 3; ++k)
      if (std::abs(prepared.light[k] / units[k]) > std::abs(prepared.light[along_] / units[along_])) along_ = k;
    for (const auto& caster : prepared.casters)
      for (const glm::dvec3& corner : caster) {
        const Flat at = flat(corner);
        low_ = {std::min(low_.u, at.u), std::min(low_.v, at.v)}, high_ = {std::max(high_.u, at.u), std::max(high_.v, at.v)};
      }
    cells_.resize(kSide * kSide);
    for (std::size_t n = 0; n < prepared.casters.size(); ++n) {
      const auto& [p, q, r] = prepared.casters[n];
      const Flat a = flat(p), b = flat(q), c = flat(r);
      const auto [left, right] = std::minmax({a.u, b.u, c.u});
      const auto [top, bottom] = std::minmax({a.v, b.v, c.v});
      for (int v = cell(top, low_.v, high_.v); v <= cell(bottom, low_.v, high_.v); ++v)
        for (int u = cell(left, low_.u, high_.u); u <= cell(right, low_.u, high_.u); ++u)
          cells_[static_cast<std::size_t>(v * kSide + u)].push_back(n);
    }
  }

  bool hides(const glm::dvec3& point) const {
    const Flat at = flat(point);
    if (at.u < low_.u || at.v < low_.v || at.u > high_.u || at.v > high_.v) return false;
    for (const std::size_t n : cells_[static_cast<std::size_t>(cell(at.v, low_.v, high_.v) * kSide + cell(at.u, low_.u, high_.u))])
      if (is_behind(n, point) && is_inside(n, at)) return true;
    return false;
  }

 private:
  static constexpr int kSide = 256;
  struct Flat {
    double u = 0, v = 0;
  };

  Flat flat(const glm::dvec3& p) const {
    const int i = (along_ + 1) % 3, j = (along_ + 2) % 3;
    const double t = p[along_] / prepared_.light[along_];
    return {p[i] - t * prepared_.light[i], p[j] - t * prepared_.light[j]};
  }

  static int cell(double value, double low, double high) {
    return std::clamp(static_cast<int>((value - low) / std::max(high - low, 1e-300) * kSide), 0, kSide - 1);
  }

  bool is_behind(std::size_t n, const glm::dvec3& p) const {
    const ShadowSetup& s = prepared_.shadows[n];
    const double over = p.z - (s.a * p.x + s.b * p.y + s.c);
    return s.away ? over > s.bias : over < -s.bias;
  }

  bool is_inside(std::size_t n, const Flat& at) const {
    const auto& [p, q, r] = prepared_.casters[n];
    const Flat a = flat(p), b = flat(q), c = flat(r);
    const auto side = [&](const Flat& e, const Flat& f) { return (f.u - e.u) * (at.v - e.v) - (f.v - e.v) * (at.u - e.u); };
    const double x = side(a, b), y = side(b, c), z = side(c, a);
    return (x >= 0 && y >= 0 && z >= 0) || (x <= 0 && y <= 0 && z <= 0);
  }

  const Prepared& prepared_;
  int along_ = 0;
  Flat low_{INFINITY, INFINITY}, high_{-INFINITY, -INFINITY};
  std::vector<std::vector<std::size_t>> cells_;
};

}  // namespace

void cast_shadows(const Prepared& prepared, Reference& picture) {
  const Grid grid(prepared);
  for (int y = 0; y < prepared.height; ++y)
    for (int x = 0; x < prepared.width; ++x) {
      const auto at = static_cast<std::size_t>(y * prepared.width + x);
      if (picture.seen[at] < 0 || !grid.hides({x, y, picture.depth[at]})) continue;
      picture.shadow[at] = true;
      for (std::size_t c = 0; c < 3; ++c) picture.rgb[3 * at + c] /= 2;
    }
}

}  // namespace dendro::raster_primitives
