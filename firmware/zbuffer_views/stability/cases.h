#pragma once

#include <vector>

#include "firmware/lib/stability.h"

namespace dendro::zbuffer_views {

/// The hard numerical cases [algorithms.md 2.7] of the programs for precomputed views.
std::vector<stability::Case> stability_cases();

// One case each; what it measures stands beside its table in the file of its name.
stability::Result view_counts(const stability::Rig& rig, std::uint64_t seed);   // N-B1
stability::Result view_borders(const stability::Rig& rig, std::uint64_t seed);  // N-B2
stability::Result layer_threshold(const stability::Rig& rig, std::uint64_t seed);  // N-B3
stability::Result view_ties(const stability::Rig& rig, std::uint64_t seed);     // N-B4
stability::Result normal_bytes(const stability::Rig& rig, std::uint64_t seed);  // N-B5
stability::Result half_pixels(const stability::Rig& rig, std::uint64_t seed);   // N-B6
stability::Result near_eye(const stability::Rig& rig, std::uint64_t seed);      // N-B7
stability::Result shadow_threshold(const stability::Rig& rig, std::uint64_t seed);  // N-B8

}  // namespace dendro::zbuffer_views
