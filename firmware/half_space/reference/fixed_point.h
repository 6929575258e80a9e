#pragma once

#include <cstdint>
#include <vector>

#include "firmware/half_space/host/plane_program.h"

namespace dendro::half_space {

/// Passes 0 to 4 on integers, plane by plane over the whole first box: what the microcode must leave in the
/// image memory, bit for bit, whether it boxes or not. Pixels outside the first box keep `before`.
struct FixedPointPicture {
  int width = 0, height = 0;
  std::vector<std::uint32_t> pixels;  ///< width * height words, rows top down
};

FixedPointPicture run_fixed_point(const PlaneProgram& program, std::uint32_t before = 0);

}  // namespace dendro::half_space
