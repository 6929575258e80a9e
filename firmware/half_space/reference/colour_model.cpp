#include "firmware/half_space/reference/colour_model.h"

#include "firmware/half_space/host/hulls_layout.h"
#include "firmware/half_space/host/layout.h"
#include "firmware/half_space/reference/seeded_random.h"
#include "sim/base/check.h"

namespace dendro::half_space {
namespace {

constexpr int kFrameSide = kLargestSide;

std::uint32_t from_cube(const Colouring& colouring, const std::vector<std::uint32_t>& frame, int x, int y,
                        int z) {
  const CubeLevel& level = colouring.level;
  const std::uint32_t side = 1u << level.bits;
  std::uint32_t texel = 0, stride = 1;
  for (unsigned axis = 0; axis < 3; ++axis, stride *= side)
    texel += (texel_coordinate(colouring, axis, x, y, z) / 65536) % side * stride;
  std::uint32_t colour = 0;
  for (std::uint32_t channel = 0; channel < 3; ++channel) {
    const std::uint32_t word = frame.at(level.base + 4 * texel + channel);
    colour += (word >> 8 * level.byte) % 256 << 8 * channel;
  }
  return colour;
}

std::uint32_t bark(const Colouring& colouring, SeededRandom& random) {
  std::uint32_t colour = 0;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const std::uint32_t added = random.next() * (colouring.bark_range[channel] + 1u) / 65536;
    colour += (colouring.bark_base[channel] + added) << 8 * channel;
  }
  return colour;
}

}  // namespace

std::uint32_t texel_coordinate(const Colouring& colouring, unsigned axis, int x, int y, int z) {
  return colouring.start[axis] + static_cast<std::uint32_t>(x) * colouring.step_x[axis] +
         static_cast<std::uint32_t>(y) * colouring.step_y[axis] +
         static_cast<std::uint32_t>(z) * colouring.step_z[axis];
}

void colour_model(const Colouring& colouring, std::vector<std::uint32_t>& frame) {
  DENDRO_CHECK(frame.size() == kFrameSide * kFrameSide, "{}", frame.size());
  SeededRandom random(colouring.seeds);
  const Rgb& behind = colouring.background;
  for (int y = 0; y < colouring.height; ++y)
    for (int x = 0; x < colouring.width; ++x) {
      std::uint32_t& word = frame[static_cast<std::size_t>(y) * kFrameSide + x];
      const auto nearest = static_cast<int>(word >> kNearestLow & kHullField);
      const std::uint32_t colour = nearest == kFarthest ? behind[0] + behind[1] * 256u + behind[2] * 65536u
                                   : nearest == 0       ? bark(colouring, random)
                                                        : from_cube(colouring, frame, x, y, nearest);
      word = (word & 0xFF000000) | colour;
    }
}

}  // namespace dendro::half_space
