#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/half_space/host/tree_object.h"
#include "firmware/half_space/stability/growth_exact.h"
#include "firmware/half_space/stability/support.h"
#include "sim/base/error.h"

// N-A9, by the host's own splitting of normals, and by the microcode on the crowns it gives. Near a right
// angle the length |BC| / cos(alpha) blows up; gauss() has tails; a start normal may have no length.

namespace dendro::half_space {
namespace {

using stability::Bound;
using Array = scene::OptionValue::Array;

/// Keys of a tree at the ends of their ranges.
struct Extreme {
  const char* name;
  double mu_b, sigma_b, mu_alpha, sigma_alpha, alpha_max, sigma_l, length_limit, ratio;
  std::int64_t generations;
  bool prune;
};

constexpr Extreme kExtremes[] = {
    {"usual", 0.8, 0.05, 30, 5, 80, 0.05, 4, 0.7, 3, true},
    {"angles at 89 degrees", 0.8, 0, 89, 0, 89.9, 0, 100, 1, 2, false},
    {"angles up to 89.9 degrees", 0.8, 0.05, 89, 90, 89.9, 0.05, 100, 1, 3, true},
    {"wide gauss tails", 0.3, 1, 0, 90, 89.9, 1, 100, 1, 3, true},
    {"wide gauss tails, all planes kept", 0.3, 1, 0, 90, 89.9, 1, 100, 1, 4, false},
    {"short lengths only", 0.01, 1, 50, 15, 85, 1, 0.2, 0.4, 3, true},
    {"no room for any length", 2, 0, 89, 0, 89.9, 0, 0.1, 1, 1, true},
    {"B beyond the centre", 2, 0.2, 15, 15, 60, 0.2, 4, 0.7, 3, false},
};
constexpr int kTrees = 12;  ///< seeds of each
constexpr int kDrawn = 3;   ///< of these on the machine
constexpr int kSide = 128;

scene::Object tree_of(const Extreme& e, std::uint64_t seed) {
  scene::Object object;
  object.tree = "round";
  object.source_where = {"stability", 0};
  const auto set = [&](const char* key, auto value) {
    object.tree_parameters[key] = {value, {"stability", 0}};
  };
  set("mu_b", e.mu_b), set("sigma_b", e.sigma_b);
  set("mu_alpha", e.mu_alpha), set("sigma_alpha", e.sigma_alpha), set("alpha_max", e.alpha_max);
  set("sigma_l", e.sigma_l), set("length_limit", e.length_limit), set("ratio", e.ratio);
  set("generations", e.generations), set("prune", e.prune);
  set("seed", static_cast<std::int64_t>(seed));
  return object;
}

struct Totals {
  Tally strange;  ///< numbers that are no numbers
  Tally planes;   ///< planes in one and not in the other
  std::int64_t compared = 0, refused = 0;
  std::uint64_t redraws = 0;
  double normal = 0, normal_bound = 0, offset = 0, offset_bound = 0, share = 0;
  std::string worst;
};

void compare_plane(const scene::HalfSpace& plane, const ExactGrownPlane& exact, const std::string& where,
                   Totals& totals) {
  const double numbers[] = {plane.normal.x, plane.normal.y, plane.normal.z, plane.offset};
  for (const double number : numbers)
    if (!std::isfinite(number)) totals.strange.fault(where);
  double normal = 0;
  for (int i = 0; i < 3; ++i) normal = std::max(normal, std::abs(numbers[i] - exact.normal[i]));
  const double offset = std::abs(plane.offset - exact.offset);
  const double share = std::max(normal / exact.normal_bound, offset / exact.offset_bound);
  ++totals.compared;
  totals.normal = std::max(totals.normal, normal), totals.offset = std::max(totals.offset, offset);
  totals.normal_bound = std::max(totals.normal_bound, exact.normal_bound);
  totals.offset_bound = std::max(totals.offset_bound, exact.offset_bound);
  if (share <= totals.share) return;
  totals.share = share;
  totals.worst = fmt::format("{}: offset {:.17g}, exactly {:.17g}", where, plane.offset, exact.offset);
}

void compare_tree(const Extreme& e, std::uint64_t seed, Totals& totals) {
  const std::string name = fmt::format("{}, seed {}", e.name, seed);
  const GrowthParameters parameters = trees_of(tree_of(e, seed), seed).front().growth;
  const ExactGrown exact = grow_exactly(parameters);
  totals.redraws += exact.redraws;
  scene::PlaneSet planes;
  bool refused = false;
  try {
    planes = grow(parameters).planes;
  } catch (const GrowthError&) {
    refused = true;
  }
  totals.refused += refused;
  if (refused != exact.refused || planes.size() != exact.planes.size()) {
    totals.planes.fault(fmt::format("{}: {} planes instead of {}", name, planes.size(), exact.planes.size()));
    return;
  }
  for (std::size_t i = 0; i < planes.size(); ++i)
    compare_plane(planes[i], exact.planes[i], fmt::format("{}: plane {}", name, i + 1), totals);
}

scene::Scene extreme_scene(const Extreme& e, std::uint64_t seed) {
  scene::Object object = tree_of(e, seed);
  object.rotate = {20, 30.0 * static_cast<double>(seed), 0};
  scene::Scene scene = with(looking_at(std::move(object), kSide, 3), "unbounded",
                            {std::string("background"), {"stability", 0}});
  return with(std::move(scene), "depth_range", {Array{{4.0, {}}, {6.0, {}}}, {"stability", 0}});
}

/// Crowns of such planes on the machine, each pixel against their exact rationals.
void draw_trees(const stability::Rig& rig, const Extreme& e, std::uint64_t seed, Tally& tally,
                std::int64_t& covered) {
  Prepared prepared;
  try {
    prepared = prepare(extreme_scene(e, seed));
  } catch (const UserError&) {
    return;  // no plane, or nothing inside them
  }
  Enclosure enclosure(prepared);
  const Words words = draw(rig, prepared);
  covered += std::count_if(words.begin(), words.end(), [](std::uint32_t word) { return face_of(word) != 0; });
  compare_enclosed(words, enclosure, kSide, fmt::format("{}, seed {}", e.name, seed), tally);
}

/// Start normals and plane normals that have no direction: not one may be taken.
std::int64_t accepted_zeros() {
  const double lengths[] = {0.0, -0.0, 1e-320, 1e-200, 1e300};
  std::int64_t accepted = 0;
  for (const double length : lengths) {
    scene::Object object;
    object.tree = "round";
    const Array vector = {{length, {}}, {0.0, {}}, {0.0, {}}};
    object.tree_parameters["start"] = {Array{{vector, {}}}, {"stability", 0}};
    try {
      grow(trees_of(object, 1).front().growth);
      ++accepted;
    } catch (const UserError&) {
    }
  }
  return accepted;
}

}  // namespace

stability::Result splitting(const stability::Rig& rig, std::uint64_t seed) {
  Totals totals;
  Tally drawn;
  std::int64_t covered = 0;
  for (const Extreme& e : kExtremes)
    for (int i = 0; i < kTrees; ++i) {
      const std::uint64_t tree = 1000 * seed + static_cast<std::uint64_t>(i);
      compare_tree(e, tree, totals);
      if (i < kDrawn) draw_trees(rig, e, tree, drawn, covered);
    }
  const auto row = [](const std::string& what, double measured, double bound, const char* unit,
                      const char* reference, Bound kind, const std::string& where) {
    return stability::Row{"N-A9", what, measured, bound, unit, reference, kind, where};
  };
  const double compared = static_cast<double>(totals.compared);
  return {
      {row(fmt::format("NaN or infinity in {:.0f} planes of {} trees at the ends of all ranges", compared,
                       kTrees * std::size(kExtremes)),
           static_cast<double>(totals.strange.count), 0, "numbers", "ieee", Bound::kAtMost,
           totals.strange.first),
       row("trees with another number of planes, or refused in one and not in the other",
           static_cast<double>(totals.planes.count), 0, "trees", "mpfr", Bound::kAtMost, totals.planes.first),
       row("largest error of a normal", totals.normal, totals.normal_bound, "", "mpfr", Bound::kAtMost, ""),
       row("largest error of an offset", totals.offset, totals.offset_bound, "radii", "mpfr", Bound::kAtMost,
           ""),
       row("largest share of a plane's own bound", totals.share, 1, "", "mpfr", Bound::kAtMost, totals.worst),
       row("draws beyond a limit, which had to be repeated", static_cast<double>(totals.redraws), 0, "draws",
           "mpfr", Bound::kMoreThan, ""),
       row("trees that no draw could give, each an error of the user", static_cast<double>(totals.refused), 0,
           "trees", "mpfr", Bound::kMoreThan, ""),
       row("start normals without a length or a direction that were taken",
           static_cast<double>(accepted_zeros()), 0, "normals", "ieee", Bound::kAtMost, ""),
       row("such crowns on the machine: pixels outside the bound of N-A2", static_cast<double>(drawn.count),
           0, "pixels", "gmp", Bound::kAtMost, drawn.first),
       row(fmt::format("covered pixels of the {} that were looked at", drawn.pixels),
           static_cast<double>(covered), 0, "pixels", "gmp", Bound::kMoreThan, "")},
      {}};
}

}  // namespace dendro::half_space
