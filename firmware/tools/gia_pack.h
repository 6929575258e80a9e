#pragma once

#include <cstdint>
#include <vector>

#include "firmware/tools/gia_program.h"

namespace dendro::tools {

/// A packed program: micros in their new order, the labels moved along, the source lines of every word.
struct Packed {
  Program program;
  std::vector<std::vector<int>> lines;
};

/// Compacts the straight-line stretches of a program that has passed check_program(). Registers, flags,
/// scratchpad and the order of bus accesses stay as they were at every branch and label. `words` are the
/// program's resolved words. Throws SourceError for a branch to a number, which packing would break.
Packed pack_program(const Program& program, const std::vector<std::uint64_t>& words, int multiply_ticks);

}  // namespace dendro::tools
