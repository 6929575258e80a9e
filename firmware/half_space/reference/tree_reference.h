#pragma once

#include <cstdint>
#include <vector>

#include "firmware/half_space/host/prepare_tree.h"
#include "firmware/half_space/reference/fixed_point.h"
#include "firmware/half_space/reference/hulls_reference.h"

namespace dendro::half_space {

/// The complete tree in double precision: crowns with their fronts moved by the roughening's field, trunks,
/// and the cube's texel at each visible point. A trunk's pixels have the bark's middle colour. `cube` may be
/// empty without a texture.
HullsReference render_tree_reference(const PreparedTree& tree, const CubeBytes& cube);

/// The cube's colour where pixel x, y shows the stored depth, which may have a fraction.
Rgb texel_at(const PreparedTree& tree, const CubeBytes& cube, int x, int y, double depth);

/// What hulls.gia and roughen.gia must leave in the image memory, bit for bit.
FixedPointPicture run_tree_fixed_point(const PreparedTree& tree);

/// As for hulls, with these extra figures: trunk_pixels = pixels marked as trunk; with a texture
/// texels_differ = crown pixels that do not show the texel which double precision finds at their own stored
/// depth, bark_outside = trunk pixels whose colour is not in the bark's range (none, if the colouring is
/// right).
ErrorReport compare(const PreparedTree& tree, const HullsReference& reference, const CubeBytes& cube,
                    const std::vector<std::uint8_t>& nearest, const std::uint8_t* rgb);

}  // namespace dendro::half_space
