#pragma once

#include "firmware/half_space/host/prepare_hulls.h"
#include "firmware/half_space/reference/fixed_point.h"

namespace dendro::half_space {

/// Clear, then passes 0 to 2 and the merge of every visible hull on integers, plane by plane over the whole
/// first box: what hulls.gia must leave in the image memory, bit for bit, whether it boxes or not. `before`:
/// the memory at the start.
FixedPointPicture run_hulls_fixed_point(const PreparedHulls& prepared, std::uint32_t before = 0);

}  // namespace dendro::half_space
