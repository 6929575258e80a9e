#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace dendro::scene {

/// One facet of a convex hull; coplanar triangles are one facet.
struct HullFacet {
  glm::dvec3 normal{};                    ///< unit, outward
  double offset = 0;                      ///< normal·p = offset on the facet
  std::vector<std::uint32_t> corners;     ///< indices of the given points, counter-clockwise from outside
  std::vector<std::uint32_t> neighbours;  ///< indices of the facets that share an edge with it
  double area = 0;
  glm::dvec3 centroid{};
};

struct Hull {
  std::vector<HullFacet> facets;
  std::vector<std::uint32_t> vertices;  ///< indices of the given points, ascending
};

/// The convex hull (Qhull, reentrant); none when the points span no volume.
std::optional<Hull> convex_hull(const std::vector<glm::dvec3>& points);

}  // namespace dendro::scene
