#pragma once

#include <cstdint>

#include "firmware/zbuffer_views/host/tree_model.h"

namespace dendro::zbuffer_views {

/// A young Magnolia obovata: few thick shoots that end in false whorls of large leaves, white below. Lengths in
/// metres, angles in degrees. ASSUMED DEV-161
struct MagnoliaParameters {
  int age = 14;               ///< years, 1..25
  double increment = 0.62;    ///< yearly growth of the leader that it tends to
  double establishment = 30;  ///< the leader of year i grows by increment·i²/(i² + establishment)
  int whorl = 3;              ///< branches a year at the leader's end, one more or less
  double whorl_share = 0.75;  ///< a branch's first shoot, share of the leader's of that year
  double insertion = 58;      ///< angle between a shoot and its side shoots
  double rise = 0.12;         ///< by which a branch turns up a year, share of its direction
  double fork_chance = 0.45;  ///< that a shoot of a branch gets a side shoot
  double fork_share = 0.72;
  double vigour = 0.86;
  double shortest_shoot = 0.03;
  double leaves = 8;  ///< a false whorl
  double leaf_length = 0.32;
  double leaf_width = 0.15;
  int leaf_rows = 12;     ///< strips from foot to tip of a leaf, 2 or more; its blade has 4·leaf_rows - 4 triangles
  double triangles = 0;   ///< above 0: leaf_rows is chosen so that the tree has about so many
  std::uint64_t seed = 1;
};

/// Grows the tree. The same parameters give the same tree.
TreeModel grow_magnolia(const MagnoliaParameters& parameters);

}  // namespace dendro::zbuffer_views
