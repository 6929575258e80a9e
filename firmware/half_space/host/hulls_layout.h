#pragma once

#include <cstdint>

// Pixel and parameters of the program for several hulls [FG86 2.2]; positions are ours.  ASSUMED DEV-046

namespace dendro::half_space {

constexpr int kHullBits = 8;     ///< of each register: front in bits 0-7,
constexpr int kHullBackLow = 8;  ///< back in bits 8-15,
constexpr int kNearestLow = 16;  ///< nearest in bits 16-23
constexpr std::uint32_t kHullField = 0xFF;
constexpr std::uint32_t kHullBoth = 0xFFFF;  ///< front and back

/// Words of the scratch area `params` of hulls.gia. With `kHullClear` not 0 the box's nearest is cleared, and
/// nothing else is done.
enum HullParams : unsigned {
  kHullMaxDepth,
  kHullBoxing,
  kHullBackCount,
  kHullEdgeOnCount,
  kHullFrontCount,
  kHullClear,
  kHullParamsWords
};

}  // namespace dendro::half_space
