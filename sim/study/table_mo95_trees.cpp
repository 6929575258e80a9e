#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/study/table_mo95.h"

namespace dendro::study {
namespace {

constexpr double kFilmFrames = 360;

SceneRun polygons(int triangles) {
  return mo95_scene("video-1", {fmt::format("object.0.triangles={}", triangles)});
}

/// The same tree and camera from views; which of them are made does not move a frame's cost.
SceneRun from_views(int layers) {
  return mo95_scene("video-1", {"zbuffer_views.draw=views", "zbuffer_views.bands=3",
                                fmt::format("zbuffer_views.layers={}", layers)});
}

/// Triangles with which polygons take `seconds`, between the two points around it, in logarithms; 0: not in
/// the range.
double crossing(const std::vector<stats::RunObject>& runs, double seconds) {
  for (std::size_t i = 0; i + 1 < runs.size(); ++i) {
    const double below = mo95_frame_seconds(runs[i]), above = mo95_frame_seconds(runs[i + 1]);
    if (seconds < below || seconds > above) continue;
    const double share = std::log(seconds / below) / std::log(above / below),
                 from = fact(runs[i], "triangles");
    return from * std::pow(fact(runs[i + 1], "triangles") / from, share);
  }
  return 0;
}

void fill_polygons(const TableContext& context, std::vector<TableRow>& rows) {
  constexpr const char *kFew = "50,000 triangles", *kMany = "600,000 triangles";
  Mo95Plan plan{"video-1", {}, mo95_program_variants(), {}};
  plan.readings.push_back({kFew, {"object.0.triangles=50000"}});
  plan.readings.push_back({kMany, {"object.0.triangles=600000"}});
  const Mo95Spread spread = mo95_spread(context, plan);
  TableRow& frame = rows[0];
  set_spread(frame, spread, mo95_frame_seconds);
  frame.note =
      fmt::format(
          "{:.0f} triangles, MO95 does not print how many; {}; reading the tree and its normals, once a "
          "film, {:.1f} s more",
          fact(spread.nominal, "triangles"), told(plan.readings, spread.readings, mo95_frame_seconds),
          mo95_tree_seconds(spread.nominal)) +
      outside_note(frame, "more triangles, or looser scan conversion",
                   "fewer triangles, or tighter scan conversion");
  // The very run of the fir's rows, out of the cache where there is one.
  const SceneRun fir = mo95_scene(
      "video-2", {"zbuffer_views.precompute=timed", "zbuffer_views.bands=2", "zbuffer_views.bands=4"});
  const stats::RunObject views = mo95_runs(context, {fir}, "MO95 video-2").front();
  const auto whole = [&](const stats::RunObject& drawn) {
    return (mo95_precompute_seconds(views) + kFilmFrames * mo95_frame_seconds(views)) /
           (mo95_tree_seconds(drawn) + kFilmFrames * mo95_frame_seconds(drawn));
  };
  const double value = whole(spread.nominal);
  const auto [low, high] = std::minmax({value, whole(spread.run(kFew)), whole(spread.run(kMany))});
  set_range(rows[1], value, low, high);
  rows[1].note =
      "the interval is over polygons of 50,000 to 600,000 triangles, the machine nominal; views also have "
      "shadows and perspective, polygons neither";
}

void fill_crossing(const TableContext& context, std::vector<TableRow>& rows) {
  std::vector<SceneRun> runs;
  for (const int count : {5000, 10000, 20000, 50000, 100000, 200000, 400000, 600000})
    runs.push_back(polygons(count));
  for (const int layers : {1, 3}) runs.push_back(from_views(layers));
  std::vector<stats::RunObject> made = mo95_runs(context, runs, "MO95 crossing");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double seconds = mo95_frame_seconds(made[made.size() - 2 + i]);
    const std::vector<stats::RunObject> drawn(made.begin(), made.end() - 2);
    const double at = crossing(drawn, seconds);
    rows[i].note = fmt::format(
        "a frame from views takes {:.2f} s; polygons {:.2f} s with {:.0f} triangles, {:.2f} s with {:.0f}; "
        "same picture, without "
        "shadows, precomputing not counted, the machine nominal",
        seconds, mo95_frame_seconds(drawn.front()), fact(drawn.front(), "triangles"),
        mo95_frame_seconds(drawn.back()), fact(drawn.back(), "triangles"));
    if (at == 0)
      rows[i].note = "no figure: the two do not cross here: " + rows[i].note;
    else
      set_single(rows[i], std::round(at));
  }
}

void fill_sizes(const TableContext& context, std::vector<TableRow>& rows) {
  std::vector<SceneRun> runs;
  for (const char* scene : {"video-3", "video-4"})
    for (const int count : {20000, 200000})
      runs.push_back(
          mo95_scene(scene, {fmt::format("object.0.triangles={}", count), "zbuffer_views.precompute=timed"}));
  const std::vector<stats::RunObject> made = mo95_runs(context, runs, "MO95 tree sizes");
  const auto ratio = [&](std::size_t i) {
    return mo95_frame_seconds(made[i + 1]) / mo95_frame_seconds(made[i]);
  };
  const auto percent = [&](std::size_t i) { return std::round(100 * ratio(i)) / 100; };
  set_range(rows[0], percent(0), std::min(percent(0), percent(2)), std::max(percent(0), percent(2)));
  rows[0].note = fmt::format(
      "{:.0f} and {:.0f} triangles on the same leaves: {:.4f} with one layer, {:.4f} with three; what "
      "differs are the samples covered",
      fact(made[0], "triangles"), fact(made[1], "triangles"), ratio(0), ratio(2));
}

}  // namespace

std::vector<RowGroup> mo95_tree_groups() {
  return {{"the fir by polygons, at all corners, with 50,000 to 600,000 triangles",
           {claim("MO95-B10a", "fir by polygons 400x400, parallel, a frame", "s", 6.5,
                  "without reading the tree and its normals, which is done once"),
            claim("MO95-B10b", "360 frames: from views over by polygons", "1",
                  (207 + 360 * 12.3) / (360 * 6.5), "207 s + 360 x 12.3 s over 360 x 6.5 s")},
           fill_polygons},
          {"the same by polygons of 5,000 to 600,000 triangles and from views: the crossing",
           {claim("MO95-B10c", "triangles at which one layer beats polygons", "1", std::nullopt,
                  "not printed; a frame of the fir, 400x400"),
            claim("MO95-B10d", "triangles at which three layers do", "1", std::nullopt,
                  "not printed; a frame of the fir, 400x400")},
           fill_crossing},
          {"magnolias of 20,000 and 200,000 triangles",
           {claim("MO95-B12", "a frame's time, ten times the triangles", "1", 1.0,
                  "\"cost depends on pixels, not polygons\": 1 within 1 %, so in whole percents")},
           fill_sizes}};
}

}  // namespace dendro::study
