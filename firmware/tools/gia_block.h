#pragma once

#include <cstdint>
#include <vector>

#include "firmware/tools/gia_program.h"

namespace dendro::tools {

/// One part of a source word that can move by itself: the ALU with its D source and Y destination, a bus
/// operation, a multiplier start, or the sequencer. Parts that see each other's old state stay one operation.
struct Operation {
  std::uint64_t bits = 0;  ///< values of its fields
  std::uint64_t mask = 0;  ///< its fields
  Fixup imm;
  int line = 0;
  int order = 0;  ///< index of its source word in the block

  std::uint64_t reads = 0;  ///< state that it reads as it is before the word
  std::uint64_t late_reads =
      0;  ///< state that it reads as the word leaves it (bus registers, multiplier operands)
  std::uint64_t writes = 0;
  bool product = false;  ///< reads the product
  bool starts = false;   ///< starts a multiplication
  bool data = false;     ///< reads the read data register
  bool bus_read = false, bus_write = false;
  bool last = false;      ///< ends the block: stays in its last word
  int scratch_read = -1;  ///< address, kAnyScratch, or -1: none
  int scratch_write = -1;
  int passes = -1;          ///< a plain move of this state (register or kStateQ) to a Y destination
  std::uint64_t shown = 0;  ///< state that takes Y: a move of it can join this word
};

constexpr int kAnyScratch = 1 << 20;
constexpr int kStateQ = 16;

/// Fields of the ALU part.
std::uint64_t alu_mask();

/// Appends the parts of a micro in an order that says the same when done one after the other. `word` has its
/// imm resolved.
void split(const Micro& micro, std::uint64_t word, int order, std::vector<Operation>& operations);

/// Words that must lie between the places of `before` and `after`, which comes later in the program; -1:
/// independent.
int distance(const Operation& before, const Operation& after, int multiply_ticks);

/// True when `move` can take the Y bus of the word of `source` instead of a word of its own.
bool can_join(const Operation& source, const Operation& move, int multiply_ticks);

}  // namespace dendro::tools
