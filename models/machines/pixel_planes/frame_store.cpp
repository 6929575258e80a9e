#include "models/machines/pixel_planes/frame_store.h"

namespace dendro::pixel_planes {

FrameStore::FrameStore(const Spec& spec)
    : spec_(spec),
      columns_(spec.frame.width / spec.array.width),
      rows_(spec.frame.height / spec.array.height),
      tiles_(static_cast<std::size_t>(columns_ * rows_)) {}

void FrameStore::copy(unsigned column, unsigned row, const std::vector<Plane>& memory, std::int64_t clock, std::size_t renderer) {
  if (column >= static_cast<unsigned>(columns_) || row >= static_cast<unsigned>(rows_)) return;
  Tile& tile = tiles_[row * static_cast<unsigned>(columns_) + column];
  const std::pair when(clock, renderer);
  if (!tile.memory.empty() && when < tile.when) return;
  tile.memory = memory;
  tile.when = when;
}

std::uint32_t FrameStore::peek(std::uint32_t pixel, unsigned low) const {
  const auto width = static_cast<std::uint32_t>(spec_.frame.width);
  if (width == 0 || pixel / width >= static_cast<std::uint32_t>(spec_.frame.height)) return 0;
  const auto tile_width = static_cast<std::uint32_t>(spec_.array.width), tile_height = static_cast<std::uint32_t>(spec_.array.height);
  const std::uint32_t x = pixel % width, y = pixel / width;
  const std::vector<Plane>& tile = tiles_[y / tile_height * static_cast<std::uint32_t>(columns_) + x / tile_width].memory;
  const std::uint32_t inside = y % tile_height * tile_width + x % tile_width;
  std::uint32_t word = 0;
  for (unsigned bit = low; bit < low + 32 && bit < tile.size(); ++bit)
    word |= static_cast<std::uint32_t>(tile[bit][inside / 64] >> (inside % 64) & 1) << (bit - low);
  return word;
}

}  // namespace dendro::pixel_planes
