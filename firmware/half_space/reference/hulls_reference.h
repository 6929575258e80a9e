#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "firmware/half_space/host/prepare_hulls.h"
#include "firmware/job.h"

namespace dendro::half_space {

/// The picture in double precision, straight from the planes: per pixel the least front depth of all hulls
/// that cover it. Knows nothing of records, boxes or fixed point.
struct HullsReference {
  int width = 0, height = 0;
  std::vector<double> depth;  ///< per pixel: in register units; maxdepth where no hull is
  std::vector<int> hull;      ///< per pixel: index of the hull seen, -1: background, kTrunkHull: a trunk
  std::vector<std::uint8_t> unbounded;  ///< per pixel: 1 where a hull has no back plane and no hull is seen
  std::vector<std::uint8_t> rgb;        ///< through the shades

  static constexpr int kTrunkHull = -2;  ///< its depth is the mark that trunks leave, 0

  /// What the integers may make of it: the third register lies in lower..upper. They differ where a hull is
  /// thinner than one unit of depth, or its edge nearer than the drift of the steps.
  std::vector<int> lower, upper;
  std::vector<std::uint8_t>
      certain;  ///< per pixel: 1 where that is the depth of the hull seen and nothing else
};

/// By how many depths roughening moves the front of a hull, by its index, at pixel x, y.
using FrontMove = std::function<int(std::size_t hull, int x, int y)>;

/// With `move`, fronts are moved before they are compared, to no less than 1; where one reaches its back the
/// hull has a hole.
HullsReference render_hulls_reference(const PreparedHulls& prepared, const FrontMove& move = {});

/// Share of the pixels with a hull where that is unbounded: one hull alone, seen through a register of
/// `maxdepth`. 0 without any such pixel.
struct UnboundedPixels {
  std::int64_t unbounded = 0, covered = 0;

  double share() const {
    return unbounded == 0 ? 0.0 : static_cast<double>(unbounded) / static_cast<double>(unbounded + covered);
  }
};

UnboundedPixels count_unbounded(const std::vector<ScreenPlane>& planes, int width, int height, int maxdepth);

/// `nearest`: the third register of every pixel. Figures: psnr over the shown RGB; wrong_pixels = covered in
/// one but not in the other, or a trunk in one only; max_depth_error = largest |nearest + 1/2 - z| where one
/// hull and nothing else can be seen (trunks have no depth); extra: outside_enclosure = pixels whose register
/// is not in lower..upper (none, if the merge is right), unbounded_pixels, unbounded_share.
ErrorReport compare(const HullsReference& reference, const std::vector<std::uint8_t>& nearest, int maxdepth,
                    const std::uint8_t* rgb);

}  // namespace dendro::half_space
