#pragma once

#include <random>

namespace dendro::base {

/// A number of [low, high), the same on every host (std::uniform_real_distribution is not).
inline double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}

}  // namespace dendro::base
