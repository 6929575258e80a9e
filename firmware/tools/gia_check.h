#pragma once

#include <cstdint>
#include <vector>

#include "firmware/tools/gia_program.h"

namespace dendro::tools {

/// Where a word can go next, as far as the word alone tells.
struct Successors {
  int target = -1;       ///< branch target, -1: none or not known
  bool falls = false;    ///< to the next word without having called anything
  bool calls = false;    ///< the target is a subroutine that comes back to the next word
  bool unknown = false;  ///< also to a place that only the run knows (stack top, counter, Y)
};

/// `word` has its imm resolved.
Successors successors(std::uint64_t word);

/// For each word, how many words a multiplication that is under way there still takes at most (0: none is).
/// With `through_returns` a return counts as going to every place that a call comes back to; else it goes
/// nowhere.
std::vector<int> products_under_way(const std::vector<std::uint64_t>& words, int multiply_ticks,
                                    bool through_returns);

/// The static checks of a source, on its words as written (`words` are resolved, one per micro): products
/// taken too early, multiplications started too early, flags tested before any latch, stack depth, running
/// off the end. Throws SourceError.
void check_program(const Program& program, const std::vector<std::uint64_t>& words, std::uint32_t entry,
                   int multiply_ticks);

}  // namespace dendro::tools
