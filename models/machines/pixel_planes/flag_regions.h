#pragma once

#include <cstdint>
#include <vector>

#include "models/machines/pixel_planes/macro.h"
#include "models/machines/pixel_planes/pixel_planes_spec.h"
#include "models/machines/pixel_planes/pixel_planes_state.h"

namespace dendro::pixel_planes {

/// One-bit flags that say on which side of expressions a pixel lies, kept as those expressions until something of them is read,
/// and where they are surely 0: a program that only works where such a flag is set need not look at other pixels. A word is one
/// of 64 pixels of ArrayState.
class FlagRegions {
 public:
  explicit FlagRegions(const Spec& spec);

  /// Bit `bit` of every pixel := T >= 0, of kSignFirst, or itself and that, of kSign; false, and nothing done, when it is not
  /// known where the bit is 0, or T does not fit its stream somewhere.
  bool apply(const Macro& sign);

  /// Words outside which the bit is 0, in order; null: not known. The bit is up to date afterwards.
  const std::vector<std::uint32_t>* live(unsigned bit, ArrayState& memory);

  /// All flags are up to date afterwards.
  void settle(ArrayState& memory);

  /// Something else than a program that works inside live(bit) writes the bit.
  void forget(unsigned bit);
  void forget_all(ArrayState& memory);

 private:
  struct Edge {
    std::int64_t a, b, c;  ///< T's sign is that of a·x + b·y + c
  };
  struct Region {
    unsigned bit = 0;
    std::vector<std::uint32_t> words;  ///< `edges` aside
    bool known = false;                ///< all others are 0 in memory
    bool fresh = false;                ///< `edges` begin anew: what memory holds does not count
    std::vector<Edge> edges;           ///< not yet in memory
  };

  Region& region(unsigned bit);
  void settle(Region& region, Plane& plane);
  void fill(const std::vector<Edge>& edges, int y0, int y1, Region& region, Plane& plane) const;
  std::uint64_t inside(const std::vector<Edge>& edges, std::uint32_t word) const;
  bool fits(const Macro& sign) const;

  int width_, height_;
  std::vector<Region> regions_;
  int pending_ = 0;  ///< regions with edges
};

}  // namespace dendro::pixel_planes
