#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "firmware/lib/pixel_planes/array_job.h"
#include "firmware/lib/pixel_planes/tiles.h"
#include "firmware/raster_primitives/host/layout.h"
#include "firmware/raster_primitives/host/shadow_setup.h"
#include "firmware/raster_primitives/host/sphere_setup.h"
#include "firmware/raster_primitives/host/texture.h"
#include "firmware/raster_primitives/host/triangle_setup.h"
#include "sim/scene/scene.h"

namespace dendro::raster_primitives {

using lib::ArraySite;

/// A triangle on the screen before it is set up.
struct ScreenTriangle {
  std::array<ScreenVertex, 3> corners;
  std::size_t object = 0;
};

/// What is sent to the array that draws a tile, in its coordinates.
struct TileDrawing {
  lib::Tile tile;
  std::vector<TriangleSetup> triangles;
  std::vector<SphereSetup> spheres;
  std::vector<ShadowSetup> shadows;
  bool texels = false;  ///< something in it has a texture
};

/// A scene ready to be drawn.
struct Prepared {
  int width = 0, height = 0;
  Layout layout;
  TriangleRules rules;
  std::array<double, 3> background{};  ///< 0..255
  double depth_scale = 1, depth_shift = 0;  ///< units = scale · metres along the view + shift
  std::uint32_t farthest = 0;               ///< depth of the background
  Texture texture;
  std::map<std::size_t, Mapping> mappings;  ///< objects with the texture
  std::vector<ScreenTriangle> triangles;    ///< those that can cover a pixel
  std::vector<TriangleSetup> set_up;        ///< of those with area on the grid, in their order
  std::vector<ScreenSphere> spheres;        ///< those that can cover a pixel
  std::vector<SphereSetup> sphere_set_up;   ///< of the same
  std::vector<ShadowSetup> shadows;         ///< of the triangles that face the light, in the picture or not
  std::vector<std::array<glm::dvec3, 3>> casters;  ///< those triangles: pixels and units
  glm::dvec3 light{};                       ///< the way the light travels, in pixels and units
  std::vector<TileDrawing> tiles;           ///< the array itself on a machine that does not draw in tiles
  std::uint64_t vertex_flops = 0;           ///< transforms, normals, shades
  std::size_t given = 0;                    ///< triangles of all objects
  std::size_t spheres_given = 0;
  std::size_t facing_away = 0, outside = 0, without_area = 0, flat = 0;
  std::vector<std::string> files;

  bool is_textured(const ScreenTriangle& triangle) const { return mappings.count(triangle.object) != 0; }
};

// Floating-point operations, counted from the formulas of prepare().
constexpr std::uint64_t kFlopsTransformVertex = 18 + 2;     // affine map to the screen, depth to units
constexpr std::uint64_t kFlopsRotateNormal = 15;
constexpr std::uint64_t kFlopsShadeVertex = 5 + 4 + 3;      // n·L, to a shade, to three colours
constexpr std::uint64_t kFlopsFacing = 5;                   // sign of the area on the screen

constexpr std::uint64_t kFlopsMapVertex = 3 + 2 * 5;        // from the origin, two products; their lengths are divided out once

// Instructions of a texel: load its colour, put its coordinates above it, count, test.
constexpr std::uint64_t kInstructionsTexel = 5;

// Of them, and of those of the set-ups, what comes anew in every tile: constants at its corner, guards.
constexpr std::uint64_t kFlopsTileTriangle = 7 * 4 + kFlopsGuards;
constexpr std::uint64_t kFlopsTileTextured = kFlopsTileTriangle - 4;

constexpr std::uint64_t tile_flops_of(const TriangleSetup& triangle) {
  return triangle.texel ? kFlopsTileTextured : kFlopsTileTriangle;
}
constexpr std::uint64_t kFlopsTileSphere = 2 + 2 + 5 + 3 * 4;
constexpr std::uint64_t kFlopsTileShadow = 4 * (4 + 10);

/// Throws UserError for what cannot be drawn.
Prepared prepare(const scene::Scene& scene, const ArraySite& site);

/// Where the fields of a pixel lie for this scene. Throws UserError when the memory has too few bits.
Layout choose_layout(const scene::Scene& scene, const ArraySite& site);

}  // namespace dendro::raster_primitives
