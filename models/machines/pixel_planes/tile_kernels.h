#pragma once

#include <cstddef>
#include <cstdint>

#include "models/machines/pixel_planes/macro.h"

namespace dendro::pixel_planes {

constexpr int kTileSide = 16;
constexpr int kTilePixels = kTileSide * kTileSide;

/// A field of one tile: a number a pixel, row by row. Aligned for the widest vectors.
struct alignas(64) TileField {
  std::uint32_t values[kTilePixels] = {};
};

/// A macro-operation on one tile.
struct TileOp {
  MacroKind kind;
  std::uint32_t* field[3];  ///< values of TileFields; those that the kind does not have are not looked at
  std::int32_t most;        ///< all ones of field 0
  std::int64_t a, b, c;     ///< the expression, c at the tile's first pixel
  int fraction, stream_bits;
  bool narrow;  ///< on this tile a·x + b·y + c fits 32 bits and stream_bits, before it is wrapped
  std::uint32_t constant, match;  ///< what is written, and for kPaintIndex what field 0 is compared with
};

/// Applies the operations in order, with the best instruction set of the host.
void run_tile(const TileOp* ops, std::size_t count);

}  // namespace dendro::pixel_planes
