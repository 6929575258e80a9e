#include "firmware/half_space/reference/roughen_model.h"

#include <algorithm>

#include "firmware/half_space/host/hulls_layout.h"
#include "firmware/half_space/reference/seeded_random.h"

namespace dendro::half_space {
namespace {

/// The field while it grows, 16 fraction bits, on a torus.
class Tile {
 public:
  std::int64_t& at(int x, int y) {
    const auto wrap = [](int v) { return static_cast<std::size_t>((v + kTileSide) % kTileSide); };
    return values_[wrap(y) * kTileSide + wrap(x)];
  }
  const std::vector<std::int64_t>& values() const { return values_; }

 private:
  std::vector<std::int64_t> values_ = std::vector<std::int64_t>(kTileSide * kTileSide, 0);
};

/// Floor of a quarter, and of a random number in 2^-15 times an amplitude in 2^-7 as 16.16.
std::int64_t displaced(std::int64_t sum, std::uint32_t amplitude, SeededRandom& random) {
  const std::int64_t product = std::int64_t{random.next_signed()} * amplitude;
  return (sum >> 2) + (product >> (15 + kAmplitudeFractionBits - 16));
}

}  // namespace

std::vector<int> roughen_tile(const Roughening& roughening) {
  Tile tile;
  SeededRandom random(roughening.seeds);
  auto amplitude = roughening.amplitudes.begin();
  for (int h = kTileSide / 2; h > 0; h /= 2) {
    for (int y = h; y < kTileSide; y += 2 * h)
      for (int x = h; x < kTileSide; x += 2 * h)
        tile.at(x, y) = displaced(
            tile.at(x - h, y - h) + tile.at(x + h, y - h) + tile.at(x - h, y + h) + tile.at(x + h, y + h),
            *amplitude, random);
    ++amplitude;
    for (int y = 0; y < kTileSide; y += h)
      for (int x = y / h % 2 == 0 ? h : 0; x < kTileSide; x += 2 * h)
        tile.at(x, y) =
            displaced(tile.at(x, y - h) + tile.at(x, y + h) + tile.at(x - h, y) + tile.at(x + h, y),
                      *amplitude, random);
    ++amplitude;
  }
  std::vector<int> depths;
  for (const std::int64_t value : tile.values()) depths.push_back(static_cast<int>(value >> 16));
  return depths;
}

void roughen_model(const Roughening& roughening, int width, std::vector<std::uint32_t>& pixels) {
  const std::vector<int> tile = roughen_tile(roughening);
  const Box& box = roughening.box;
  for (int y = box.y0; y <= box.y1; ++y)
    for (int x = box.x0; x <= box.x1; ++x) {
      std::uint32_t& word = pixels[static_cast<std::size_t>(y) * width + x];
      const auto front = static_cast<int>(word & kHullField);
      const auto back = static_cast<int>(word >> kHullBackLow & kHullField);
      if (front >= back || back >= roughening.maxdepth) continue;
      const int moved = std::max(1, front + tile[(y % kTileSide) * kTileSide + x % kTileSide]);
      word &= ~kHullBoth;
      if (moved < back)
        word |= static_cast<std::uint32_t>(moved) | static_cast<std::uint32_t>(back) << kHullBackLow;
    }
}

}  // namespace dendro::half_space
