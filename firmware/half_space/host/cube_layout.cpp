#include "firmware/half_space/host/cube_layout.h"

#include "sim/base/check.h"

namespace dendro::half_space {

CubeLayout cube_layout(unsigned bits, bool wide) {
  DENDRO_CHECK(bits >= 1 && bits <= 5, "{}", bits);
  constexpr std::uint32_t kLowerHalf = 512 * kHalfPictureLines;
  CubeLayout layout;
  layout.wide = wide;
  std::uint32_t next = wide ? 0 : kLowerHalf;
  for (unsigned level = 0; level <= bits; ++level) {
    CubeLevel l;
    l.bits = bits - level;
    l.byte = wide ? 3 : level == 0 ? 0 : 1;
    if (!wide && level == 1) next = kLowerHalf;
    l.base = next;
    next += l.pixels();
    DENDRO_CHECK(next <= 512 * 512, "{} {}", bits, level);
    layout.levels.push_back(l);
  }
  return layout;
}

}  // namespace dendro::half_space
