#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "models/machines/machine.h"
#include "models/machines/pixel_planes/pixel_planes_spec.h"
#include "models/machines/pixel_planes/pixel_planes_state.h"

namespace dendro::pixel_planes {

/// Pixels of tiles as they were when they were copied; zeros before.
class FrameStore {
 public:
  explicit FrameStore(const Spec& spec);

  /// Keeps an array's memory as tile (column, row), unless a copy of a later `clock`, or in the same of a higher renderer, is there
  /// already; a tile outside the frame is lost.
  void copy(unsigned column, unsigned row, const std::vector<Plane>& memory, std::int64_t clock, std::size_t renderer);

  /// Bits low to low + 31 of pixel y * frame width + x; 0 beyond the memory and outside the frame.
  std::uint32_t peek(std::uint32_t pixel, unsigned low) const;

 private:
  Spec spec_;
  int columns_, rows_;
  struct Tile {
    std::vector<Plane> memory;  ///< empty: not copied yet
    std::pair<std::int64_t, std::size_t> when;
  };
  std::vector<Tile> tiles_;
};

/// What the monitor shows: 24 bits of every pixel from video.base up. `bits(x, y)` gives them.
template <class Bits>
Picture shown(const VideoState& video, int most_width, int most_height, const Bits& bits) {
  Picture picture;
  picture.width = video.width > 0 ? std::min(video.width, most_width) : most_width;
  picture.height = video.height > 0 ? std::min(video.height, most_height) : most_height;
  picture.rgb.reserve(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height) * 3);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const std::uint32_t colour = bits(x, y);
      for (int c = 0; c < 3; ++c) picture.rgb.push_back(static_cast<std::uint8_t>(colour >> (8 * c)));
    }
  return picture;
}

}  // namespace dendro::pixel_planes
