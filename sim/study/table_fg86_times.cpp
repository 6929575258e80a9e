#include <fmt/format.h>

#include "sim/base/check.h"
#include "sim/study/table_fg86.h"

namespace dendro::study {
namespace {

constexpr double kBoxPixels = 512.0 * 512.0;
constexpr double kFrameSeconds = 1.0 / 60;  ///< "real time" in FG86 6.3

/// Seconds of each back and front plane, from its mark to the next mark.
std::vector<double> plane_seconds(const stats::RunObject& run) {
  std::vector<double> seconds;
  for (std::size_t i = 0; i + 1 < run.marks.size(); ++i) {
    const auto& [name, tick] = run.marks[i];
    if (name == "mark_plane_back" || name == "mark_plane_front")
      seconds.push_back(static_cast<double>(run.marks[i + 1].second - tick) / run.clock_hz);
  }
  DENDRO_CHECK(!seconds.empty(), "no plane was marked");
  return seconds;
}

double mean_plane_seconds(const stats::RunObject& run) {
  const std::vector<double> all = plane_seconds(run);
  double sum = 0;
  for (const double s : all) sum += s;
  return sum / static_cast<double>(all.size());
}

/// What the assumed hardware would have to be for the published time, in ticks a pixel and plane.
std::string ticks_note(const TableRow& row, double ticks, double scale) {
  const double simulated = *row.simulated * scale, published = *row.published * scale;
  std::string text =
      fmt::format("{:.1f} ticks a pixel and plane ({:.1f} to {:.1f}), the paper {:.1f}", simulated * ticks,
                  *row.low * scale * ticks, *row.high * scale * ticks, published * ticks);
  if (row.inside()) return text;
  if (*row.low > *row.published)
    return text +
           fmt::format(
               "; the loop would need {:.1f} ticks less than at best: fewer microinstructions a pixel, or "
               "a read shorter than assumed",
               (*row.low - *row.published) * scale * ticks);
  return text +
         fmt::format(
             "; the loop would need {:.1f} ticks more than at worst: looser microcode, or a read longer "
             "than assumed",
             (*row.published - *row.high) * scale * ticks);
}

void fill_planes(const TableContext& context, std::vector<TableRow>& rows) {
  const std::vector<Metric> metrics = {
      {"plane", mean_plane_seconds},
      {"pixel", [](const stats::RunObject& run) { return mean_plane_seconds(run) / kBoxPixels * 1e6; }}};
  const Propagated p =
      propagate_scene(context, {"icosahedron", {"half_space.boxing=false"}, "", {}}, metrics, "FG86 planes");
  for (std::size_t i = 0; i < metrics.size(); ++i) set_metric(rows[i], p, metrics, i);
  rows[0].note = fmt::format("mean of {} scanned planes; ", plane_seconds(p.nominal).size()) +
                 ticks_note(rows[0], p.nominal.clock_hz, 1 / kBoxPixels);
  rows[1].note =
      fmt::format("all planes of a pixel: {:.1f} us", machine_seconds(p.nominal) / kBoxPixels * 1e6);
}

void note_picture(TableRow& row, const stats::RunObject& run) {
  const double scanned = fact(run, "planes.front") + fact(run, "planes.back");
  row.note = fmt::format("{:g} planes scanned and {:g} edge-on; ", scanned, fact(run, "planes.edge_on"));
  for (const stats::PhaseRow& phase : run.phases)
    if (!phase.on_host && phase.seconds >= 0.005)
      row.note += fmt::format("{} {:.2f} s, ", phase.name, phase.seconds);
  row.note += fmt::format("{:.1f} us a pixel of the box; the first plane {:.3f} s",
                          *row.simulated / kBoxPixels * 1e6, plane_seconds(run).front());
  if (row.inside()) return;
  const bool slow = *row.low > *row.published;
  row.note +=
      fmt::format("; {} even at the {} corner: the box would have to shrink {} than it does",
                  slow ? "slower" : "faster", slow ? "fastest" : "slowest", slow ? "sooner" : "later");
}

void fill_picture(const TableContext& context, std::vector<TableRow>& rows) {
  const std::vector<Metric> metrics = {
      {"picture", machine_seconds},
      {"load", [](const stats::RunObject& run) { return phase_seconds(run, "load_program"); }},
      {"frames", [](const stats::RunObject& run) { return machine_seconds(run) / kFrameSeconds; }}};
  const Propagated p = propagate_scene(context, {"icosahedron", {}, "", {}}, metrics, "FG86 icosahedron");
  for (std::size_t i = 0; i < metrics.size(); ++i) set_metric(rows[i], p, metrics, i);
  note_picture(rows[0], p.nominal);
  rows[1].note =
      "says little: the host software's time is assumed from the same sentence (DEV-028); the transfer "
      "itself is modelled";
  rows[2].note = "A7a in frames of 1/60 s: the same runs; 200 such trees would be 200 times as far";
}

}  // namespace

std::vector<RowGroup> fg86_time_groups() {
  return {
      {"the icosahedron, nominal and over every assumption",
       {claim("FG86-A7a", "icosahedron in a 512x512 box, whole picture", "s", 12.0,
              "FG86-K9: seen along a two-fold axis, 16 planes scanned; passes 0 to 4, without loading"),
        claim("FG86-A10", "load of one separate program", "s", 4.5,
              "\"several seconds\": 2 to 7 s, the middle shown"),
        claim("FG86-A38a", "the icosahedron's distance from real time", "1", 720.0,
              "\"several orders of magnitude\": 12 s against a frame of 1/60 s")},
       fill_picture},
      {"the same without boxing, so that every plane scans the whole box",
       {claim("FG86-A7b", "one plane over the whole 512x512 box", "s", 0.75,
              "0.7 to 0.8 s, its middle shown; boxing off"),
        claim(
            "FG86-A7c", "one plane at one pixel", "us", 0.75 / kBoxPixels * 1e6,
            "FG86-K8: not the printed 50 us (all planes of a pixel) but 12 s / (20 x 512^2) = 2.3 to 0.8 s / "
            "512^2 = 3.1 us; 0.75 s / 512^2 shown")},
       fill_planes}};
}

}  // namespace dendro::study
