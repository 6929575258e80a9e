#pragma once

#include <glm/vec3.hpp>
#include <vector>

namespace dendro::zbuffer_views {

/// A preset direction to the viewer (V1).
struct Direction {
  int circle = 0;        ///< k: 0 the north pole, n the south pole
  int number = 0;        ///< j on its circle
  int circle_views = 1;  ///< m_k
  double theta = 0, phi = 0;
};

/// The number of views on circle k of n bands: the smallest m with m > 2n·sin(k·pi/n), exact at ties (MO95-K1).
int views_on_circle(int bands, int circle);

/// All directions for n >= 2 bands, numbered from the north pole down, then by j.
std::vector<Direction> view_directions(int bands);

/// V5: the numbers of the views around a direction (any length but zero), ascending: one on a pole, three in the
/// polar caps, four elsewhere. Two that coincide are one.
std::vector<int> choose_views(int bands, const glm::dvec3& to_viewer);

}  // namespace dendro::zbuffer_views
