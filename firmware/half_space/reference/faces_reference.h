#pragma once

#include <cstdint>
#include <vector>

#include "firmware/half_space/pixel_planes/prepare_planes.h"

namespace dendro::half_space {

/// Several hulls with flat faces in double precision, straight from the planes: per pixel the nearest front plane of all
/// hulls that cover it. Knows nothing of streams, guard bits or fixed point.
struct FacesReference {
  std::vector<int> face;          ///< per pixel: index into PreparedPlanes::faces, -1: background
  std::vector<int> hull;          ///< per pixel: -1: background
  std::vector<double> depth;      ///< in register units; maxdepth where no hull is
  std::vector<std::uint8_t> rgb;
};

FacesReference render_faces_reference(const PreparedPlanes& prepared);

}  // namespace dendro::half_space
