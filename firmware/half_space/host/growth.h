#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "sim/scene/plane_set.h"

namespace dendro::half_space {

/// The parameters of normal splitting [FG86 2.1; S1]. Angles in radians, lengths in the tree's own unit.
struct GrowthParameters {
  std::vector<glm::dvec3>
      start;                  ///< direction and length of the start normals; the origin is the tree's centre
  int generations = 1;        ///< every normal is split once in each
  std::optional<int> splits;  ///< at most so many splits, in order of generation and index
  double mean_b = 0.8, sigma_b = 0.05;     ///< |BC| as a share of the normal's length
  double mean_angle = 0, sigma_angle = 0;  ///< of the first generation
  double sigma_length = 0.05;              ///< noise of the children's lengths, share of the parent's
  double ratio = 0.7;                      ///< by which angle and its noise shrink a generation
  double angle_limit = 0,
         length_limit = 4;  ///< draws beyond are repeated; the length as a multiple of the parent's
  bool prune = true;        ///< keep only normals whose origin lies in their own octant
  bool keep_parent = true;  ///< a normal that loses both children stays; else it goes
  std::uint64_t seed = 1;
};

/// What the splitting of normals computed, redraws included.
struct GrowthCount {
  std::uint64_t flops = 0;     ///< additions, subtractions, multiplications, divisions
  std::uint64_t look_ups = 0;  ///< gauss, sine, cosine, square root: tables in FG86 5
  std::uint64_t comparisons = 0;

  GrowthCount& operator+=(const GrowthCount& other);
};

struct Grown {
  scene::PlaneSet planes;  ///< of the normals that were never split, in order
  /// The start planes, moved out so that no child bulges through them (S4, FG86-K19). A plane that its
  /// children do not bound is left out: the set may be unbounded, but always contains the intersection of
  /// `planes`.
  scene::PlaneSet relaxed;
  scene::PlaneSet original;  ///< the start planes as they were
  int splits = 0;
  int pruned = 0;       ///< children that were dropped
  GrowthCount printed;  ///< steps 1 to 4 as FG86 prints them: distance, angles, lengths, ratio
  GrowthCount vectors;  ///< the children's origins and directions in space
  GrowthCount pruning;
};

/// Thrown when a thousand draws in a row lie beyond a limit; what() names it.
class GrowthError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Splits the start normals. Every split has a random stream of its own, chosen by seed, generation and the
/// normal's index in the unpruned tree, so a draw more or a child less changes no other branch. Throws
/// GrowthError.
Grown grow(const GrowthParameters& parameters);

}  // namespace dendro::half_space
