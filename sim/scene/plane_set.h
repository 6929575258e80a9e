#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sim/scene/scene.h"

namespace dendro::scene {

/// The points p with normal·p <= offset; the normal is a unit vector that points out.
struct HalfSpace {
  glm::dvec3 normal{};
  double offset = 0;
};

/// Half-spaces whose intersection is wanted.
using PlaneSet = std::vector<HalfSpace>;

/// The largest ball inside all half-spaces; radius <= 0 means that they have no common interior.
struct Ball {
  glm::dvec3 centre{};
  double radius = 0;
};

/// True when the intersection is bounded (or empty): the normals positively span space.
bool is_bounded(const PlaneSet& planes);

/// The Chebyshev ball of a bounded set (linear programme, simplex on its dual).
Ball chebyshev_ball(const PlaneSet& planes);

/// Corners of the intersection (Qhull on the dual points around the Chebyshev centre). The set must be
/// bounded; no value when it has no interior.
std::optional<std::vector<glm::dvec3>> intersection_vertices(const PlaneSet& planes);

/// The facets of the points' convex hull, merged down to `count` planes; 0 keeps all facets. While there are
/// too many, the two neighbouring planes are replaced by one whose replacement adds the least volume between
/// hull and planes: the new plane touches the hull in the direction of the area-weighted mean of the facets
/// it stands for. So the result always contains the hull; ties go to the lowest facet numbers. Replacements
/// that would make the set unbounded are passed over. Throws std::invalid_argument, with the reason, when the
/// points span no volume, there are fewer facets than `count`, or no further replacement leaves the set
/// bounded.
PlaneSet hull_planes(const std::vector<glm::dvec3>& points, std::size_t count);

/// The planes that touch the points in the given directions (any length but zero).
PlaneSet support_planes(const std::vector<glm::dvec3>& points, const std::vector<glm::dvec3>& directions);

/// `count` unit directions spread evenly over the sphere: the Fibonacci lattice, y up.
std::vector<glm::dvec3> sphere_directions(std::size_t count);

/// The faces of a built-in solid of circumradius 1 around the origin; the coordinate axes are two-fold axes
/// of the icosahedron and dodecahedron. `name` must be one of solid_names().
PlaneSet solid_planes(const std::string& name);

}  // namespace dendro::scene
