#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "firmware/raster_primitives/host/prepare.h"

namespace dendro::raster_primitives {

/// The picture in double precision: corners where they are, not on a grid, values not rounded. Row 0 on top.
struct Reference {
  std::vector<double> depth;       ///< Prepared::farthest where nothing is seen
  std::vector<double> rgb;         ///< 3 per pixel, 0..255
  std::vector<std::int32_t> seen;  ///< number of what is seen, triangles before spheres; -1 none
  std::vector<glm::dvec2> texel;   ///< u, v in texels where what is seen has a texture
  std::vector<bool> textured;
  std::vector<bool> shadow;        ///< the colour is halved
  /// The pixel and all its neighbours see one primitive, all in shadow or none, so that moving its corners by less than a pixel changes nothing but
  /// values.
  std::vector<bool> inner;
};

Reference render_reference(const Prepared& prepared);

}  // namespace dendro::raster_primitives
