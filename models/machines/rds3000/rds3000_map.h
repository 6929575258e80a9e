#pragma once

#include <cstdint>

/// Word addresses of the RDS-3000 bus [BRL-H, NYU-H].
namespace dendro::rds3000 {

constexpr std::uint32_t kAddressMask = 0xFFFFFF;
constexpr std::uint32_t kImageEnd = 0x800000;        ///< image memory lies below
constexpr std::uint32_t kControlStore = 0x800000;    ///< two words per microword; up to 0x80FFFF
constexpr std::uint32_t kControlStoreEnd = 0x810000;
constexpr std::uint32_t kScratchpad = 0x820000;      ///< 8K words
constexpr std::uint32_t kScratchpadEnd = 0x822000;
constexpr std::uint32_t kLookUpTable = 0x830000;     ///< 1024 words
constexpr std::uint32_t kLuvoCrossbar = 0x830400;
constexpr std::uint32_t kProcessor = 0x850000;       ///< read program counter, write status
constexpr std::uint32_t kFbc = 0xC00000;             ///< 8 registers, write only
constexpr std::uint32_t kCrossbar = 0xC20000;        ///< 34 registers

enum class Device { Image, ControlStore, Scratchpad, LookUpTable, LuvoCrossbar, Processor, Fbc, Crossbar, None };

/// Who answers an address. 24-bit addresses; higher bits are ignored.
constexpr Device device_at(std::uint32_t address) {
  const std::uint32_t a = address & kAddressMask;
  if (a < kImageEnd) return Device::Image;
  if (a < kControlStoreEnd) return Device::ControlStore;
  if (a >= kScratchpad && a < kScratchpadEnd) return Device::Scratchpad;
  if (a >= kLookUpTable && a < kLookUpTable + 1024) return Device::LookUpTable;
  if (a == kLuvoCrossbar) return Device::LuvoCrossbar;
  if (a == kProcessor) return Device::Processor;
  if (a >= kFbc && a < kFbc + 8) return Device::Fbc;
  if (a >= kCrossbar && a < kCrossbar + 34) return Device::Crossbar;
  return Device::None;
}

}  // namespace dendro::rds3000
