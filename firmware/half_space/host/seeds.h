#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace dendro::half_space {

constexpr std::size_t kDrawsPerSeed = 512;  ///< [FG86 6.1]

/// Seeds that random numbers take on a bit-slice processor, for `draws` of them.
constexpr std::size_t seeds_for(std::size_t draws) { return (draws + kDrawsPerSeed - 1) / kDrawsPerSeed; }

/// `count` odd 16-bit numbers for firmware/lib/rds3000/random.gia, one a word. Another table for every `seed`
/// and `stream`.
std::vector<std::uint32_t> seed_table(std::uint64_t seed, std::uint64_t stream, std::size_t count);

}  // namespace dendro::half_space
