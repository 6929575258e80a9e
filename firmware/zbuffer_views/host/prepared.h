#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "firmware/zbuffer_views/host/tree_model.h"

namespace dendro::zbuffer_views {

using Rgb = std::array<std::uint8_t, 3>;

/// An entry of the colour table; `below` is the index of the colour on a leaf's other side, else its own.
struct Colour {
  Part part = Part::kTrunk;
  Rgb rgb{};
  int below = 0;
};

/// Rows of an orthonormal matrix.
struct Axes {
  glm::dvec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};

  /// Coordinates of p along the axes.
  glm::dvec3 operator()(const glm::dvec3& p) const;
  /// The vector that has these coordinates.
  glm::dvec3 inverse(const glm::dvec3& q) const;
};

/// A tree as views of it are made: triangle i has colours[colour_of[i]].
struct Tree {
  TreeModel model;
  std::vector<Colour> colours;
  std::vector<std::uint8_t> colour_of;
  glm::dvec3 centre{};     ///< on the trunk's axis, in the middle of the height
  double radius = 0;       ///< largest distance from that axis
  double half_height = 0;  ///< largest vertical distance from the centre
};

/// How a tree's views are stored: n bands of latitude, samples of `pitch` metres.
struct ViewSettings {
  int bands = 4, layers = 2, width = 300, height = 600;
  double pitch = 0, threshold = 0;  ///< metres
  bool peel = false;                ///< instead of inserting in the order of the triangles
  bool early = false;               ///< a leaf's side is chosen in the view, not per picture
};

struct Placement {
  glm::dvec3 at{};  ///< where the tree's centre goes
  int turn = 0;     ///< 1/256 turns about the vertical, from z towards x
};

/// One picture of a sequence.
struct Frame {
  glm::dvec3 eye{};
  Axes axes;
  glm::dvec3 to_light{0, 1, 0};
};

/// Everything of a scene that the programs and the reference are told. All numbers are of single precision.
struct Prepared {
  Tree tree;
  ViewSettings views;
  std::vector<Placement> placements;
  std::vector<Frame> frames;

  int width = 0, height = 0;
  bool perspective = false;
  double scale = 0;  ///< pixels per metre; perspective: per metre at a distance of one metre
  double centre_x = 0, centre_y = 0, near = 0;  ///< centre_y is counted from the lowest row
  double ambient = 0.3, diffuse = 0.7;
  Rgb background{};
  bool shadows = false;
  int light_width = 0, light_height = 0;
  double light_scale = 0;  ///< light pixels per metre
  double epsilon = 0;      ///< light pixels
  bool skip_empty = false, full_product = false, reuse_light = false;
};

/// The view frame V2 of the direction to the viewer: polar angle from the trunk and longitude from z, radians.
Axes view_axes(double theta, double phi);

}  // namespace dendro::zbuffer_views
