#include "firmware/raster_primitives/host/triangle_setup.h"

#include <algorithm>
#include <cmath>

#include "firmware/lib/pixel_planes/array_job.h"
#include "sim/base/check.h"

namespace dendro::raster_primitives {
namespace {

struct Snapped {
  std::int64_t x, y;
};

/// Inside on its left, seen along (dx, dy) with y down; of two triangles that share it one has its pixels.
Stream edge(const Snapped& p, const Snapped& q, const TriangleRules& rules) {
  const std::int64_t dx = q.x - p.x, dy = q.y - p.y;
  const bool own = dy > 0 || (dy == 0 && dx > 0);
  const std::int64_t whole = dy * p.x - dx * p.y - (own ? 0 : 1);
  // Slopes are multiples of the grid, so what is below a pixel's step in the constant cannot change the sign.
  const std::int64_t c = whole >> rules.subpixel_bits;
  Stream out;
  out.at.a = static_cast<float>(-dy), out.at.b = static_cast<float>(dx), out.at.c = static_cast<float>(c);
  DENDRO_CHECK(static_cast<std::int64_t>(out.at.c) == c, "edge constant {}", c);
  out.guard = lib::signed_bits(-dy, dx, c, rules.width, rules.height);
  return out;
}

double most_steep(const TriangleRules& rules) {
  return std::ldexp(1.0, 22 + std::max(0, static_cast<int>(rules.depth_bits) - 20));
}

/// The plane through three values; flat where single precision does not carry it.
struct Plane {
  double a = 0, b = 0, c = 0;
  bool flat = false;
};

Plane plane(const std::array<double, 3>& x, const std::array<double, 3>& y, const std::array<double, 3>& v,
            double inverse_area, const TriangleRules& rules) {
  const double v1 = v[1] - v[0], v2 = v[2] - v[0];
  Plane p;
  p.a = (v1 * (y[2] - y[0]) - v2 * (y[1] - y[0])) * inverse_area;
  p.b = (v2 * (x[1] - x[0]) - v1 * (x[2] - x[0])) * inverse_area;
  p.c = v[0] - p.a * x[0] - p.b * y[0];
  p.flat = std::abs(p.a) * rules.width + std::abs(p.b) * rules.height + std::abs(p.c) > most_steep(rules);
  return p;
}

Stream send_as(const Plane& plane, bool flat, double middle, double add, unsigned fraction) {
  Stream out;
  out.fraction = fraction;
  out.at.a = flat ? 0 : static_cast<float>(plane.a);
  out.at.b = flat ? 0 : static_cast<float>(plane.b);
  out.at.c = static_cast<float>((flat ? middle : plane.c) + add);
  return out;
}

}  // namespace

double farthest_corner(const TriangleRules& rules) {
  // The constant is at most twice the square of the farthest coordinate in grid steps, over the steps of a pixel.
  return std::floor(std::sqrt(std::ldexp(1.0, 23 + static_cast<int>(rules.subpixel_bits)))) /
         std::ldexp(1.0, static_cast<int>(rules.subpixel_bits)) - 1;
}

double depth_margin(const TriangleRules& rules) {
  return 2 + std::ldexp(1.0, static_cast<int>(rules.depth_bits) - 20) +
         std::ldexp(rules.width + rules.height, -static_cast<int>(rules.fraction) - 1);
}

std::optional<TriangleSetup> set_up(const std::array<ScreenVertex, 3>& corners, const TriangleRules& rules) {
  const double grid = std::ldexp(1.0, static_cast<int>(rules.subpixel_bits));
  std::array<Snapped, 3> at{};
  std::array<double, 3> x{}, y{};
  for (int k = 0; k < 3; ++k) {
    DENDRO_CHECK(std::abs(corners[k].x) <= farthest_corner(rules) && std::abs(corners[k].y) <= farthest_corner(rules),
                 "corner at {} {}", corners[k].x, corners[k].y);
    at[k] = {std::llround(corners[k].x * grid), std::llround(corners[k].y * grid)};
    x[k] = static_cast<double>(at[k].x) / grid, y[k] = static_cast<double>(at[k].y) / grid;
  }
  const std::int64_t area =
      (at[1].x - at[0].x) * (at[2].y - at[0].y) - (at[2].x - at[0].x) * (at[1].y - at[0].y);
  if (area == 0) return std::nullopt;
  TriangleSetup out;
  for (int k = 0; k < 3; ++k) {
    const Snapped &p = at[k], &q = at[(k + 1) % 3];
    out.edge[k] = area > 0 ? edge(p, q, rules) : edge(q, p, rules);
  }
  const double inverse_area = grid * grid / static_cast<double>(area);
  std::array<Plane, 4> planes;
  std::array<double, 4> middle{};
  for (int v = 0; v < 4; ++v) {
    std::array<double, 3> values{};
    for (int k = 0; k < 3; ++k) values[k] = v == 0 ? corners[k].depth : corners[k].colour[v - 1];
    planes[v] = plane(x, y, values, inverse_area, rules);
    out.flat = out.flat || planes[v].flat;
    middle[v] = (values[0] + values[1] + values[2]) / 3;
  }
  out.depth = send_as(planes[0], out.flat, middle[0], 0, rules.fraction);
  for (int v = 1; v < 4; ++v) out.colour[v - 1] = send_as(planes[v], out.flat, middle[v], 0.5, rules.fraction);
  return out;
}

double texel_rounding(double a, double b, double u, const TriangleRules& rules) {
  const double most = std::abs(u) + 2 * (std::abs(a) * rules.width + std::abs(b) * rules.height);
  return std::ldexp(1.0 + rules.width + rules.height, -static_cast<int>(rules.fraction + kTexelFraction) - 1) + std::ldexp(most, -22);
}

std::array<Stream, 2> set_up_texture(const std::array<ScreenVertex, 3>& corners, const TriangleRules& rules) {
  const auto& [p, q, r] = corners;
  const double area = (q.x - p.x) * (r.y - p.y) - (r.x - p.x) * (q.y - p.y);
  const std::array<double, 3> x = {p.x, q.x, r.x}, y = {p.y, q.y, r.y}, u = {p.u, q.u, r.u}, v = {p.v, q.v, r.v};
  std::array<Stream, 2> out;
  for (std::size_t k = 0; k < 2; ++k) {
    const std::array<double, 3>& value = k == 0 ? u : v;
    const Plane through = area == 0 ? Plane{} : plane(x, y, value, 1 / area, rules);
    out[k] = send_as(through, area == 0 || through.flat, (value[0] + value[1] + value[2]) / 3, 0, rules.fraction + kTexelFraction);
  }
  return out;
}

void send(lib::IgcDriver& driver, const char* program, const Stream& stream) {
  driver.run(program, stream.at, stream.fraction, stream.guard);
}

void send(lib::IgcDriver& driver, const TriangleSetup& triangle) {
  send(driver, "edge_first", triangle.edge[0]);
  send(driver, "edge", triangle.edge[1]);
  send(driver, "edge", triangle.edge[2]);
  send(driver, "depth_test", triangle.depth);
  if (triangle.texel) {
    send(driver, "texture_u", (*triangle.texel)[0]);
    send(driver, "texture_v", (*triangle.texel)[1]);
    return;
  }
  send(driver, "red", triangle.colour[0]);
  send(driver, "green", triangle.colour[1]);
  send(driver, "blue", triangle.colour[2]);
}

}  // namespace dendro::raster_primitives
