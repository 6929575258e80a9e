#pragma once

#include <random>
#include <string>
#include <vector>

#include "firmware/half_space/stability/cases.h"
#include "firmware/half_space/stability/exact.h"

namespace dendro::half_space {

struct PreparedHulls;

/// Words of the image memory, width * height, rows top down.
using Words = std::vector<std::uint32_t>;

/// The picture that the microcode leaves on a machine.
Words draw(const stability::Rig& rig, const Prepared& prepared);

/// Several programs one after the other on one machine; the picture is that of the whole frame.
Words draw_all(const stability::Rig& rig, const std::vector<Prepared>& parts);

/// The picture that the program for several hulls leaves, registers and all.
Words draw_hulls(const stability::Rig& rig, const PreparedHulls& prepared);

/// Planes that are on the screen already, scanned over the whole picture in their order.
Prepared from_screen(std::vector<ScreenPlane> planes, int width, int height,
                     SteepPolicy steep = SteepPolicy::kWide, int maxdepth = 4095);

/// A parallel view along -z on a square picture; `height` metres are shown.
scene::Scene looking_at(scene::Object object, int side, double height);

/// A built-in solid turned by a rotation drawn from `random`.
scene::Object random_solid(std::mt19937_64& random, const std::string& name);

/// A closed hull around the origin: the six sides of a box, four of them edge-on, cut by `cuts` random planes
/// of which every third is nearly edge-on.
scene::Object random_hull(std::mt19937_64& random, int cuts);

scene::Scene with(scene::Scene scene, const std::string& key, const scene::OptionValue& value);

/// Counts faults and keeps the first one's description.
struct Tally {
  std::int64_t count = 0;
  std::int64_t pixels = 0;  ///< looked at
  std::string first;

  void fault(const std::string& where) {
    if (count++ == 0) first = where;
  }
  double per_million() const {
    return pixels > 0 ? 1e6 * static_cast<double>(count) / static_cast<double>(pixels) : 0;
  }
};

/// Pixels whose words differ.
void compare_words(const Words& got, const Words& wanted, int width, const std::string& scene, Tally& tally);

/// Pixels whose word is not possible.
void compare_enclosed(const Words& got, Enclosure& enclosure, int width, const std::string& scene,
                      Tally& tally);

}  // namespace dendro::half_space
