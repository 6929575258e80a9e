#include "firmware/lib/pixel_planes/tiles.h"

#include <algorithm>
#include <numeric>

namespace dendro::lib {

bool Tile::meets(double left, double top, double right, double bottom, const ArraySite& site) const {
  return left <= x0 + site.width - 1 && right >= x0 && top <= y0 + site.height - 1 && bottom >= y0;
}

std::vector<Tile> tiles_of(int width, int height, const ArraySite& site) {
  if (!site.draws_tiles()) return {Tile{}};
  std::vector<Tile> tiles;
  for (int row = 0; row * site.height < height; ++row)
    for (int column = 0; column * site.width < width; ++column)
      tiles.push_back({column, row, column * site.width, row * site.height});
  return tiles;
}

std::vector<std::vector<std::size_t>> assign(const std::vector<TileWork>& work, std::size_t renderers) {
  std::vector<std::size_t> order(work.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return work[a].weight > work[b].weight; });
  std::vector<std::vector<std::size_t>> lists(renderers);
  std::vector<std::size_t> load(renderers, 0);
  for (const std::size_t tile : order) {
    const auto least = static_cast<std::size_t>(std::min_element(load.begin(), load.end()) - load.begin());
    lists[least].push_back(tile);
    load[least] += work[tile].weight + 1;
  }
  for (std::vector<std::size_t>& list : lists) std::sort(list.begin(), list.end());
  return lists;
}

void serve(IgcDriver& driver, const ArraySite& site, const std::vector<Tile>& tiles, const std::vector<TileWork>& work,
           const std::function<void(std::size_t tile)>& begin, const std::function<void(std::size_t tile, std::size_t k)>& send) {
  if (!site.draws_tiles()) {
    begin(0);
    for (std::size_t k = 0; k < work[0].pieces; ++k) send(0, k);
    return;
  }
  const auto renderers = static_cast<std::size_t>(site.renderers);
  const std::vector<std::vector<std::size_t>> lists = assign(work, renderers);
  struct Place {
    std::size_t tile = 0, piece = 0;  ///< of the renderer's list
  };
  std::vector<Place> places(renderers);
  for (bool busy = true; busy;) {
    busy = false;
    for (std::size_t r = 0; r < renderers; ++r) {
      Place& place = places[r];
      if (place.tile == lists[r].size()) continue;
      busy = true;
      const std::size_t tile = lists[r][place.tile];
      if (renderers > 1) driver.select(r);
      if (place.piece == 0) begin(tile);
      if (place.piece < work[tile].pieces) send(tile, place.piece++);
      if (place.piece < work[tile].pieces) continue;
      driver.copy_tile(tiles[tile].column, tiles[tile].row);
      place = {place.tile + 1, 0};
    }
  }
}

}  // namespace dendro::lib
