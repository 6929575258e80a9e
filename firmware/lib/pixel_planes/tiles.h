#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "firmware/lib/pixel_planes/array_job.h"
#include "firmware/lib/pixel_planes/igc_driver.h"

namespace dendro::lib {

/// A part of the picture as large as an array: pixels (x0, y0) and so on.
struct Tile {
  int column = 0, row = 0;
  int x0 = 0, y0 = 0;

  /// Some pixel from left to right and top to bottom lies in it. Bounds may lie anywhere.
  bool meets(double left, double top, double right, double bottom, const ArraySite& site) const;
};

/// The tiles of a picture, row by row; the array itself for a machine that does not draw in tiles.
std::vector<Tile> tiles_of(int width, int height, const ArraySite& site);

// Instructions of the host that sorts what is to be drawn into tiles.
constexpr std::uint64_t kInstructionsBin = 4 * 2 + 2;  // four bounds to numbers of tiles, loops over columns and rows
constexpr std::uint64_t kInstructionsBinTile = 4;      // load the end of the tile's list, store, count, test

/// A tile's work as the host sends it.
struct TileWork {
  std::size_t pieces = 0;  ///< sent one after another
  std::size_t weight = 0;  ///< commands in all, or anything in proportion
};

/// Tiles by renderer, each in the order of their number: the heaviest first to the one with the least work.
std::vector<std::vector<std::size_t>> assign(const std::vector<TileWork>& work, std::size_t renderers);

/// Sends all work: the renderers are served in turn, a piece at a time, each with one tile after another. `begin(tile)` comes
/// before a tile's first piece, `send(tile, k)` is its piece k; a copy ends it. A machine that does not draw in tiles has one
/// tile and is told of none.
void serve(IgcDriver& driver, const ArraySite& site, const std::vector<Tile>& tiles, const std::vector<TileWork>& work,
           const std::function<void(std::size_t tile)>& begin, const std::function<void(std::size_t tile, std::size_t k)>& send);

}  // namespace dendro::lib
