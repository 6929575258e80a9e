#pragma once

#include <cstdint>
#include <vector>

namespace dendro::trace {

/// FNV-1a over words: tells memories apart that differ in any word.
template <class Word>
std::uint64_t digest(const std::vector<Word>& words) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const Word word : words)
    for (unsigned byte = 0; byte < sizeof(Word); ++byte)
      hash = (hash ^ (static_cast<std::uint64_t>(word) >> (8 * byte) & 0xFF)) * 0x100000001b3;
  return hash;
}

}  // namespace dendro::trace
