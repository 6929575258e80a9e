#pragma once

#include <cstdint>

/// Command register bits of the interface [NYU-H].
namespace dendro::ik11b {

constexpr std::uint32_t kRun = 01000;
constexpr std::uint32_t kReset = 02000;

/// Largest single DMA transfer, bytes: a 16-bit count of 16-bit words [NYU-C].
constexpr std::int64_t kMaxTransferBytes = 128 * 1024;

/// Interface register accesses of one programmed word: address low and high, command, GO, two data halves [DER from NYU-C].
constexpr int kRegistersPerWord = 6;

}  // namespace dendro::ik11b
