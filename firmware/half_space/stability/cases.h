#pragma once

#include <vector>

#include "firmware/lib/stability.h"

namespace dendro::half_space {

/// The hard numerical cases [algorithms.md 1.8] and metamorphic tests [5] of the half-space firmware.
std::vector<stability::Case> stability_cases();

/// The same firmware's cases on a bit-serial pixel array.
std::vector<stability::Case> planes_stability_cases();

// One case each; what it measures stands beside its table in the file of its name.
stability::Result steep_planes(const stability::Rig& rig, std::uint64_t seed);     // N-A1
stability::Result depth_drift(const stability::Rig& rig, std::uint64_t seed);      // N-A2
stability::Result edge_on_planes(const stability::Rig& rig, std::uint64_t seed);   // N-A3
stability::Result register_width(const stability::Rig& rig, std::uint64_t seed);   // N-A4
stability::Result ties(const stability::Rig& rig, std::uint64_t seed);             // N-A5
stability::Result third_register(const stability::Rig& rig, std::uint64_t seed);   // N-A6
stability::Result texture_index(const stability::Rig& rig, std::uint64_t seed);    // N-A7
stability::Result texture_drift(const stability::Rig& rig, std::uint64_t seed);    // N-A8
stability::Result splitting(const stability::Rig& rig, std::uint64_t seed);        // N-A9
stability::Result multiplier(const stability::Rig& rig, std::uint64_t seed);       // N-A10
stability::Result permuted_planes(const stability::Rig& rig, std::uint64_t seed);  // X1
stability::Result quarter_turn(const stability::Rig& rig, std::uint64_t seed);     // X2
stability::Result scaled_by_two(const stability::Rig& rig, std::uint64_t seed);    // X3
stability::Result mirrored(const stability::Rig& rig, std::uint64_t seed);         // X4
stability::Result tiled(const stability::Rig& rig, std::uint64_t seed);            // X6
stability::Result planes_guard(const stability::Rig& rig, std::uint64_t seed);     // N-P1
stability::Result planes_fraction(const stability::Rig& rig, std::uint64_t seed);  // N-P2
stability::Result planes_tree(const stability::Rig& rig, std::uint64_t seed);      // N-P3
stability::Result planes_width(const stability::Rig& rig, std::uint64_t seed);     // N-P4

}  // namespace dendro::half_space
