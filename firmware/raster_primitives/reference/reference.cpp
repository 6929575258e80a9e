#include "firmware/raster_primitives/reference/reference.h"

#include <algorithm>
#include <cmath>

#include "firmware/raster_primitives/reference/shadow_reference.h"

namespace dendro::raster_primitives {
namespace {

class Renderer {
 public:
  explicit Renderer(const Prepared& prepared) : prepared_(prepared) {
    const std::size_t pixels = static_cast<std::size_t>(prepared.width) * static_cast<std::size_t>(prepared.height);
    out_.depth.assign(pixels, prepared.farthest);
    out_.seen.assign(pixels, -1);
    out_.texel.resize(pixels), out_.textured.assign(pixels, false);
    for (std::size_t i = 0; i < pixels; ++i)
      out_.rgb.insert(out_.rgb.end(), prepared.background.begin(), prepared.background.end());
  }

  void triangle(const ScreenTriangle& triangle, std::int32_t number) {
    const auto& [a, b, c] = triangle.corners;
    const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    if (area == 0) return;
    const auto [left, right] = std::minmax({a.x, b.x, c.x});
    const auto [top, bottom] = std::minmax({a.y, b.y, c.y});
    const int x_end = std::min(prepared_.width - 1, static_cast<int>(std::floor(right)));
    const int y_end = std::min(prepared_.height - 1, static_cast<int>(std::floor(bottom)));
    for (int y = std::max(0, static_cast<int>(std::ceil(top))); y <= y_end; ++y)
      for (int x = std::max(0, static_cast<int>(std::ceil(left))); x <= x_end; ++x) {
        const double u = ((x - a.x) * (c.y - a.y) - (c.x - a.x) * (y - a.y)) / area;
        const double v = ((b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y)) / area;
        if (u < 0 || v < 0 || u + v > 1) continue;
        const double w = 1 - u - v;
        const std::array<double, 3> rgb = {w * a.colour[0] + u * b.colour[0] + v * c.colour[0],
                                           w * a.colour[1] + u * b.colour[1] + v * c.colour[1],
                                           w * a.colour[2] + u * b.colour[2] + v * c.colour[2]};
        const double depth = w * a.depth + u * b.depth + v * c.depth;
        if (prepared_.is_textured(triangle))
          see_texel(x, y, depth, {w * a.u + u * b.u + v * c.u, w * a.v + u * b.v + v * c.v}, number);
        else
          see(x, y, depth, rgb, number);
      }
  }

  void sphere(const ScreenSphere& sphere, std::int32_t number) {
    const int x_end = std::min(prepared_.width - 1, static_cast<int>(std::floor(sphere.x + sphere.radius)));
    const int y_end = std::min(prepared_.height - 1, static_cast<int>(std::floor(sphere.y + sphere.radius)));
    for (int y = std::max(0, static_cast<int>(std::ceil(sphere.y - sphere.radius))); y <= y_end; ++y)
      for (int x = std::max(0, static_cast<int>(std::ceil(sphere.x - sphere.radius))); x <= x_end; ++x) {
        const double u = (x - sphere.x) / sphere.radius, v = (y - sphere.y) / sphere.radius;
        if (u * u + v * v > 1) continue;
        const double w = std::sqrt(1 - u * u - v * v);
        const double cosine = u * sphere.light[0] + v * sphere.light[1] + w * sphere.light[2];
        std::array<double, 3> rgb{};
        for (std::size_t c = 0; c < 3; ++c) rgb[c] = sphere.level[c] + sphere.swing[c] * cosine;
        see(x, y, sphere.depth - w * sphere.depth_radius, rgb, number);
      }
  }

  Reference finish() {
    out_.shadow.assign(out_.seen.size(), false);
    if (prepared_.layout.shadows) cast_shadows(prepared_, out_);
    out_.inner.resize(out_.seen.size());
    const int w = prepared_.width, h = prepared_.height;
    for (int y = 1; y + 1 < h; ++y)
      for (int x = 1; x + 1 < w; ++x) {
        bool same = true;
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx)
            same = same && out_.seen[at(x + dx, y + dy)] == out_.seen[at(x, y)] &&
                   out_.shadow[at(x + dx, y + dy)] == out_.shadow[at(x, y)];
        out_.inner[at(x, y)] = same && out_.seen[at(x, y)] >= 0;
      }
    return std::move(out_);
  }

 private:
  std::size_t at(int x, int y) const { return static_cast<std::size_t>(y * prepared_.width + x); }

  void see_texel(int x, int y, double depth, const glm::dvec2& texel, std::int32_t number) {
    const std::uint32_t rgb = prepared_.texture.at(static_cast<std::int64_t>(std::floor(texel.x)),
                                                   static_cast<std::int64_t>(std::floor(texel.y)));
    const auto part = [&](unsigned c) { return static_cast<double>(rgb >> (8 * c) & 255); };
    if (see(x, y, depth, {part(0), part(1), part(2)}, number)) out_.texel[at(x, y)] = texel, out_.textured[at(x, y)] = true;
  }

  /// Whether it is nearer than what is there.
  bool see(int x, int y, double depth, const std::array<double, 3>& rgb, std::int32_t number) {
    const std::size_t pixel = at(x, y);
    if (depth >= out_.depth[pixel]) return false;
    out_.textured[pixel] = false;
    out_.depth[pixel] = depth, out_.seen[pixel] = number;
    std::copy(rgb.begin(), rgb.end(), out_.rgb.begin() + static_cast<std::ptrdiff_t>(3 * pixel));
    return true;
  }

  const Prepared& prepared_;
  Reference out_;
};

}  // namespace

Reference render_reference(const Prepared& prepared) {
  Renderer renderer(prepared);
  std::int32_t number = 0;
  for (const ScreenTriangle& triangle : prepared.triangles) renderer.triangle(triangle, number++);
  for (const ScreenSphere& sphere : prepared.spheres) renderer.sphere(sphere, number++);
  return renderer.finish();
}

}  // namespace dendro::raster_primitives
