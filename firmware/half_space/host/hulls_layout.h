#pragma once

#include <cstdint>

// Pixel and parameters of the program for several hulls [FG86 2.2]; positions are ours.  ASSUMED DEV-046

namespace dendro::half_space {

constexpr int kHullBits = 8;     ///< of each register: front in bits 0-7,
constexpr int kHullBackLow = 8;  ///< back in bits 8-15,
constexpr int kNearestLow = 16;  ///< nearest in bits 16-23
constexpr std::uint32_t kHullField = 0xFF;
constexpr std::uint32_t kHullBoth = 0xFFFF;  ///< front and back

/// What a trunk leaves in the nearest register: a mark, for no crown of a complete tree comes so near.
constexpr std::uint32_t kTrunkMark = 0;

/// What hulls.gia does with the box, by the word `kHullAction`.
enum class HullAction : std::uint32_t {
  kPassesAndMerge,  ///< passes 0 to 2 of the records' hull, then its merge into nearest
  kClear,           ///< nearest := largest depth
  kPasses,          ///< passes 0 to 2: front and back hold the hull
  kMerge,           ///< the merge of what front and back hold
  kTrunk,           ///< the passes, then kTrunkMark into nearest where the hull would be merged
  kPainter,         ///< kTrunkMark where nearest is the largest depth, between the edges in `records`
};

/// Words of the scratch area `params` of hulls.gia.
enum HullParams : unsigned {
  kHullMaxDepth,
  kHullBoxing,
  kHullBackCount,
  kHullEdgeOnCount,
  kHullFrontCount,
  kHullAction,
  kHullParamsWords
};

}  // namespace dendro::half_space
