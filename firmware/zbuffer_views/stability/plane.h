#pragma once

#include <gmpxx.h>

#include <optional>

#include "firmware/zbuffer_views/stability/support.h"

namespace dendro::zbuffer_views {

/// The part of the plane normal · p = distance in a box around the tree's centre: `half` to every side, `half_up` up and down.
struct Plane {
  std::array<double, 3> normal;
  double distance = 0, half = 0.7, half_up = half;

  /// The depth at which the line of sight through (x, y) of a frame meets the plane, exact but for the last rounding.
  double depth(const float* frame, double x, double y) const;
  /// Whether that point lies in the box, `margin` inside.
  bool contains(const float* frame, double x, double y, double margin) const;
  /// |dz/dx| + |dz/dy| along the frame's axes: twice what half a pixel both ways changes the depth.
  double steepness(const float* frame) const;
};

/// Puts the plane into one stored view, every sample at its own exact place rounded to single precision.
void store_plane(ViewsFile& views, std::size_t view, const Plane& plane, std::uint8_t colour);

}  // namespace dendro::zbuffer_views
