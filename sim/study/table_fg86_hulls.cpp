#include "sim/study/table_fg86_hulls.h"

#include <fmt/format.h>

#include <algorithm>

#include "firmware/half_space/host/prepare.h"
#include "firmware/half_space/host/tree_object.h"
#include "firmware/half_space/reference/hulls_reference.h"
#include "sim/base/check.h"

namespace dendro::study {
namespace {

constexpr int kTrees = 40;
constexpr int kSide = 64;  ///< of the pictures in which shares are counted, pixels

TableRow row(const std::string& id, const std::string& what, const std::string& unit) {
  TableRow r;
  r.id = id;
  r.paper = "FG86";
  r.what = what;
  r.unit = unit;
  return r;
}

void set_single(TableRow& r, double value) { r.simulated = r.low = r.high = value; }

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

std::vector<TableRow> start_rows() {
  std::vector<TableRow> rows;
  for (int normals = 3; normals <= 8; ++normals) {
    TableRow r = row(fmt::format("FG86-A12{}", static_cast<char>('a' + normals - 3)),
                     fmt::format("unbounded pixels of crowns from {} start normals", normals), "%");
    r.simulated = open_percentage(normals, 30, 1);
    r.low = r.high = r.simulated;
    for (const double angle : {15.0, 50.0}) {
      const double share = open_percentage(normals, angle, 1);
      r.low = std::min(*r.low, share), r.high = std::max(*r.high, share);
    }
    r.assumptions = {"DEV-045"};
    r.reading =
        "\"three to six give the best results\": share of the pixels with a crown, in a picture five radii "
        "high, where no plane bounds it behind";
    r.note = fmt::format(
        "{} trees split once by 30 degrees, interval from 15 to 50; unsplit {:.3g} %, split twice {:.3g} %",
        kTrees, open_percentage(normals, 30, 0), open_percentage(normals, 30, 2));
    rows.push_back(std::move(r));
  }
  return rows;
}

half_space::Grown grown(int splits, std::uint64_t seed, bool prune) {
  scene::Object object;
  object.tree = "round";
  half_space::Tree tree = half_space::trees_of(object, seed).front();
  tree.growth.splits = splits;
  tree.growth.prune = prune;
  return half_space::grow(tree.growth);
}

std::vector<TableRow> split_rows() {
  half_space::GrowthCount printed, everything;
  double splits = 0;
  for (std::uint64_t seed = 1; seed <= kTrees; ++seed) {
    const half_space::Grown tree = grown(6, seed, true);
    printed += tree.printed;
    for (const auto* part : {&tree.printed, &tree.vectors, &tree.pruning}) everything += *part;
    splits += tree.splits;
  }
  TableRow steps = row("FG86-A18a", "operations of a split: steps 1 to 4 as printed", "1");
  steps.published = 20;
  steps.simulated = steps.low = static_cast<double>(printed.flops) / splits;
  steps.high = static_cast<double>(printed.flops + printed.look_ups) / splits;
  steps.reading =
      "\"less than 20 floating point operations and/or lookup steps\": from operations alone to both";
  steps.note =
      fmt::format("{:.1f} operations and {:.1f} look-ups (gauss, cosine) a split, mean of {:g} splits",
                  *steps.simulated, static_cast<double>(printed.look_ups) / splits, splits);
  TableRow all = row("FG86-A18b", "operations of a split in space, all of it", "1");
  all.published = 20;
  all.simulated = all.low = static_cast<double>(everything.flops) / splits;
  all.high = static_cast<double>(everything.flops + everything.look_ups + everything.comparisons) / splits;
  all.reading =
      "with the children's origin and directions in space and the pruning, which the printed steps leave out";
  all.note = "high: look-ups and comparisons counted, too; \"less than 20\" holds only for the printed steps";
  return {steps, all};
}

TableRow level_of_detail_row() {
  TableRow r = row("FG86-A20", "splits from 6 planes to 12", "1");
  r.published = 6;
  int splits = 0;
  while (grown(splits, 1, true).planes.size() < 12) {
    ++splits;
    DENDRO_CHECK(splits <= 100, "splits add no planes");
  }
  set_single(r, splits);
  std::size_t pruned = 0;
  for (std::uint64_t seed = 1; seed <= kTrees; ++seed)
    pruned += static_cast<std::size_t>(grown(6, seed, true).pruned);
  r.note = fmt::format("every split adds one plane; pruning took {} planes of {} such trees", pruned, kTrees);
  return r;
}

RunOutput run_at_function(const TableContext& context, const std::string& scene) {
  RunArguments arguments;
  arguments.scene = scene;
  arguments.level = "function";
  arguments.settings = settings_for(context, "rds3000");
  RunRequest request = prepare_run(context.catalogue, arguments);
  const bool several = scene == "figure5" || scene == "grove";
  const tools::Ucode program =
      several ? hulls_program(request.preset.parameters) : half_space_program(request.preset.parameters);
  for (const auto& [name, at] : program.symbols)
    if (name.rfind("depth_step", 0) == 0 || name.rfind("edge_step", 0) == 0)
      request.options.counted[at] = name;
  return execute_in_worker(request, "", nullptr);
}

double fact(const stats::RunObject& run, const std::string& name) {
  for (const auto& [key, value] : run.facts)
    if (key == name) return value;
  return 0;
}

double extra(const stats::RunObject& run, const std::string& name) {
  for (const auto& [key, value] : run.error.extra)
    if (key == name) return value;
  DENDRO_CHECK(false, "{} is not reported", name);
  return 0;
}

TableRow box_row(const std::string& id, const std::string& scene, const stats::RunObject& run) {
  TableRow r = row(id, "boxing: pixel visits left, " + scene, "%");
  double visits = 0;
  for (const auto& [name, count] : run.executions)
    if (name.rfind("depth_step_face", 0) != 0) visits += static_cast<double>(count);
  const double planes = fact(run, "planes.back") + fact(run, "planes.edge_on") + fact(run, "planes.front");
  const double unboxed = planes * run.image.width * run.image.height;
  DENDRO_CHECK(visits > 0 && unboxed > 0);
  set_single(r, 100 * visits / unboxed);
  r.reading =
      "\"eliminates a great many scanlines\": pixels visited in passes 1 and 2, of those without any box";
  r.note = fmt::format("{:.3g} million visits; {:g} planes over the whole picture would make {:.3g} million",
                       visits / 1e6, planes, unboxed / 1e6);
  return r;
}

TableRow merge_row(const std::string& id, const std::string& scene, const stats::RunObject& run) {
  TableRow r = row(id, "intersecting hulls: wrong nearest depths, " + scene, "px");
  r.published = 0;
  set_single(r, extra(run, "outside_enclosure"));
  r.reading =
      "\"the correct result will be obtained\": pixels whose third register is not the least front depth of "
      "the hulls";
  r.note = fmt::format(
      "{:g} hulls, {} pixels covered; {} pixels at silhouettes thinner than one of 256 depths are covered in "
      "one and not "
      "the other",
      fact(run, "hulls"), run.error.covered_pixels, run.error.wrong_pixels);
  return r;
}

}  // namespace

std::vector<TableRow> fg86_hull_rows(const TableContext& context) {
  std::vector<TableRow> rows = start_rows();
  for (TableRow& r : split_rows()) rows.push_back(std::move(r));
  rows.push_back(level_of_detail_row());
  std::vector<TableRow> merges;
  char letter = 'a', merge_letter = 'a';
  for (const char* scene : {"icosahedron", "pine-hull", "crown", "figure5", "grove"}) {
    const stats::RunObject run = run_at_function(context, scene).object;
    rows.push_back(box_row(fmt::format("FG86-A33{}", letter++), scene, run));
    if (fact(run, "hulls") > 1)
      merges.push_back(merge_row(fmt::format("FG86-A34{}", merge_letter++), scene, run));
  }
  rows.insert(rows.end(), merges.begin(), merges.end());
  return rows;
}

}  // namespace dendro::study
