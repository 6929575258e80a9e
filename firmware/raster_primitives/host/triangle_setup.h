#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "firmware/lib/pixel_planes/igc_driver.h"

namespace dendro::raster_primitives {

/// An expression and how many of its bits are streamed behind and before the point.
struct Stream {
  lib::Expression at;
  unsigned fraction = 0, guard = 0;
};

/// A corner on the screen: pixels, depth units, colours 0..255.
struct ScreenVertex {
  double x = 0, y = 0, depth = 0;
  std::array<double, 3> colour{};
  double u = 0, v = 0;  ///< texels, of corners with a texture
};

/// What the host needs to know to set up triangles.  ASSUMED DEV-095
struct TriangleRules {
  int width = 512, height = 512;  ///< of the array
  unsigned depth_bits = 16;
  unsigned fraction = 10;       ///< bits behind the point of depths and colours
  unsigned subpixel_bits = 2;   ///< corners lie on multiples of 2^-this
};

/// A triangle as it is sent.
struct TriangleSetup {
  std::array<Stream, 3> edge;    ///< >= 0 inside; exact integers
  Stream depth;
  std::array<Stream, 3> colour;  ///< with the half that makes cutting off the fraction rounding
  std::optional<std::array<Stream, 2>> texel;  ///< u and v in place of colours
  bool flat = false;                 ///< too thin for its slopes: depth and colours are those of its middle
};

// Floating-point operations of a triangle, counted from the formulas of set_up().
constexpr std::uint64_t kFlopsSnap = 3 * 2 * 2;
constexpr std::uint64_t kFlopsEdges = 3 * (2 + 3 + 2);   // two differences, the cross product, its rounding
constexpr std::uint64_t kFlopsGuards = 3 * (2 + 4 + 4);  // the four corner values of an edge and their extremes
constexpr std::uint64_t kFlopsArea = 3 + 1;              // and its reciprocal
constexpr std::uint64_t kFlopsPlane = 2 + 4 + 4 + 4 + 5; // differences, two slopes, constant, test for steepness
constexpr std::uint64_t kFlopsTriangle = kFlopsSnap + kFlopsEdges + kFlopsGuards + kFlopsArea + 4 * kFlopsPlane;

/// Of textured ones: two planes in place of three, and the area before corners were moved.
constexpr std::uint64_t kFlopsTexturedTriangle = kFlopsTriangle - kFlopsPlane + kFlopsArea;

constexpr std::uint64_t flops_of(const TriangleSetup& triangle) {
  return triangle.texel ? kFlopsTexturedTriangle : kFlopsTriangle;
}

/// Texture coordinates have so many more bits behind the point than depths: half a unit of the last, at the array's far
/// corner, must be little against a texel.
constexpr unsigned kTexelFraction = 6;

/// Furthest from the texture's origin, in texels, that a corner may lie.
constexpr double kFarthestTexel = 4096;

/// Furthest from the texel it should be that a coordinate comes out, in texels: the roundings of the coefficients, with |a|,
/// |b| the slopes a pixel and |u| the value.
double texel_rounding(double a, double b, double u, const TriangleRules& rules);

/// Furthest from the array's origin, in pixels, that a corner may lie: beyond it an edge's constant is not exact in single
/// precision.
double farthest_corner(const TriangleRules& rules);

/// Distance in depth units that corners keep from the ends of the range, so that no depth inside a triangle leaves it.
double depth_margin(const TriangleRules& rules);

/// Nothing for a triangle without area after its corners were moved to the grid. Corners may be in either order and must not lie
/// beyond farthest_corner().
std::optional<TriangleSetup> set_up(const std::array<ScreenVertex, 3>& corners, const TriangleRules& rules);

/// u and v through the corners where they are, not moved to the grid: parallel projection makes them linear on the screen.
std::array<Stream, 2> set_up_texture(const std::array<ScreenVertex, 3>& corners, const TriangleRules& rules);

/// A command whose program streams `stream`.
void send(lib::IgcDriver& driver, const char* program, const Stream& stream);

void send(lib::IgcDriver& driver, const TriangleSetup& triangle);

}  // namespace dendro::raster_primitives
