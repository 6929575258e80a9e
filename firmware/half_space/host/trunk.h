#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "firmware/half_space/host/object_planes.h"
#include "firmware/half_space/host/plane_program.h"
#include "sim/scene/scene.h"
#include "sim/scene/view.h"

// S11: the trunk under a crown. Its place and size come from the crown's.  ASSUMED DEV-056

namespace dendro::half_space {

enum class TrunkKind {
  kNone,
  kCylinder,  ///< hexagonal: 6 + 2 planes
  kCone,      ///< hexagonal, pointed at the crown's centre: 6 + 1 planes
  kPainter,   ///< a trapezium on the screen, under everything that was drawn before
};

/// The keys `trunk`, `trunk_width` and `trunk_height` of an object.
struct TrunkSettings {
  TrunkKind kind = TrunkKind::kNone;
  double width = 0.1;   ///< share of the crown's width
  double height = 0.6;  ///< share of the crown's height that the trunk reaches below the crown's centre
};

/// Throws UserError for wrong keys, sizes without a trunk, and sizes beside a mesh's own trunk.
TrunkSettings read_trunk(const scene::Object& object);

/// Where a crown stands and how large it is, metres: height along the world's y, width the mean of the
/// others.
struct CrownSize {
  glm::dvec3 centre{};
  double width = 0, height = 0;
};

/// From the corners of the crown; of a tree that is open, of the planes that bound it, else from the reach of
/// its start normals. No value for other planes that are unbounded.
std::optional<CrownSize> crown_size(const ObjectPlanes& crown);

/// An upright axis from the crown's centre down, and the distance of the hexagon's corners from it.
struct TrunkShape {
  glm::dvec3 top{}, bottom{};
  double radius = 0;
};

/// `scale`: of the whole trunk, 1 for a parallel view.
TrunkShape trunk_shape(const TrunkSettings& settings, const CrownSize& crown, double scale);

/// The trunk that a mesh has of its own, from the lowest of its points to the crown's centre: the axis joins
/// the middles of the lowest and of the highest tenth of them, the radius is their mean distance from it.
/// Throws UserError when the points do not reach below the crown's centre.
TrunkShape fit_trunk(const std::vector<glm::dvec3>& points, const CrownSize& crown,
                     const scene::Object& object);

/// kCylinder or kCone.
scene::PlaneSet trunk_planes(TrunkKind kind, const TrunkShape& shape);

/// The pixels of the lines box.y0..box.y1 whose centres lie between two lines; x in pixels on line box.y0,
/// and what it grows by from line to line. `box` clips.
struct Trapezium {
  Box box;
  double left = 0, right = 0, left_step = 0, right_step = 0;

  /// The four numbers in 16.16, as the scratch area `records` takes them.
  std::vector<std::uint32_t> words() const;
};

/// A painter's trunk on the screen, as wide as the hexagon's corners are apart at both ends; no value when
/// nothing of it is in the picture or it is seen from its end.
std::optional<Trapezium> trapezium_of(const TrunkShape& shape, const scene::Affine& view,
                                      double pixels_per_metre, int width, int height);

}  // namespace dendro::half_space
