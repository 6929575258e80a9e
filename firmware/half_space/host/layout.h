#pragma once

#include <cstdint>

// What host program, microcode, model and comparison agree on. Pixel and record layouts are those of FG86 as
// far as it gives them [FG86 2.2, 6.1]; bit positions are ours.

namespace dendro::half_space {

constexpr int kFrontBits = 12;  ///< pixel bits 0-11: front
constexpr int kBackLow = 12;    ///< pixel bits 12-23: back, during passes 0 to 2
constexpr int kFaceLow = 12;    ///< pixel bits 12-19: face number, after pass 4
constexpr std::uint32_t kFieldMask = 0xFFF;
constexpr std::uint32_t kFaceMask = 0xFF;

/// The word that pass 3 gives a background pixel: face number 0, and different from every depth, so that pass
/// 4 need only compare the whole word with a plane's depth.
constexpr std::uint32_t kBackgroundWord = 0x100000;

constexpr int kLargestFaces = 255;  ///< front faces that a face number can tell apart
constexpr int kLargestSide = 512;   ///< pixels of a lores frame
constexpr int kFractionBits = 16;
constexpr int kPlainRecordWords = 4;
constexpr int kWideRecordWords = 8;

/// Words of the scratch area `box`: x0, y0, x1, y1, inclusive.
constexpr int kBoxWords = 4;

/// Words of the scratch area `params`. `kSaturate` is there only in firmware that has a saturating adder.
enum Params : unsigned { kMaxDepth, kBoxing, kBackCount, kEdgeOnCount, kFrontCount, kSaturate, kParamsWords };

}  // namespace dendro::half_space
