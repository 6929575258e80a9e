#include "firmware/raster_primitives/host/shadow_setup.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <tuple>

namespace dendro::raster_primitives {
namespace {

using Side = ShadowPlane::Side;

/// Pixels by which a plane may lean over the whole range of depths and still be taken for one that holds the line of sight.
constexpr double kLean = 0.25;
/// A surface shadows itself where its corners were moved to the grid; away from its slope by so many pixels it does not.
constexpr double kBiasPixels = 0.75, kBiasUnits = 2;

struct Plane {
  double a = 0, b = 0, c = 0;
};

/// Bits before the point, of those above `have`, that hold the values at all pixels, sign included.
unsigned guard_of(const Plane& plane, unsigned have, const TriangleRules& rules) {
  double most = 1;
  for (const double x : {0.0, rules.width - 1.0})
    for (const double y : {0.0, rules.height - 1.0}) most = std::max(most, std::abs(plane.a * x + plane.b * y + plane.c) + 1);
  int exponent = 0;
  std::frexp(most, &exponent);
  return static_cast<unsigned>(std::max(1, exponent + 1 - static_cast<int>(have)));
}

Stream stream_of(const Plane& plane, unsigned fraction, unsigned have, const TriangleRules& rules) {
  Stream stream;
  stream.at = {static_cast<float>(plane.a), static_cast<float>(plane.b), static_cast<float>(plane.c)};
  stream.fraction = fraction;
  stream.guard = guard_of(plane, have, rules);
  return stream;
}

bool before_in_order(const glm::dvec3& p, const glm::dvec3& q) {
  return std::tuple(p.x, p.y, p.z) < std::tuple(q.x, q.y, q.z);
}

/// The plane through the edge p q and the light; `inside` lies where the shadow is.
ShadowPlane side(glm::dvec3 p, glm::dvec3 q, const glm::dvec3& inside, const glm::dvec3& light, const TriangleRules& rules) {
  if (before_in_order(q, p)) std::swap(p, q);
  const glm::dvec3 n = glm::cross(q - p, light);
  const bool positive = glm::dot(n, inside - p) > 0;
  const double level = std::hypot(n.x, n.y), range = std::ldexp(1.0, static_cast<int>(rules.depth_bits));
  ShadowPlane out;
  if (std::abs(n.z) * range <= kLean * level) {
    // In pixels' distances, of which a picture needs few bits before the point and the fraction's behind it.
    const Plane line = {n.x / level, n.y / level, -(n.x * p.x + n.y * p.y) / level};
    out.side = positive ? Side::kBeside : Side::kBesideOther;
    out.stream = stream_of(line, rules.fraction, 0, rules);
    return out;
  }
  const Plane plane = {-n.x / n.z, -n.y / n.z, glm::dot(n, p) / n.z};
  out.side = positive == (n.z > 0) ? Side::kBehind : Side::kBefore;
  out.stream = stream_of(plane, rules.fraction, rules.depth_bits, rules);
  return out;
}

}  // namespace

std::optional<ShadowSetup> set_up_shadow(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& light,
                                         const TriangleRules& rules) {
  const auto& [p, q, r] = corners;
  const glm::dvec3 n = glm::cross(q - p, r - p);
  const double level = std::hypot(n.x, n.y), range = std::ldexp(1.0, static_cast<int>(rules.depth_bits));
  if (std::abs(n.z) * range <= kLean * level || n.z == 0 || glm::dot(n, light) == 0) return std::nullopt;
  ShadowSetup out;
  out.a = -n.x / n.z, out.b = -n.y / n.z, out.c = glm::dot(n, p) / n.z;
  out.bias = kBiasUnits + kBiasPixels * (std::abs(out.a) + std::abs(out.b));
  out.away = light.z - out.a * light.x - out.b * light.y > 0;
  out.planes[0].side = out.away ? Side::kBehind : Side::kBefore;
  out.planes[0].stream =
      stream_of({out.a, out.b, out.c + (out.away ? out.bias : -out.bias)}, rules.fraction, rules.depth_bits, rules);
  for (std::size_t k = 0; k < 3; ++k)
    out.planes[k + 1] = side(corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3], light, rules);
  return out;
}

void send(lib::IgcDriver& driver, const ShadowSetup& shadow) {
  bool first = true;
  for (const ShadowPlane& plane : shadow.planes) {
    switch (plane.side) {
      case Side::kBehind: send(driver, first ? "behind_first" : "behind", plane.stream); break;
      case Side::kBefore: send(driver, first ? "before_first" : "before", plane.stream); break;
      case Side::kBeside: send(driver, "beside", plane.stream); break;
      case Side::kBesideOther: send(driver, "beside_other", plane.stream); break;
    }
    first = false;
  }
  driver.run("add_shadow");
}

}  // namespace dendro::raster_primitives
