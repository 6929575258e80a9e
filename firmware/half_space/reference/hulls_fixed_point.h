#pragma once

#include <functional>

#include "firmware/half_space/host/prepare_hulls.h"
#include "firmware/half_space/reference/fixed_point.h"

namespace dendro::half_space {

/// The actions of hulls.gia on integers, plane by plane over the whole first box: what it must leave in the
/// image memory, bit for bit, whether it boxes or not.
class HullsModel {
 public:
  /// `before`: the memory at the start.
  HullsModel(int width, int height, int maxdepth, std::uint32_t before = 0);

  void clear();
  void passes(const PlaneProgram& program);
  void merge(const Box& box);
  void merge_trunk(const Box& box);
  void paint(const Trapezium& trapezium);

  FixedPointPicture& picture() { return picture_; }

 private:
  template <typename F>
  void each_pixel(const Box& box, F&& change);
  template <typename F>
  void each_covered(const Box& box, F&& change);

  FixedPointPicture picture_;
  std::uint32_t maxdepth_;
};

/// Called after the passes of a hull, before its merge, with the box of its program.
using BetweenPassesAndMerge = std::function<void(const Hull& hull, FixedPointPicture& picture)>;

/// Clear, then passes 0 to 2 and the merge of every visible hull, then the trunks.
FixedPointPicture run_hulls_fixed_point(const PreparedHulls& prepared, std::uint32_t before = 0,
                                        const BetweenPassesAndMerge& between = {});

}  // namespace dendro::half_space
