#include "firmware/zbuffer_views/stability/plane.h"

#include <cmath>

namespace dendro::zbuffer_views {
namespace {

using Exact3 = std::array<mpq_class, 3>;

Exact3 cross(const Exact3& a, const Exact3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
mpq_class dot(const Exact3& a, const Exact3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
template <typename T>
Exact3 row_of(const T* row) {
  return {mpq_class(row[0]), mpq_class(row[1]), mpq_class(row[2])};
}

/// The point with right · p = x, up · p = y on the plane.
Exact3 point(const Plane& plane, const float* frame, double x, double y) {
  const Exact3 right = row_of(frame), up = row_of(frame + 3), normal = row_of(plane.normal.data());
  const Exact3 of_x = cross(up, normal), of_y = cross(normal, right), of_d = cross(right, up);
  const mpq_class volume = dot(right, of_x);
  Exact3 p;
  for (std::size_t i = 0; i < 3; ++i)
    p[i] = (mpq_class(x) * of_x[i] + mpq_class(y) * of_y[i] + mpq_class(plane.distance) * of_d[i]) / volume;
  return p;
}

}  // namespace

double Plane::depth(const float* frame, double x, double y) const {
  return mpq_class(dot(row_of(frame + 6), point(*this, frame, x, y))).get_d();
}

bool Plane::contains(const float* frame, double x, double y, double margin) const {
  const Exact3 p = point(*this, frame, x, y);
  const mpq_class level(half - margin), upright(half_up - margin);
  return abs(p[0]) <= level && abs(p[1]) <= upright && abs(p[2]) <= level;
}

double Plane::steepness(const float* frame) const {
  const double origin = depth(frame, 0, 0);
  return std::abs(depth(frame, 1, 0) - origin) + std::abs(depth(frame, 0, 1) - origin);
}

void store_plane(ViewsFile& views, std::size_t view, const Plane& plane, std::uint8_t colour) {
  const zbv_view& v = views.views[view];
  const float* frame = v.frame;
  const double origin = plane.depth(frame, 0, 0), across = plane.depth(frame, 1, 0) - origin,
               up = plane.depth(frame, 0, 1) - origin;
  for (int j = 0; j < static_cast<int>(views.facts.height); ++j)
    for (int i = 0; i < static_cast<int>(views.facts.width); ++i) {
      const double x = static_cast<double>(v.x0) + i * static_cast<double>(views.facts.pitch),
                   y = static_cast<double>(v.y0) + j * static_cast<double>(views.facts.pitch);
      const double z = origin + across * x + up * y;
      bool inside = true;
      for (std::size_t k = 0; k < 3; ++k)
        inside = inside && std::abs(frame[k] * x + frame[3 + k] * y + frame[6 + k] * z) <= (k == 1 ? plane.half_up : plane.half);
      if (inside) put_sample(views, view, i, j, static_cast<float>(z), colour);
    }
}

}  // namespace dendro::zbuffer_views
