#pragma once

#include "firmware/half_space/host/texture_settings.h"

namespace dendro::half_space {

/// The cube and its MIP levels on integers, bit for bit what texture.gia leaves in the frame buffer.
/// settings.kind is not kNone. A level's byte c of texel (x, y, z) is at ((z * side + y) * side + x) * 4 + c.
///
/// Chunks: the base colour everywhere; each chunk draws x, y, z (the high bits of a number, counted from its
/// seed's origin) and its colour, and covers what is there; it goes on at the other side where it leaves the
/// cube. Displacement 0. Fbm: texel (0, 0, 0) has value 128. Cells of half the edge each time: the middles of
/// all cells from their 8 corners, then of all faces from 4 corners and twice the 2 middles of cells beside
/// it, then of all edges from 4 middles of faces and twice their 2 ends, each as (sum of 8 + displacement) /
/// 8 to the nearest within 0..255. A step's faces across z go first, then those across x and y, edges along
/// z, x and y likewise; in each the axes follow cyclically, the next but one outermost. MIP: the floor of the
/// mean of 2 x 2 x 2, byte by byte.
CubeBytes make_texture(const TextureSettings& settings);

}  // namespace dendro::half_space
