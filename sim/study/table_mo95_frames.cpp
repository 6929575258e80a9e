#include <fmt/format.h>

#include <algorithm>

#include "sim/study/table_mo95.h"

namespace dendro::study {
namespace {

using Settings = std::vector<std::string>;

constexpr const char *kTimed = "zbuffer_views.precompute=timed",
                     *kUntimed = "zbuffer_views.precompute=untimed";
constexpr const char *kSmall = "views of 300x300", *kFew = "few triangles", *kMany = "many triangles";

/// MB/s of a disk of 1991.  ASSUMED DEV-170
constexpr double kSlowDisk = 0.5, kDisk = 1, kFastDisk = 1.5;

const char* const kPaperSlower =
    "a C compiler of 1991, other loops than those here, an operating system, or more samples a frame";
const char* const kPaperFaster = "fewer samples a frame or tighter loops than those here";
const char* const kViewsSlower =
    "storing the views on a disk is not in it, nor is a compiler of 1991; or its tree has more triangles";
const char* const kViewsFaster = "its tree has fewer triangles, or its scan conversion is tighter";

/// Ends of the plausible trees of DEV-160 and DEV-161.
Mo95Variant triangles(const char* name, int count) {
  return {name, {fmt::format("object.0.triangles={}", count)}};
}

void add_programs(std::vector<Mo95Variant>& variants) {
  for (Mo95Variant& variant : mo95_program_variants()) variants.push_back(std::move(variant));
}

/// What MO95 leaves open of its films, how the programs are made, and trees of other sizes.
Mo95Plan film(const char* scene, bool with_others) {
  Mo95Plan plan{scene, {kTimed}, {}, {}};
  add_programs(plan.readings);
  plan.readings.push_back({kSmall, {"zbuffer_views.view_width=300", "zbuffer_views.view_height=300"}});
  plan.readings.push_back({"a light view too", {"zbuffer_views.shadows=true", kUntimed}});
  // From 45 degrees above, where three views are nearest.  ASSUMED DEV-165
  plan.readings.push_back({"three views", {"camera.position=[0, 16, 13.8]", kUntimed}});
  plan.readings.push_back(triangles(kFew, 20000));
  plan.readings.push_back(triangles(kMany, 200000));
  if (with_others)
    plan.others = {
        {"the full product for every sample", {"zbuffer_views.full_product=true", kUntimed}},
        {"that with -O1", {"zbuffer_views.full_product=true", "zbuffer_views.compiler=O1", kUntimed}},
        {"that with -O1 and a light view",
         {"zbuffer_views.full_product=true", "zbuffer_views.compiler=O1", "zbuffer_views.shadows=true",
          kUntimed}},
        {"empty samples skipped", {"zbuffer_views.skip_empty=true", kUntimed}}};
  return plan;
}

double reprojection(const stats::RunObject& run) {
  return phase_seconds(run, "zbuffer_views_reconstruct.reproject_camera") +
         phase_seconds(run, "zbuffer_views_reconstruct.reproject_light");
}

void set_frame(TableRow& row, const Mo95Spread& spread) {
  set_spread(row, spread, mo95_frame_seconds);
  row.note = fmt::format("{:.0f} and {:.0f} samples for camera and light, reprojection is {:.0f} % of it; {}",
                         fact(spread.nominal, "samples.camera"), fact(spread.nominal, "samples.light"),
                         100 * reprojection(spread.nominal) / mo95_frame_seconds(spread.nominal),
                         told(spread.plan.readings, spread.readings, mo95_frame_seconds));
  const std::string others = told(spread.plan.others, spread.others, mo95_frame_seconds);
  if (!others.empty()) row.note += "; not in the interval: " + others;
  row.note += outside_note(row, kPaperSlower, kPaperFaster);
}

/// Views without a disk, and with one that every sample is written to.
void set_views(TableRow& row, TableRow& with_disk, const Mo95Spread& spread, const stats::RunObject& all) {
  set_spread(row, spread, mo95_precompute_seconds);
  scale_to(row, mo95_precompute_seconds(all));
  const auto tree = [&](const char* name) { return fact(spread.run(name), "triangles"); };
  row.note = fmt::format("{:.0f} triangles; \"{}\": {:.0f}, \"{}\": {:.0f}, MO95 does not print how many; {}",
                         fact(all, "triangles"), kFew, tree(kFew), kMany, tree(kMany),
                         told(spread.plan.readings, spread.readings, mo95_precompute_seconds));
  row.note += outside_note(row, kViewsSlower, kViewsFaster);
  const double megabytes = fact(all, "views.bytes") / 1e6;
  set_range(with_disk, *row.simulated + megabytes / kDisk, *row.low + megabytes / kFastDisk,
            *row.high + megabytes / kSlowDisk);
  with_disk.assumptions = row.assumptions;
  with_disk.assumptions.push_back("DEV-170");
  with_disk.note =
      fmt::format(
          "{:.1f} MB written at {} to {} MB/s, {} the middle, after everything else; no disk is simulated",
          megabytes, kSlowDisk, kFastDisk, kDisk) +
      outside_note(with_disk, "a compiler of 1991, or its tree has more triangles", kViewsFaster);
}

void set_samples(TableRow& row, const Mo95Spread& spread, const stats::RunObject& nominal) {
  set_spread(row, spread, mo95_sample_cycles);
  scale_to(row, mo95_sample_cycles(nominal));
  row.note = fmt::format("all of a frame over the {:.0f} samples that it visits{}",
                         fact(nominal, "samples.camera") + fact(nominal, "samples.light"),
                         outside_note(row, kPaperSlower, kPaperFaster));
}

void set_layers_ratio(TableRow& row, const Mo95Spread& one, const Mo95Spread& three) {
  const auto ratio = [](const stats::RunObject& many, const stats::RunObject& single) {
    return mo95_frame_seconds(many) / mo95_frame_seconds(single);
  };
  const double value = ratio(three.nominal, one.nominal);
  set_range(row, value, value, value);
  for (const auto runs : {&Mo95Spread::corners, &Mo95Spread::readings})
    for (std::size_t i = 0; i < (one.*runs).size(); ++i) {
      const double r = ratio((three.*runs)[i], (one.*runs)[i]);
      row.low = std::min(*row.low, r), row.high = std::max(*row.high, r);
    }
  row.assumptions = one.assumptions;
  row.note =
      "a sample takes 26 instructions when it is empty, 57 when it is stored, and deeper layers are mostly "
      "empty; "
      "clearing and shading do not grow with the layers" +
      outside_note(row, "every sample costs as much, or nothing but samples costs",
                   "its picture costs nothing a frame");
}

void fill_films(const TableContext& context, std::vector<TableRow>& rows) {
  const Mo95Spread one = mo95_spread(context, film("video-3", true)),
                   three = mo95_spread(context, film("video-4", false));
  set_frame(rows[0], one);
  set_frame(rows[1], three);
  set_layers_ratio(rows[2], one, three);
  set_views(rows[3], rows[5], one, one.nominal);
  set_views(rows[4], rows[6], three, three.nominal);
  set_samples(rows[7], one, one.nominal);
  set_samples(rows[8], one, one.run(kSmall));
  set_single(rows[9], fact(one.nominal, "views"));
  set_single(rows[10], fact(one.nominal, "views") * 2 * fact(one.nominal, "views.bytes_each") / 1e6);
  TableRow& cpi = rows[11];
  set_spread(cpi, three, [](const stats::RunObject& run) {
    return mo95_precompute_seconds(run) == 0 ? 0 : mo95_cycles_an_instruction(run);
  });
  cpi.note = beside(cpi, 1.2, 1.6) +
             "; precomputing and one frame of B6b; " +
             mo95_stalls(three.nominal);
}

void fill_size(const TableContext& context, std::vector<TableRow>& rows) {
  SceneRun run = mo95_scene("magnolia", {"object.0.leaf_rows=2"});
  run.level = level_name(Level::kFunction);
  set_single(rows[0], fact(mo95_runs(context, {run}, "MO95 size").front(), "views.bytes_each"));
  rows[0].note = "counted in the views' file; independent of the tree";
}

void fill_fir(const TableContext& context, std::vector<TableRow>& rows) {
  constexpr const char* kAll = "all views";
  Mo95Plan plan{"video-2", {kTimed, "zbuffer_views.bands=2"}, {}, {{kAll, {"zbuffer_views.bands=4"}}}};
  add_programs(plan.readings);
  plan.readings.push_back(
      {"views of 400x400", {"zbuffer_views.view_width=400", "zbuffer_views.view_height=400"}});
  for (const int side : {256, 1024})
    plan.readings.push_back({fmt::format("a light buffer of {0}x{0}", side),
                             {fmt::format("zbuffer_views.light_width={}", side),
                              fmt::format("zbuffer_views.light_height={}", side), kUntimed}});
  plan.readings.push_back(triangles(kFew, 50000));
  plan.readings.push_back(triangles(kMany, 600000));
  const Mo95Spread spread = mo95_spread(context, plan);
  const stats::RunObject& all = spread.run(kAll);
  const std::string scaled =
      fmt::format("; this and the ends of the interval from {:.0f} views", fact(spread.nominal, "views"));
  set_spread(rows[0], spread, mo95_frame_seconds);
  scale_to(rows[0], mo95_frame_seconds(all));
  rows[0].note = told(plan.readings, spread.readings, mo95_frame_seconds) + scaled +
                 outside_note(rows[0], kPaperSlower, kPaperFaster);
  set_views(rows[1], rows[2], spread, all);
  rows[1].note += scaled + fmt::format(", which take {:.1f} s", mo95_precompute_seconds(spread.nominal));
  set_samples(rows[3], spread, all);
  set_single(rows[4], fact(all, "views"));
  set_single(rows[5], fact(all, "views.bytes") / 1e6);
}

/// A frame with shadows from two layers, at all corners.
Mo95Spread shadowed(const TableContext& context, const char* scene) {
  return mo95_spread(context, {scene, {}, mo95_program_variants(), {}});
}

void fill_grove(const TableContext& context, std::vector<TableRow>& rows) {
  const Mo95Spread spread = shadowed(context, "magnolia-grove");
  set_frame(rows[0], spread);
  rows[0].note = fmt::format("{:.2f} s a tree; {:.2f} s reading views, once; ",
                             mo95_frame_seconds(spread.nominal) / fact(spread.nominal, "trees"),
                             mo95_tree_seconds(spread.nominal)) +
                 rows[0].note;
  set_samples(rows[1], spread, spread.nominal);
}

void fill_magnolia(const TableContext& context, std::vector<TableRow>& rows) {
  const Mo95Spread spread = shadowed(context, "magnolia");
  set_frame(rows[0], spread);
  rows[0].note =
      fmt::format("{:.2f} s reading views, once; ", mo95_tree_seconds(spread.nominal)) + rows[0].note;
}

}  // namespace

std::vector<RowGroup> mo95_frame_groups() {
  const char* frame =
      "four views of 300x600, no light view, mapped, -O2, no disk; without the film's first reading";
  const char* views = "the whole program from the tree's file to the views' file, mapped, -O2, no disk";
  const char* disk = "the same with a disk";
  const char* both = "four views of 300x600 for the camera, three for the sun, mapped, -O2, no disk";
  return {
      {"magnolia from 14 views of one and of three layers, views and a frame, at all corners and readings",
       {claim("MO95-B6a", "magnolia 300x300 from one layer, a frame", "s", 2.3, frame),
        claim("MO95-B6b", "magnolia 300x300 from three layers, a frame", "s", 6.9, frame),
        claim("MO95-B6c", "three layers over one layer", "1", 3.0, frame),
        claim("MO95-B7a", "14 views of the magnolia, one layer", "s", 68.0, views),
        claim("MO95-B7b", "14 views of the magnolia, three layers", "s", 82.0, views),
        claim("MO95-B7d", "B7a and a disk", "s", 68.0, disk),
        claim("MO95-B7e", "B7b and a disk", "s", 82.0, disk),
        claim("MO95-B11a", "cycles a stored sample, magnolia, one layer", "1", 115.0,
              "2.3 s at 36 MHz over four views of 300x600"),
        claim("MO95-B11b", "cycles a stored sample, views of 300x300", "1", 230.0,
              "2.3 s at 36 MHz over four views of 300x300"),
        claim("MO95-B1a", "views for n = 3", "1", 14.0, "the strict rule of arc lengths (MO95-K1)"),
        claim("MO95-B4a", "14 views of two layers", "MB", std::nullopt, "not printed"),
        claim("MO95-P6", "cycles an instruction, MO95's programs", "1", 1.4,
              "1.2 to 1.6 on machines with caches of 64 KB [GEN], the middle shown")},
       fill_films},
      {"the size of a view",
       {claim("MO95-B3", "a view of 300x600, two layers", "byte", 2520000.0)},
       fill_size},
      {"fir from 23 views of three layers, views and a frame with shadows; ends from fewer views",
       {claim("MO95-B8", "fir 400x400, perspective, shadows, a frame", "s", 12.3,
              std::string(both) + ", light buffer as the picture"),
        claim("MO95-B7c", "23 views of the fir, three layers", "s", 207.0, views),
        claim("MO95-B7f", "B7c and a disk", "s", 207.0, disk),
        claim("MO95-B11c", "cycles a stored sample, fir", "1", 102.5,
              "12.3 s at 36 MHz over four views of 300x600 each for camera and light, three layers"),
        claim("MO95-B1b", "views for n = 4", "1", 23.0, "the strict rule of arc lengths (MO95-K1)"),
        claim("MO95-B4b", "23 views of three layers", "MB", std::nullopt, "not printed")},
       fill_fir},
      {"the grove, one frame at all corners",
       {claim("MO95-B9a", "grove of seven magnolias 500x350, shadows", "s", 73.0,
              std::string(both) + ", two layers"),
        claim("MO95-B11d", "cycles a stored sample, grove", "1", 130.4,
              "73 s at 36 MHz over seven times four views each for camera and light, two layers")},
       fill_grove},
      {"one magnolia with shadows, one frame at all corners",
       {claim("MO95-B9b", "magnolia 256x512, shadows (Figure 8)", "s", 73.0 / 7,
              "no time is printed: a seventh of the grove, whose trees are this one; " + std::string(both) +
                  ", two layers")},
       fill_magnolia}};
}

}  // namespace dendro::study
