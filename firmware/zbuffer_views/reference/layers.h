#pragma once

#include <cstdint>
#include <vector>

#include "firmware/zbuffer_views/host/prepared.h"
#include "firmware/zbuffer_views/reference/directions.h"

namespace dendro::zbuffer_views {

constexpr std::uint8_t kNoColour = 255;

/// The two bytes of a normal (MO95-K6), and the unit vector that they stand for.
struct NormalBytes {
  std::uint8_t latitude = 0, longitude = 0;

  static NormalBytes of(const glm::dvec3& unit);
  glm::dvec3 decoded() const;
};

struct Sample {
  double z = 0;
  NormalBytes normal;
  std::uint8_t colour = kNoColour;  ///< kNoColour: empty
};

/// One stored view: sample (i, j) of layer k is layers[k][j · width + i], the lowest row first; it stands for x0 + i · pitch,
/// y0 + j · pitch along the view's axes, from the tree's centre.
struct StoredView {
  Direction direction;
  Axes axes;
  double x0 = 0, y0 = 0;
  std::vector<std::vector<Sample>> layers;
};

struct Fragment {
  std::uint32_t pixel = 0, triangle = 0;
  double z = 0;
};

/// Which fragments of one pixel are stored, nearest first. `fragments` are in the order of their triangles.
std::vector<Fragment> insert_layers(const std::vector<Fragment>& fragments, int layers, double threshold);
/// The canonical choice, which does not depend on the order (MO95-K3): greedy from the front.
std::vector<Fragment> peel_layers(std::vector<Fragment> fragments, int layers, double threshold);

/// V3: metres from sample to sample so that every view of the tree fits with a margin of 2 % (ASSUMED DEV-163), unless the
/// settings give the pitch.
double window_pitch(const Tree& tree, const ViewSettings& settings);

/// V2 to V4 of one direction; the settings' pitch must not be 0.
StoredView make_view(const Tree& tree, const ViewSettings& settings, const Direction& direction);

/// All views of V1, in their order, V3's pitch where the settings have none.
std::vector<StoredView> make_views(const Tree& tree, const ViewSettings& settings);

}  // namespace dendro::zbuffer_views
