#pragma once

#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "firmware/half_space/host/object_planes.h"
#include "firmware/half_space/host/plane_program.h"
#include "models/parts/host/host_port.h"
#include "sim/scene/scene.h"
#include "sim/scene/view.h"

// S2 and S4: what pictures of one hull and of several need of the host.

namespace dendro::half_space {

// Floating-point operations, counted from the formulas of S2 and S4.
constexpr std::uint64_t kFlopsTransformPlane =
    15 + 3 + 6 + 1;                                    // 3x3 product, its scaling, n'·t, the sum with e
constexpr std::uint64_t kFlopsSlopes = 1 + 2 + 4 + 1;  // reciprocal, two steps, a·x0 + b·y0 + d, product
constexpr std::uint64_t kFlopsRound = 3;               // scaling of three values to 2^-16
constexpr std::uint64_t kFlopsSteepTest = 4 * 4;       // depth at four corners
constexpr std::uint64_t kFlopsShade = 3 + 2 + 2;       // n·L, ambient + diffuse·, and to 8 bits
constexpr std::uint64_t kFlopsProjectVertex = 18;      // 3x3 product and shift
constexpr std::uint64_t kFlopsSideOfPlane = 6;
constexpr std::uint64_t kFlopsCutEdge = 10;
constexpr std::uint64_t kFlopsTrunkSize = 2 + 2 + 1;  // f / (f + z), width and height by it, half the width

/// register = scale · metres along the view + shift
struct DepthMap {
  double scale = 1, shift = 0;
};

/// Throws UserError for a picture larger than the frame no object, or more than one light.
void check_picture(const scene::Scene& scene);

/// Throws UserError for no object, or more than one light.
void check_objects(const scene::Scene& scene);

/// Flops of finding the corners of N planes by cutting the polyhedron with one plane after another: every
/// plane is compared with the at most 2k - 4 corners so far and makes at most k new ones.
std::uint64_t corner_flops(std::size_t planes);

/// Screen planes from world planes; front planes are numbered 1, 2, ...
std::vector<ScreenPlane> to_screen(const scene::PlaneSet& world, const scene::Affine& view,
                                   double pixels_per_metre, const DepthMap& depth);

/// Maps nearest..farthest, and `margin` of that before and behind, to 0..maxdepth.
DepthMap map_depth(double nearest, double farthest, double margin, int maxdepth);

/// The pixels of the picture that a polyhedron with these corners can cover; none when it is outside.
std::optional<Box> box_around(const std::vector<glm::dvec3>& corners, int width, int height);

Rgb to_rgb(const std::vector<double>& colour, double shade);

/// Corners, on the screen, of something that contains the object; x, y in pixels, z in metres along the view.
struct Extent {
  std::vector<glm::dvec3> corners;  ///< none: unbounded
  std::uint64_t flops = 0;
  bool bounded = false;  ///< the object itself
  bool empty = false;    ///< no point lies inside all its planes
  /// Depth to be mapped: of the corners; of an unbounded tree twice the reach of its start normals; else
  /// none.
  double nearest = INFINITY, farthest = -INFINITY;

  bool has_depth() const { return nearest <= farthest; }
};

/// A tree's corners are those of its relaxed start planes; when these do not bound it, its own.
Extent extent_of(const ObjectPlanes& object, const scene::Affine& view);

/// The policy's name in `steep`.
SteepPolicy read_steep(scene::Options& options);

/// The host's work on the planes of a tree; a look-up books the instructions that scale, index and load.
Work growth_work(const Grown& growth);

}  // namespace dendro::half_space
