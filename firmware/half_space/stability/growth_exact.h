#pragma once

#include <vector>

#include "firmware/half_space/host/growth.h"

namespace dendro::half_space {

/// A plane that splitting gives, and how far doubles may be from it.
struct ExactGrownPlane {
  double normal[3] = {};  ///< of the 128-bit one
  double offset = 0;
  double normal_bound = 0, offset_bound = 0;
};

struct ExactGrown {
  std::vector<ExactGrownPlane> planes;  ///< in the order of Grown::planes
  std::uint64_t redraws = 0;            ///< draws beyond a limit
  bool refused = false;                 ///< a thousand in a row
};

/// S1 from its description, in 128 bits: the same streams of uniform numbers, nothing else in common with
/// grow(). The bounds follow the roundings of double arithmetic through every split.
ExactGrown grow_exactly(const GrowthParameters& parameters);

}  // namespace dendro::half_space
