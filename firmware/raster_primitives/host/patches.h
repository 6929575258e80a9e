#pragma once

#include <string>

#include "sim/scene/mesh.h"

namespace dendro::raster_primitives {

/// Reads bicubic Bézier patches and cuts each into `steps` x `steps` quads of two triangles; triangles without area are left
/// out. A file has the number of patches; per patch 16 control point numbers from 1, row by row, with commas; the number of
/// points; per point x,y,z. Throws UserError `FILE:LINE: message`.
scene::Mesh load_patches(const std::string& path, int steps, const scene::Where& where, const std::string& key);

}  // namespace dendro::raster_primitives
