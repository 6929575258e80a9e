#pragma once

#include <cstdint>
#include <vector>

#include "firmware/half_space/host/hulls_layout.h"

namespace dendro::half_space {

/// The nearest register of every pixel, rows top down; `peek` takes a bus address and a function code.
template <typename Peek>
std::vector<std::uint8_t> nearest_register(int width, int height, Peek&& peek) {
  constexpr unsigned kLoresPixel = 2;  // bus function code
  std::vector<std::uint8_t> nearest;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto at = static_cast<std::uint32_t>(x) << 1 | static_cast<std::uint32_t>(y) << 11;
      nearest.push_back(static_cast<std::uint8_t>(peek(at, kLoresPixel) >> kNearestLow & kHullField));
    }
  return nearest;
}

}  // namespace dendro::half_space
