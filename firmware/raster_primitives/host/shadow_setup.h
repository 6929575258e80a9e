#pragma once

#include <array>
#include <optional>
#include <glm/vec3.hpp>
#include <vector>

#include "firmware/raster_primitives/host/triangle_setup.h"

namespace dendro::raster_primitives {

/// One plane of a shadow: how the stored depth must lie to T(x, y).
struct ShadowPlane {
  enum class Side { kBehind, kBefore, kBeside, kBesideOther };  ///< > T, <= T, T >= 0, T < 0
  Side side = Side::kBehind;
  Stream stream;
};

/// The shadow of a triangle, ASSUMED DEV-098: the first plane is its own, moved away from the light by `bias` units.
struct ShadowSetup {
  std::array<ShadowPlane, 4> planes;
  double a = 0, b = 0, c = 0;  ///< of the triangle's plane, before it is moved
  double bias = 0;
  bool away = false;           ///< the light comes from in front of the plane, so the shadow is behind it
};

// Floating-point operations of a shadow, counted from the formulas of set_up_shadow().
constexpr std::uint64_t kFlopsFacingLight = 5;
constexpr std::uint64_t kFlopsCap = 5 + 4 + 4 + 4 + 3 + 10;          // area, slopes, constant, bias, side, guard
constexpr std::uint64_t kFlopsShadowSide = 6 + 5 + 6 + 1 + 4 + 10;   // normal, side of the third corner, plane, guard
constexpr std::uint64_t kFlopsShadow = kFlopsFacingLight + kFlopsCap + 3 * kFlopsShadowSide;

/// Corners: pixels and depth units; `light` the way the light travels in the same space. Nothing when the triangle's plane holds
/// the line of sight or the light. Triangles that share an edge, on the other side of the light's plane through it, get the same
/// stream for it, so that no pixel falls between their shadows.
std::optional<ShadowSetup> set_up_shadow(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& light,
                                         const TriangleRules& rules);

void send(lib::IgcDriver& driver, const ShadowSetup& shadow);

}  // namespace dendro::raster_primitives
