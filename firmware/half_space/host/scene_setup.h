#pragma once

#include <string>
#include <vector>

#include "firmware/half_space/host/screen_setup.h"

// What pictures of one hull and of several read from a scene alike.

namespace dendro::half_space {

/// How planes are scanned: the same for every hull of a picture.
struct ScanSettings {
  int maxdepth = 255;
  bool boxing = true, full_box = false;
  SteepPolicy steep = SteepPolicy::kWide;
};

/// Reads `depth_bits` (6..most_bits, of which the most are the default), `boxing`, `steep` and
/// `starting_box`.
ScanSettings read_scan_settings(scene::Options& options, int most_bits);

/// Blames the object's mesh, solid, planes or tree.
[[noreturn]] void blame(const scene::Object& object, const std::string& message);

/// Refuses an empty set of planes, and an unbounded one unless `unbounded` takes that for background, which
/// is a tree's default.
void check_extent(const scene::Object& object, const ObjectPlanes& planes, const Extent& extent,
                  scene::Options& options);

/// The map of `depth_range`, else of nearest..farthest with `depth_margin`, of at least `least_margin`.
DepthMap read_depth_map(scene::Options& options, double nearest, double farthest, int maxdepth,
                        double least_margin = 0);

/// The records of a hull's planes for the first box that its extent allows; no value when that lies outside
/// the picture. Front records carry their face number only if `faces`. `flops` grows by the work on the
/// planes.
std::optional<PlaneProgram> make_program(const scene::Image& image, const ScanSettings& settings,
                                         const std::vector<ScreenPlane>& screen, const Extent& extent,
                                         bool faces, std::uint64_t& flops);

}  // namespace dendro::half_space
