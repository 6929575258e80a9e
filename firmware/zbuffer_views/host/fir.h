#pragma once

#include <cstdint>

#include "firmware/zbuffer_views/host/tree_model.h"

namespace dendro::zbuffer_views {

/// A young Abies sachalinensis in the open. Lengths in metres, angles in degrees. ASSUMED DEV-160
struct FirParameters {
  int age = 15;                   ///< years, 1..25
  double increment = 0.55;        ///< yearly growth of the leader that it tends to
  double establishment = 60;      ///< the leader of year i grows by increment·i²/(i² + establishment)
  int whorl = 5;                  ///< branches a year at the leader's end, one more or less
  double whorl_share = 0.52;      ///< a branch's first shoot, share of the leader's of that year
  double insertion = 52;          ///< angle between leader and a new branch
  double sag = 40;                ///< by which an old branch has come down
  double fork = 48;               ///< angle between a shoot and its side shoots
  double fork_share = 0.58;       ///< a side shoot's length, share of the shoot that goes on
  double vigour = 0.94;           ///< a branch's shoot, share of the one that goes before, after the leader's pace
  double shortest_shoot = 0.035;  ///< shorter buds do not open
  int needle_years = 6;           ///< needles stay on shoots so old
  double needle_length = 0.028;
  double needle_width = 0.004; ///< of the triangle that stands for a pair of needles
  double needles_per_metre = 290;  ///< of shoot
  double triangles = 0;            ///< above 0: needles_per_metre is chosen so that the tree has about so many
  std::uint64_t seed = 1;
};

/// Grows the tree. The same parameters give the same tree.
TreeModel grow_fir(const FirParameters& parameters);

}  // namespace dendro::zbuffer_views
