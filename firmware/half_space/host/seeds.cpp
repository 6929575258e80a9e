#include "firmware/half_space/host/seeds.h"

#include <random>

namespace dendro::half_space {

std::vector<std::uint32_t> seed_table(std::uint64_t seed, std::uint64_t stream, std::size_t count) {
  std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                         static_cast<std::uint32_t>(stream), static_cast<std::uint32_t>(stream >> 32)};
  std::mt19937 random(sequence);
  std::vector<std::uint32_t> table(count);
  for (std::uint32_t& word : table) word = (random() & 0xFFFF) | 1;
  return table;
}

}  // namespace dendro::half_space
