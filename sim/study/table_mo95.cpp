#include "sim/study/table_mo95.h"

#include <fmt/format.h>

#include <algorithm>

namespace dendro::study {
namespace {

using Settings = std::vector<std::string>;

constexpr const char* kTimed = "zbuffer_views.precompute=timed";

const char* const kPaperSlower =
    "a C compiler of 1991, an operating system, more samples a frame or other loops than those here";
const char* const kPaperFaster = "fewer samples a frame or tighter loops than those here";

/// Ends of the plausible trees of DEV-160 and DEV-161.
Settings triangles(int count) { return {fmt::format("object.0.triangles={}", count)}; }

struct Reading {
  const char* name;
  Settings settings;
};

/// What MO95 leaves open of its films, and how the programs are made.
const std::vector<Reading>& film_readings() {
  static const std::vector<Reading> list = {
      {"views of 300x300", {"zbuffer_views.view_width=300", "zbuffer_views.view_height=300"}},
      {"a light view too", {"zbuffer_views.shadows=true"}},
      {"-O1", {"zbuffer_views.compiler=O1"}},
      {"unmapped", {"zbuffer_views.mapped=false"}}};
  return list;
}

std::string readings_note(const Mo95Spread& spread) {
  std::string text;
  for (std::size_t i = 0; i < spread.readings.size(); ++i)
    text += fmt::format("{}{}: {:.2f} s", i == 0 ? "" : ", ", film_readings()[i].name, mo95_frame_seconds(spread.readings[i]));
  return text;
}

/// Rows of views with their range over trees.
void set_precompute(TableRow& row, Mo95Spread spread, std::vector<stats::RunObject> trees, double paper_trees_low,
                    double paper_trees_high) {
  const double small = mo95_precompute_seconds(trees[0]), large = mo95_precompute_seconds(trees[1]);
  spread.readings = std::move(trees);
  set_spread(row, spread, mo95_precompute_seconds);
  row.note = fmt::format("{:.0f} triangles; {:.1f} s with {:.0f}, {:.1f} s with {:.0f}: MO95 does not print how many; no disk is modelled",
                         fact(spread.nominal, "triangles"), small, paper_trees_low, large, paper_trees_high) +
             outside_note(row, "the paper's includes storing the views on a disk, or its tree has more triangles",
                          "its tree has fewer triangles, or its scan conversion is tighter");
}

void fill_films(const TableContext& context, std::vector<TableRow>& rows) {
  std::vector<Mo95Spread> films;
  for (const char* scene : {"video-3", "video-4"}) {
    std::vector<SceneRun> readings;
    for (const Reading& reading : film_readings()) readings.push_back(mo95_scene(scene, reading.settings));
    for (const int count : {20000, 200000}) {
      readings.push_back(mo95_scene(scene, triangles(count)));
      readings.back().settings.push_back(kTimed);
    }
    films.push_back(mo95_spread(context, mo95_scene(scene, {kTimed}), readings, std::string("MO95 ") + scene));
  }
  for (std::size_t i = 0; i < films.size(); ++i) {
    Mo95Spread& film = films[i];
    const std::vector<stats::RunObject> trees(film.readings.end() - 2, film.readings.end());
    film.readings.resize(film_readings().size());
    set_spread(rows[i], film, mo95_frame_seconds);
    rows[i].note = readings_note(film) + outside_note(rows[i], kPaperSlower, kPaperFaster);
    set_precompute(rows[3 + i], film, trees, fact(trees[0], "triangles"), fact(trees[1], "triangles"));
  }
  const auto ratio = [](const stats::RunObject& three, const stats::RunObject& one) {
    return mo95_frame_seconds(three) / mo95_frame_seconds(one);
  };
  TableRow& three = rows[2];
  const double value = ratio(films[1].nominal, films[0].nominal);
  set_range(three, value, value, value);
  for (const auto runs : {&Mo95Spread::corners, &Mo95Spread::readings})
    for (std::size_t i = 0; i < (films[0].*runs).size(); ++i) {
      const double r = ratio((films[1].*runs)[i], (films[0].*runs)[i]);
      three.low = std::min(*three.low, r), three.high = std::max(*three.high, r);
    }
  three.assumptions = films[0].assumptions;
  three.note = "clearing and shading do not grow with the layers, and the second and third layer are mostly empty" +
               outside_note(three, "a sample costs as much whether it is empty or not", "its picture costs nothing a frame");
  const auto cycles = [](const stats::RunObject& run) {
    return mo95_frame_seconds(run) * run.clock_hz / (fact(run, "samples.camera") + fact(run, "samples.light"));
  };
  set_spread(rows[5], films[0], cycles);
  rows[5].note = "all of a frame over the samples that it visits; " + fmt::format("{:.0f} visited", fact(films[0].nominal, "samples.camera")) +
                 outside_note(rows[5], kPaperSlower, kPaperFaster);
  set_single(rows[6], fact(films[0].nominal, "views"));
  set_single(rows[7], fact(films[0].nominal, "views") * 2 * fact(films[0].nominal, "views.bytes_each") / 1e6);
}

void fill_size(const TableContext& context, std::vector<TableRow>& rows) {
  SceneRun run = mo95_scene("magnolia", {"object.0.leaf_rows=2"});
  run.level = level_name(Level::kFunction);
  set_single(rows[0], fact(mo95_runs(context, {run}, "MO95 size").front(), "views.bytes_each"));
  rows[0].note = "counted in the views' file; independent of the tree";
}

/// The row's figures were taken from a set of few views; `nominal` is of all.
void scale_to(TableRow& row, double nominal) {
  const double factor = nominal / *row.simulated;
  set_range(row, nominal, *row.low * factor, *row.high * factor);
}

void fill_fir(const TableContext& context, std::vector<TableRow>& rows) {
  const stats::RunObject all = mo95_runs(context, {mo95_scene("video-2", {kTimed})}, "MO95 video-2").front();
  const Settings few = {kTimed, "zbuffer_views.bands=2"};
  std::vector<SceneRun> readings;
  for (const Settings& one : {triangles(50000), triangles(600000), Settings{"zbuffer_views.light_width=256", "zbuffer_views.light_height=256"},
                              Settings{"zbuffer_views.light_width=1024", "zbuffer_views.light_height=1024"}}) {
    Settings settings = few;
    settings.insert(settings.end(), one.begin(), one.end());
    readings.push_back(mo95_scene("video-2", settings));
  }
  Mo95Spread spread = mo95_spread(context, mo95_scene("video-2", few), readings, "MO95 fir");
  const std::vector<stats::RunObject> trees(spread.readings.begin(), spread.readings.begin() + 2);
  set_spread(rows[0], spread, mo95_frame_seconds);
  scale_to(rows[0], mo95_frame_seconds(all));
  rows[0].note = fmt::format("{:.2f} s with 50,000 and {:.2f} s with 600,000 triangles, {:.2f} s and {:.2f} s with a light buffer of 256x256 and "
                             "1024x1024; ends of the interval from a set of {:.0f} views",
                             mo95_frame_seconds(trees[0]), mo95_frame_seconds(trees[1]), mo95_frame_seconds(spread.readings[2]),
                             mo95_frame_seconds(spread.readings[3]), fact(spread.nominal, "views")) +
                 outside_note(rows[0], kPaperSlower, kPaperFaster);
  set_precompute(rows[1], spread, trees, fact(trees[0], "triangles"), fact(trees[1], "triangles"));
  const double views = fact(spread.nominal, "views");
  scale_to(rows[1], mo95_precompute_seconds(all));
  rows[1].note = fmt::format("{:.2f} s a view, {:.2f} s in a set of {:.0f}, from which the ends are scaled and the following two are; ",
                             mo95_precompute_seconds(all) / fact(all, "views"), mo95_precompute_seconds(spread.nominal) / views, views) +
                 rows[1].note;
  set_single(rows[2], fact(all, "views"));
  set_single(rows[3], fact(all, "views.bytes") / 1e6);
}

void fill_grove(const TableContext& context, std::vector<TableRow>& rows) {
  const Mo95Spread spread = mo95_spread(context, mo95_scene("magnolia-grove", {}), {}, "MO95 grove");
  set_spread(rows[0], spread, mo95_frame_seconds);
  rows[0].note = fmt::format("{:.0f} and {:.0f} samples for camera and light, {:.1f} s a tree; {:.1f} s reading views", fact(spread.nominal, "samples.camera"),
                             fact(spread.nominal, "samples.light"), mo95_frame_seconds(spread.nominal) / 7, mo95_tree_seconds(spread.nominal)) +
                 outside_note(rows[0], kPaperSlower, kPaperFaster);
}

std::vector<RowGroup> open_rows() {
  RowGroup group{"", {}, [](const TableContext&, std::vector<TableRow>&) {}};
  const auto add = [&group](const char* id, const char* what, const char* why) {
    group.rows.push_back(claim(id, what, "1"));
    group.rows.back().note = std::string("no figure: ") + why;
  };
  add("MO95-B2", "figures at latitudes 90, 45 and 0 with n = 4", "a statement on directions, which tests compare with the rule");
  add("MO95-B5", "a picture must be somewhat coarser than its views", "no experiment here varies the picture's size");
  add("MO95-B13", "three views inside of polar triangles, else four", "both are implemented; no time was printed for either");
  add("MO95-B14", "z-buffer hardware does not keep several layers", "a statement on other machines");
  add("MO95-B15", "glitches with one layer, none with three", "no number; pictures of a turn show it");
  add("MO95-B16", "no jump when the set of views changes", "no number; pictures of a turn show it");
  add("MO95-B17", "shading once a covered pixel", "a statement on the program, which its phases show");
  add("MO95-B18", "normals in two bytes", "no figure in MO95; tests compare normals with their bytes");
  return {group};
}

/// A setting that no scene of the table takes is the user's mistake.
void check(const TableContext& context) {
  check_level(context);
  check_run(request_of(context, mo95_scene("video-3", {})));
}

}  // namespace

std::vector<RowGroup> mo95_frame_groups() {
  const char* film = "four views of 300x600, no light view, mapped, -O2; without the sequence's first reading";
  const char* views = "the whole program, from the tree's file to the views' file";
  return {{"magnolia from 14 views of one and of three layers, views and a frame, at all corners and readings",
           {claim("MO95-B6a", "magnolia 300x300 from one layer, a frame", "s", 2.3, film),
            claim("MO95-B6b", "magnolia 300x300 from three layers, a frame", "s", 6.9, film),
            claim("MO95-B6c", "three layers over one layer", "1", 3.0, film),
            claim("MO95-B7a", "14 views of the magnolia, one layer", "s", 68.0, views),
            claim("MO95-B7b", "14 views of the magnolia, three layers", "s", 82.0, views),
            claim("MO95-B11", "cycles a stored sample, one layer", "1", 115.0, "2.3 s at 36 MHz over four views of 300x600"),
            claim("MO95-B1a", "views for n = 3", "1", 14.0, "the strict rule of arc lengths (MO95-K1)"),
            claim("MO95-B4a", "14 views of two layers", "MB", std::nullopt, "not printed")},
           fill_films},
          {"the size of a view", {claim("MO95-B3", "a view of 300x600, two layers", "byte", 2520000.0)}, fill_size},
          {"fir from 23 views of three layers, views and a frame with shadows; ends from fewer views",
           {claim("MO95-B8", "fir 400x400, perspective, shadows, a frame", "s", 12.3, "four views of 300x600 for camera and for light, light buffer as the picture"),
            claim("MO95-B7c", "23 views of the fir, three layers", "s", 207.0, views),
            claim("MO95-B1b", "views for n = 4", "1", 23.0, "the strict rule of arc lengths (MO95-K1)"),
            claim("MO95-B4b", "23 views of three layers", "MB", std::nullopt, "not printed")},
           fill_fir},
          {"the grove, one frame at all corners",
           {claim("MO95-B9", "grove of seven magnolias 500x350, shadows", "s", 73.0, "four views of 300x600 and two layers for camera and for light")},
           fill_grove}};
}

PaperTable mo95_table() {
  std::vector<RowGroup> groups;
  for (const auto make : {mo95_frame_groups, mo95_tree_groups, open_rows})
    for (RowGroup& group : make()) groups.push_back(std::move(group));
  return grouped_table("MO95", std::move(groups), check);
}

}  // namespace dendro::study
