#include "firmware/half_space/stability/cases.h"

namespace dendro::half_space {

std::vector<stability::Case> stability_cases() {
  return {
      {"N-A1", "planes nearly edge-on: only the wide record is right", steep_planes},
      {"N-A2", "drift of incremental depth against exact rationals", depth_drift},
      {"N-A3", "planes exactly edge-on are exact half-plane tests", edge_on_planes},
      {"N-A4", "depth registers of 6 to 24 bits: pixels lost at the silhouette", register_width},
      {"N-A5", "front = back, coincident duplicates, permuted planes", ties},
      {"N-A6", "third register: depths beyond 8 bits, hulls that touch exactly", third_register},
      {"N-A7", "texture index of negative coordinates, modulo the cube's side", texture_index},
      {"N-A8", "incremental texture coordinates of a roughened surface against exact ones", texture_drift},
      {"N-A9", "splitting: right angles, tails of gauss(), normals without length", splitting},
      {"N-A10", "corner cases of the 16x16 multiplier", multiplier},
      {"X1", "permute the planes inside a pass", permuted_planes},
      {"X2", "rotate by 90 degrees about the view axis", quarter_turn},
      {"X3", "scale the scene by two", scaled_by_two},
      {"X4", "mirror in x", mirrored},
      {"X6", "split the frame into tiles", tiled},
  };
}

std::vector<stability::Case> planes_stability_cases() {
  return {
      {"N-P1", "planes nearly edge-on: guard bits of a stream, and one fewer", planes_guard},
      {"N-P2", "fraction bits of a stream against the error of depth", planes_fraction},
      {"N-P3", "skews and dead clocks of the tree, and one clock fewer", planes_tree},
      {"N-P4", "depth fields of 12 to 24 bits: pixels lost at the silhouette", planes_width},
  };
}

}  // namespace dendro::half_space
