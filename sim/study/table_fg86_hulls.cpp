#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/half_space/host/hulls_layout.h"
#include "firmware/half_space/host/prepare.h"
#include "firmware/half_space/host/prepare_hulls.h"
#include "firmware/half_space/reference/hulls_fixed_point.h"
#include "sim/base/check.h"
#include "sim/scene/plane_set.h"
#include "sim/study/table_fg86.h"

namespace dendro::study {
namespace {

constexpr const char* kBoxedScenes[] = {"icosahedron", "pine-hull", "crown", "figure5", "grove"};
constexpr const char* kMergedScenes[] = {"figure5", "grove"};

/// The loops over the pixels of a line in passes 1 and 2.
std::map<std::uint32_t, std::string> count_visits(const RunRequest& request) {
  const config::ParameterSet& parameters = request.preset.parameters;
  const tools::Ucode program = half_space::needs_three_registers(request.file.scene)
                                   ? hulls_program(parameters)
                                   : half_space_program(parameters);
  std::map<std::uint32_t, std::string> counted;
  for (const auto& [name, at] : program.symbols)
    if (name.rfind("depth_step", 0) == 0 || name.rfind("edge_step", 0) == 0) counted[at] = name;
  return counted;
}

void fill_box(TableRow& row, const stats::RunObject& run) {
  double visits = 0;
  for (const auto& [name, count] : run.executions)
    if (name.rfind("depth_step_face", 0) != 0) visits += static_cast<double>(count);
  const double planes = fact(run, "planes.back") + fact(run, "planes.edge_on") + fact(run, "planes.front");
  const double unboxed = planes * run.image.width * run.image.height;
  DENDRO_CHECK(visits > 0 && unboxed > 0);
  set_single(row, 100 * visits / unboxed);
  row.note =
      fmt::format("{:.3g} million visits; {:g} planes over the whole picture would make {:.3g} million",
                  visits / 1e6, planes, unboxed / 1e6);
}

void fill_merge(TableRow& row, const stats::RunObject& run) {
  set_single(row, error_figure(run, "outside_enclosure"));
  row.note = fmt::format(
      "{:g} hulls, {} pixels covered; {} pixels at silhouettes thinner than one of 256 depths are covered in "
      "one and "
      "not the other",
      fact(run, "hulls"), run.error.covered_pixels, run.error.wrong_pixels);
}

template <std::size_t N>
void fill_scenes(const TableContext& context, const char* const (&scenes)[N], std::vector<TableRow>& rows,
                 void (*fill)(TableRow&, const stats::RunObject&)) {
  std::vector<SceneRun> runs;
  for (const char* scene : scenes) runs.push_back({scene, {}, "function", count_visits});
  const std::vector<Outcome> outcomes = compared_runs(context, runs, "FG86 pixel visits");
  for (std::size_t i = 0; i < N; ++i)
    outcomes[i].error ? set_refused(rows[i], *outcomes[i].error)
                      : fill(rows[i], from_bytes(outcomes[i].bytes).object);
}

void fill_boxes(const TableContext& context, std::vector<TableRow>& rows) {
  fill_scenes(context, kBoxedScenes, rows, fill_box);
}

void fill_merges(const TableContext& context, std::vector<TableRow>& rows) {
  fill_scenes(context, kMergedScenes, rows, fill_merge);
}

double covered_pixels(const half_space::PreparedHulls& prepared) {
  double covered = 0;
  for (const std::uint32_t word : half_space::run_hulls_fixed_point(prepared).pixels)
    covered += static_cast<int>(word >> half_space::kNearestLow & half_space::kHullField) < prepared.maxdepth;
  return covered;
}

struct Grove {
  double trees = 0, alone = 0, together = 0;  ///< pixels: of all trees one by one, of their union
  double smallest = INFINITY, largest = 0;    ///< tree, pixels
  double screen = 0;
};

Grove measure_grove(const scene::Scene& scene) {
  const half_space::PreparedHulls all = half_space::prepare_hulls(scene);
  half_space::PreparedHulls one = all;
  Grove grove;
  grove.trees = static_cast<double>(all.hulls.size());
  grove.together = covered_pixels(all);
  grove.screen = double(all.width) * all.height;
  for (const half_space::Hull& hull : all.hulls) {
    one.hulls = {hull};
    const double pixels = hull.visible ? covered_pixels(one) : 0;
    grove.alone += pixels;
    grove.smallest = std::min(grove.smallest, pixels), grove.largest = std::max(grove.largest, pixels);
  }
  DENDRO_CHECK(grove.together > 0);
  return grove;
}

constexpr std::uint64_t kGroves = 4;  ///< other groves, for the interval

void fill_grove(const TableContext& context, std::vector<TableRow>& rows) {
  RunRequest request = request_of(context, {"grove", {}, "function", {}});
  const Grove grove = measure_grove(request.file.scene);
  set_single(rows[0], grove.alone / grove.together);
  set_range(rows[1], grove.alone / grove.trees, grove.smallest, grove.largest);
  set_single(rows[2], 100 * grove.together / grove.screen);
  const auto widen = [](TableRow& row, double value) {
    row.low = std::min(*row.low, value), row.high = std::max(*row.high, value);
  };
  for (std::uint64_t i = 1; i <= kGroves; ++i) {
    request.file.scene.seed += i;
    const Grove other = measure_grove(request.file.scene);
    widen(rows[0], other.alone / other.together);
    widen(rows[2], 100 * other.together / other.screen);
  }
  rows[0].note = fmt::format(
      "the trees cover {:.0f} pixels one by one and {:.0f} together: they stand on a quarter of the screen "
      "and overlap, and are "
      "larger than 20x20 so that crowns of round outline fill it; the paper divides 200 x 400 by 65,536 "
      "pixels",
      grove.alone, grove.together);
  rows[1].note = "interval: smallest and largest tree; circular: the scene's sizes follow the same sentence";
  rows[2].note =
      fmt::format("interval: {} other groves; circular: the trees stand on a quarter of the screen", kGroves);
}

void fill_storage(const TableContext& context, std::vector<TableRow>& rows) {
  const RunRequest request = request_of(context, {"icosahedron", {}, "function", {}});
  const half_space::Prepared prepared = half_space::prepare(request.file.scene);
  const auto corners = scene::intersection_vertices(scene::solid_planes("icosahedron"));
  DENDRO_CHECK(corners.has_value());
  set_single(rows[0], static_cast<double>(prepared.program.record_words().size()));
  const double faces = static_cast<double>(prepared.screen.size());
  set_single(rows[1], 3 * static_cast<double>(corners->size()) + 3 * faces);
  rows[0].note =
      fmt::format("records of {:g} planes as the scratchpad holds them; 4 F words without steep ones", faces);
  rows[1].note = fmt::format("{} corners of 3 numbers and {:g} triangles of 3 indices: 4.5 F + 6 words",
                             corners->size(), faces);
}

template <std::size_t N>
std::vector<TableRow> scene_claims(const char* const (&scenes)[N], const std::string& id, const char* what,
                                   const char* unit, std::optional<double> published, const char* reading) {
  std::vector<TableRow> rows;
  for (std::size_t i = 0; i < N; ++i)
    rows.push_back(claim(id + static_cast<char>('a' + i), fmt::format("{}, {}", what, scenes[i]), unit,
                         published, reading));
  return rows;
}

}  // namespace

std::vector<RowGroup> fg86_hull_groups() {
  return {{"the grove's trees on integers, one by one and together",
           {claim("FG86-A19a", "depth complexity of 200 trees", "1", 1.22),
            claim("FG86-A19b", "pixels of a tree of the grove", "px", 400.0, "20x20"),
            claim("FG86-A19c", "share of the screen under 200 trees", "%", 25.0)},
           fill_grove},
          {"",
           {claim("FG86-A29a", "words of an icosahedron as planes", "1", 80.0, "4 F with F = 20"),
            claim("FG86-A29b", "words of an icosahedron as a mesh", "1", 96.0,
                  "\"a little less\": 4.5 F + 6 with F = 20")},
           fill_storage},
          {"shipped scenes at level function, their pixel visits",
           scene_claims(kBoxedScenes, "FG86-A33", "boxing: pixel visits left", "%", std::nullopt,
                        "\"eliminates a great many scanlines\": pixels visited in passes 1 and 2, of those "
                        "without any box"),
           fill_boxes},
          {"the same runs of several hulls, their third register against the exact union",
           scene_claims(kMergedScenes, "FG86-A34", "intersecting hulls: wrong nearest depths", "px", 0.0,
                        "\"the correct result will be obtained\": pixels whose third register is not the "
                        "least front depth "
                        "of the hulls"),
           fill_merges}};
}

}  // namespace dendro::study
