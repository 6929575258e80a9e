#pragma once

#include <cstdint>
#include <vector>

#include "firmware/tools/gia_block.h"

namespace dendro::tools {

/// A straight-line stretch to pack.
struct Block {
  std::vector<Operation> operations;  ///< in program order
  int words = 0;                      ///< words of the source
  int product_wait = 0;               ///< words before which no product may be read or multiplication started
};

/// One packed word.
struct PackedWord {
  std::uint64_t bits = bps32::nop();
  std::uint64_t mask = 0;
  Fixup imm;
  std::vector<int> operations;
};

/// Packs the block into as few ticks as it finds, stalls of bus accesses included in the guess.
/// Deterministic.
std::vector<PackedWord> schedule(const Block& block, int multiply_ticks);

}  // namespace dendro::tools
