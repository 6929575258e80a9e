#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "firmware/half_space/host/growth.h"
#include "firmware/half_space/host/prepare.h"
#include "firmware/half_space/host/tree_object.h"
#include "firmware/half_space/reference/hulls_reference.h"
#include "sim/base/check.h"
#include "sim/study/table_fg86.h"

namespace dendro::study {
namespace {

using half_space::Grown;
using half_space::GrowthCount;
using half_space::GrowthParameters;

constexpr int kTrees = 40;
constexpr int kManyTrees = 400;
constexpr int kSide = 64;  ///< of the pictures in which shares are counted, pixels
constexpr double kDegree = 3.14159265358979323846 / 180;

/// A round tree's parameters as they are when a scene says nothing. DEV-045
GrowthParameters usual(std::uint64_t seed) {
  scene::Object object;
  object.tree = "round";
  return half_space::trees_of(object, seed).front().growth;
}

scene::Scene tree_scene(int start_normals, double angle, int generations, std::int64_t seed) {
  scene::Scene scene;
  scene.name = "FG86-A12";
  scene.image.width = scene.image.height = kSide;
  scene.camera.height = 5;
  scene.camera.position = {1.5, 1.2, 5};
  scene.options = scene::Options("half_space");
  scene::Object tree;
  tree.tree = "round";
  tree.rotate = {37.0 * static_cast<double>(seed), 137.5 * static_cast<double>(seed),
                 0};  // another view of each
  const auto set = [&](const char* key, auto value) { tree.tree_parameters[key] = {value, {}}; };
  set("start_normals", std::int64_t{start_normals});
  set("generations", std::int64_t{generations});
  set("mu_alpha", angle);
  set("seed", seed);
  scene.objects = {tree};
  return scene;
}

/// Of the pixels that see the crown, the percentage where nothing bounds it behind; over many trees.
double open_percentage(int start_normals, double angle, int generations) {
  half_space::UnboundedPixels sum;
  for (int seed = 1; seed <= kTrees; ++seed) {
    const half_space::Prepared tree =
        half_space::prepare(tree_scene(start_normals, angle, generations, seed));
    const auto count = half_space::count_unbounded(tree.screen, kSide, kSide, tree.program.maxdepth);
    sum.unbounded += count.unbounded, sum.covered += count.covered;
  }
  return 100 * sum.share();
}

constexpr int kFewestStarts = 3, kMostStarts = 8;

void fill_starts(const TableContext&, std::vector<TableRow>& rows) {
  for (int normals = kFewestStarts; normals <= kMostStarts; ++normals) {
    TableRow& row = rows[static_cast<std::size_t>(normals - kFewestStarts)];
    const double share = open_percentage(normals, 30, 1);
    const double narrow = open_percentage(normals, 15, 1), wide = open_percentage(normals, 50, 1);
    set_range(row, share, std::min({share, narrow, wide}), std::max({share, narrow, wide}));
    row.assumptions = {"DEV-045"};
    row.note = fmt::format(
        "{} trees split once by 30 degrees, interval from 15 to 50; unsplit {:.3g} %, split twice {:.3g} %",
        kTrees, open_percentage(normals, 30, 0), open_percentage(normals, 30, 2));
  }
}

std::vector<TableRow> start_claims() {
  std::vector<TableRow> rows;
  for (int normals = kFewestStarts; normals <= kMostStarts; ++normals)
    rows.push_back(claim(
        fmt::format("FG86-A12{}", static_cast<char>('a' + normals - kFewestStarts)),
        fmt::format("unbounded pixels of crowns from {} start normals", normals), "%", std::nullopt,
        "\"three to six give the best results\": share of the pixels with a crown, in a picture five radii "
        "high, where no plane bounds it behind"));
  return rows;
}

Grown grown(int generations, int starts, std::uint64_t seed, bool prune) {
  GrowthParameters p = usual(seed);
  p.start = half_space::start_normals("round", starts, 1.0);
  p.generations = generations;
  p.prune = prune;
  return half_space::grow(p);
}

void fill_generations(const TableContext&, std::vector<TableRow>& rows) {
  constexpr int kGenerations = 3, kStarts = 6;
  const auto planes = [](int n, int starts, std::uint64_t seed, bool prune) {
    return static_cast<double>(grown(n, starts, seed, prune).planes.size());
  };
  double exact = 0, all = 0;
  for (int n = 0; n <= 5; ++n)
    for (int starts = 3; starts <= 8; ++starts, ++all)
      exact += planes(n, starts, 1, false) == std::ldexp(starts, n);
  set_single(rows[0], planes(kGenerations, kStarts, 1, false));
  rows[0].note =
      fmt::format("without pruning 2^n N in {:g} of {:g} trees with n = 0 to 5 and N = 3 to 8", exact, all);
  double sum = 0, least = INFINITY, most = 0;
  for (std::uint64_t seed = 1; seed <= kTrees; ++seed) {
    const double count = planes(kGenerations, kStarts, seed, true);
    sum += count, least = std::min(least, count), most = std::max(most, count);
  }
  set_range(rows[1], sum / kTrees, least, most);
  rows[1].assumptions = {"DEV-045"};
  rows[1].note = fmt::format(
      "mean of {} trees; with pruning 2^n N is an upper bound: no tree has more than {:g}", kTrees, most);
}

/// The sixth split and all before it.
Grown split_six_times(std::uint64_t seed) {
  GrowthParameters p = usual(seed);
  p.splits = 6;
  return half_space::grow(p);
}

void fill_operations(const TableContext&, std::vector<TableRow>& rows) {
  GrowthCount printed, everything;
  double splits = 0;
  for (std::uint64_t seed = 1; seed <= kTrees; ++seed) {
    const Grown tree = split_six_times(seed);
    printed += tree.printed;
    for (const auto* part : {&tree.printed, &tree.vectors, &tree.pruning}) everything += *part;
    splits += tree.splits;
  }
  const double flops = static_cast<double>(printed.flops) / splits;
  const double steps = static_cast<double>(printed.flops + printed.look_ups) / splits;
  set_range(rows[0], flops, flops, steps);
  rows[0].note =
      fmt::format("{:.1f} operations and {:.1f} look-ups (gauss, cosine) a split, mean of {:g} splits", flops,
                  steps - flops, splits);
  set_range(rows[1], static_cast<double>(everything.flops) / splits,
            static_cast<double>(everything.flops) / splits,
            static_cast<double>(everything.flops + everything.look_ups + everything.comparisons) / splits);
  rows[1].note =
      "high: look-ups and comparisons counted, too; \"less than 20\" holds only for the printed steps, which "
      "leave "
      "out the children's origin and directions in space and the pruning";
  constexpr double kSplitsPerSecond = 200.0 * 6 * 60;
  set_range(rows[2], flops * kSplitsPerSecond / 1e6, flops * kSplitsPerSecond / 1e6,
            steps * kSplitsPerSecond / 1e6);
  rows[2].note =
      fmt::format("200 trees of 6 splits at 60 frames a second, {:.0f} to {:.0f} operations a split (A18a)",
                  flops, steps);
}

void fill_level_of_detail(const TableContext&, std::vector<TableRow>& rows) {
  GrowthParameters p = usual(1);
  int splits = 0;
  const auto planes = [&] {
    p.splits = splits;
    return half_space::grow(p).planes.size();
  };
  while (planes() < 12) {
    ++splits;
    DENDRO_CHECK(splits <= 100, "splits add no planes");
  }
  set_single(rows[0], splits);
  int pruned = 0;
  for (std::uint64_t seed = 1; seed <= kTrees; ++seed) pruned += split_six_times(seed).pruned;
  rows[0].note =
      fmt::format("every split adds one plane; pruning took {} planes of {} such trees", pruned, kTrees);
}

/// Trees that a plane cuts so that their centre is outside.
int without_centre(bool prune) {
  int count = 0;
  for (std::uint64_t seed = 1; seed <= kManyTrees; ++seed) {
    GrowthParameters p = usual(seed);
    p.generations = 3;
    p.mean_b = 0.3, p.ratio = 1;  // ASSUMED DEV-060
    p.mean_angle = 50 * kDegree, p.sigma_angle = 15 * kDegree;
    p.prune = prune;
    const Grown tree = half_space::grow(p);
    count += std::any_of(tree.planes.begin(), tree.planes.end(), [](const auto& h) { return h.offset <= 0; });
  }
  return count;
}

void fill_centres(const TableContext&, std::vector<TableRow>& rows) {
  set_single(rows[0], without_centre(true));
  rows[0].assumptions = {"DEV-045", "DEV-060"};
  rows[0].note = fmt::format(
      "{} trees of three generations split by 50 +- 15 degrees near their tips (mu_B 0.3, ratio 1); without "
      "pruning {} "
      "have their centre outside",
      kManyTrees, without_centre(false));
}

/// Distance of the children's tips from their parent's plane after one split; share of the parent's length.
double tip_distance(std::uint64_t seed, double noise) {
  GrowthParameters p = usual(seed);
  p.start = {{0.3, 1.1, -0.4}};
  p.generations = 1;
  p.sigma_b = 0;
  p.sigma_length = noise;
  p.prune = false;
  const double length = glm::length(p.start[0]);
  const glm::dvec3 u = p.start[0] / length, b = u * (length * (1 - p.mean_b));
  double most = 0;
  for (const scene::HalfSpace& child : half_space::grow(p).planes) {
    const glm::dvec3 tip = b + child.normal * (child.offset - glm::dot(child.normal, b));
    most = std::max(most, std::abs(glm::dot(u, tip) / length - 1));
  }
  return most;
}

void fill_tips(const TableContext&, std::vector<TableRow>& rows) {
  double still = 0, noisy = 0;
  for (std::uint64_t seed = 1; seed <= kManyTrees; ++seed) {
    still = std::max(still, tip_distance(seed, 0));
    noisy += tip_distance(seed, usual(1).sigma_length) / kManyTrees;
  }
  set_range(rows[0], still, 0, still);
  rows[0].note = fmt::format(
      "largest of {} splits without noise: rounding of doubles; with the usual noise of the lengths {:.3f} "
      "on average",
      kManyTrees, noisy);
}

}  // namespace

std::vector<RowGroup> fg86_growth_groups() {
  return {
      {"trees grown with 0 to 5 generations, pruned and not",
       {claim("FG86-A11a", "planes after 3 generations from 6, no pruning", "1", 48.0, "2^n N"),
        claim("FG86-A11b", "planes after 3 generations from 6, pruned", "1", 48.0, "2^n N")},
       fill_generations},
      {"trees grown with 3 to 8 start normals", start_claims(), fill_starts},
      {"operations of splits, counted while trees grow",
       {claim(
            "FG86-A18a", "operations of a split: steps 1 to 4 as printed", "1", 20.0,
            "\"less than 20 floating point operations and/or lookup steps\": from operations alone to both"),
        claim("FG86-A18b", "operations of a split in space, all of it", "1", 20.0, "the same sentence"),
        claim("FG86-A21", "rate of splitting for 200 trees at 60 Hz", "MFLOPS", 1.4,
              "from operations alone to operations and look-ups")},
       fill_operations},
      {"", {claim("FG86-A20", "splits from 6 planes to 12", "1", 6.0)}, fill_level_of_detail},
      {"trees split by large angles, pruned and not",
       {claim("FG86-A31", "pruned trees whose centre is outside", "1", 0.0,
              "pruning excludes the \"errant normal\" that cuts the tree in half")},
       fill_centres},
      {"",
       {claim("FG86-A32", "children's tips off the parent's plane", "1", 0.0,
              "share of the parent's length, one split without noise of |BC| and of the lengths")},
       fill_tips}};
}

}  // namespace dendro::study
