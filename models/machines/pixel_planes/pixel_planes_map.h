#pragma once

#include <cstdint>

/// Addresses of the machine as its host writes them; the function code of an access is ignored.  ASSUMED DEV-071
namespace dendro::pixel_planes {

constexpr std::uint32_t kControlStore = 0x0000;  ///< 1,024 words, low half at 2k, high half at 2k + 1
constexpr std::uint32_t kControlStoreEnd = 0x0800;
constexpr std::uint32_t kFifo = 0x1000;       ///< write only: commands
constexpr std::uint32_t kStatus = 0x1001;     ///< read: 1 while the machine is not idle
constexpr std::uint32_t kVideoBase = 0x1002;  ///< first of the 24 colour bits
constexpr std::uint32_t kVideoSize = 0x1003;  ///< width in bits 0-15, height in bits 16-31
constexpr std::uint32_t kSelect = 0x1004;     ///< the renderer whose control store and FIFO are written, or kAllRenderers

constexpr std::uint32_t kAllRenderers = 0xFFFF;

/// For measuring: pixel y * frame width + x of the frame store, as it was copied. Pixels of renderer r begin at r times an array's.
constexpr std::uint32_t kFramePixels = 1u << 31;

}  // namespace dendro::pixel_planes
