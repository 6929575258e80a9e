#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "models/parts/bps32/bps32_isa.h"
#include "sim/base/check.h"
#include "sim/base/error.h"
#include "sim/study/exec.h"
#include "sim/study/table.h"
#include "sim/study/table_fg86_hulls.h"
#include "sim/study/table_fg86_planes.h"

namespace dendro::study {
namespace {

constexpr double kBoxPixels = 512.0 * 512.0;
constexpr int kSamples = 200;

bool starts_with(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

double machine_seconds(const stats::RunObject& run) {
  double seconds = 0;
  for (const stats::PhaseRow& p : run.phases) seconds += p.on_host ? 0 : p.seconds;
  return seconds;
}

double phase_seconds(const stats::RunObject& run, const std::string& name) {
  double seconds = 0;
  for (const stats::PhaseRow& p : run.phases) seconds += p.name == name ? p.seconds : 0;
  return seconds;
}

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

/// A scene's nominal run and what the assumptions make of it.
struct Propagated {
  RunRequest request;
  stats::RunObject nominal;
  std::vector<Interval> intervals;
};

RunRequest timed_request(const TableContext& context, const std::vector<std::string>& settings) {
  RunArguments arguments;
  arguments.scene = "icosahedron";
  arguments.level = context.options.level;
  arguments.settings = settings_for(context, "rds3000");
  arguments.settings.insert(arguments.settings.end(), settings.begin(), settings.end());
  RunRequest request = prepare_run(context.catalogue, arguments);
  if (request.level == Level::kFunction)
    throw UserError("--level", 0, "", "a table of times needs a level with time: cycle or clocked");
  return request;
}

Propagated propagate_scene(const TableContext& context, const std::vector<std::string>& settings,
                           const std::vector<Metric>& metrics, const std::string& name) {
  Propagated p;
  p.request = timed_request(context, settings);
  const RunMaker make = worker_runs(context.options.jobs, context.progress, name, &context.cache);
  p.nominal = from_bytes(make({p.request}).front().value()).object;
  p.intervals = propagate(p.request, p.nominal, metrics, make, context.options.full ? kSamples : 0);
  return p;
}

TableRow time_row(const std::string& id, const std::string& what, const std::string& unit, double published,
                  const Metric& metric, const Propagated& p, const Interval& interval) {
  TableRow row;
  row.id = id;
  row.paper = "FG86";
  row.what = what;
  row.unit = unit;
  row.published = published;
  row.simulated = metric.of(p.nominal);
  set_interval(row, interval, p.request.preset.parameters);
  return row;
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

std::vector<TableRow> plane_rows(const TableContext& context, const Propagated& boxed) {
  const std::vector<Metric> metrics = {
      {"plane", mean_plane_seconds},
      {"pixel", [](const stats::RunObject& run) { return mean_plane_seconds(run) / kBoxPixels * 1e6; }}};
  const Propagated p = propagate_scene(context, {"half_space.boxing=false"}, metrics, "FG86 planes");
  const double clock = p.nominal.clock_hz;
  const std::size_t planes = plane_seconds(p.nominal).size();

  TableRow plane =
      time_row("FG86-A7b", "one plane over the whole 512x512 box", "s", 0.75, metrics[0], p, p.intervals[0]);
  plane.reading =
      fmt::format("0.7 to 0.8 s, its middle shown; mean of {} scanned planes with boxing off", planes);
  plane.note =
      ticks_note(plane, clock, 1 / kBoxPixels) +
      fmt::format("; the first plane of the boxed run takes {:.3f} s", plane_seconds(boxed.nominal).front());

  TableRow pixel = time_row("FG86-A7c", "one plane at one pixel", "us", 0.75 / kBoxPixels * 1e6, metrics[1],
                            p, p.intervals[1]);
  pixel.reading =
      "FG86-K8: not the printed 50 us (all planes of a pixel) but 12 s / (20 x 512^2) = 2.3 to 0.8 s / "
      "512^2 = 3.1 us; 0.75 s / 512^2 shown";
  pixel.note = fmt::format("all planes of a pixel: {:.1f} us", machine_seconds(p.nominal) / kBoxPixels * 1e6);
  return {plane, pixel};
}

TableRow picture_row(const Propagated& p, const Metric& metric, const Interval& interval) {
  TableRow row =
      time_row("FG86-A7a", "icosahedron in a 512x512 box, whole picture", "s", 12.0, metric, p, interval);
  row.reading = "FG86-K9: seen along a two-fold axis, 16 planes scanned; passes 0 to 4, without loading";
  double scanned = 0, edge_on = 0;
  for (const auto& [name, value] : p.nominal.facts) {
    if (name == "planes.front" || name == "planes.back") scanned += value;
    if (name == "planes.edge_on") edge_on += value;
  }
  row.note = fmt::format("{:g} planes scanned and {:g} edge-on; ", scanned, edge_on);
  for (const stats::PhaseRow& phase : p.nominal.phases)
    if (!phase.on_host && phase.seconds >= 0.005)
      row.note += fmt::format("{} {:.2f} s, ", phase.name, phase.seconds);
  row.note += fmt::format("{:.1f} us a pixel of the box", *row.simulated / kBoxPixels * 1e6);
  if (!row.inside()) {
    const bool slow = *row.low > *row.published;
    row.note +=
        fmt::format("; {} even at the {} corner: the box would have to shrink {} than it does",
                    slow ? "slower" : "faster", slow ? "fastest" : "slowest", slow ? "sooner" : "later");
  }
  return row;
}

TableRow load_row(const Propagated& p, const Metric& metric, const Interval& interval) {
  TableRow row = time_row("FG86-A10", "load of one separate program", "s", 4.5, metric, p, interval);
  row.reading = "\"several seconds\": 2 to 7 s, the middle shown";
  row.note =
      "says little: the host software's time is assumed from the same sentence (DEV-028); the transfer "
      "itself "
      "is modelled";
  return row;
}

/// 16x16 multiplication: from the word that starts it to the first that could take the product.
TableRow multiply_row(const TableContext& context) {
  ExecArguments arguments;
  arguments.machine = "rds3000";
  arguments.program = "multiply.gia";
  arguments.text =
      "reg t = r0;\nentry start;\nstart:\n  t = 3;\n  mul_x = t;\n  mul_y = t;\nmark_begin:\n  mul signed;\n"
      "  if (product_ready) goto mark_end;\n  if (product_ready) goto mark_end;\n  if (product_ready) goto "
      "mark_end;\n"
      "  if (product_ready) goto mark_end;\n  if (product_ready) goto mark_end;\n  if (product_ready) goto "
      "mark_end;\n"
      "mark_end:\n  halt;\n";
  arguments.level = context.options.level;
  // A taken branch would be counted with the product it waited for.
  arguments.settings = {"processor.taken_branch_ticks=0"};
  const ExecOutput output = exec_program(context.catalogue, arguments, nullptr);
  const auto& marks = output.object.marks;
  DENDRO_CHECK(marks.size() == 2, "{} marks", marks.size());
  const double ticks = static_cast<double>(marks[1].second - marks[0].second - 1);
  TableRow row;
  row.id = "FG86-A3";
  row.paper = "FG86";
  row.what = "signed 16x16 multiplication, 2 cycles of 200 ns";
  row.unit = "ns";
  row.published = 400;
  row.simulated = ticks / output.object.clock_hz * 1e9;
  row.low = row.high = row.simulated;
  row.note = fmt::format(
      "{:g} ticks of {:g} ns, measured by a microprogram; both are documented inputs of the model", ticks,
      1e9 / output.object.clock_hz);
  return row;
}

/// Words between a depth_step label and the next label that add a register onto another in place, the pixel
/// address aside: the additions that a pixel's depth costs.
std::set<std::uint32_t> depth_additions(const tools::Ucode& program) {
  using namespace bps32;
  std::set<std::uint32_t> counted;
  for (const auto& [name, start] : program.symbols) {
    if (!starts_with(name, "depth_step")) continue;
    std::uint32_t end = static_cast<std::uint32_t>(program.words.size());
    for (const auto& [other, at] : program.symbols)
      if (at > start) end = std::min(end, at);
    for (std::uint32_t at = start; at < end; ++at) {
      const std::uint64_t word = program.words[at];
      const bool adds =
          get(word, kFunc) == kRPlusS && get(word, kI0) == 0 && get(word, kOeb) == 0 && get(word, kEa) == 0;
      const unsigned dest = get(word, kDest);
      const bool in_place = dest == kRam || dest == kRamAlso;
      if (adds && in_place && get(word, kYdst) != kYBusX) counted.insert(at);
    }
  }
  return counted;
}

double additions_per_visit(const TableContext& context, const std::string& pack) {
  RunArguments arguments;
  arguments.scene = "icosahedron";
  arguments.level = "function";
  arguments.settings = settings_for(context, "rds3000");
  arguments.settings.push_back("parameters.microcode.pack=\"" + pack + "\"");
  RunRequest request = prepare_run(context.catalogue, arguments);
  const tools::Ucode program = half_space_program(request.preset.parameters);
  const std::set<std::uint32_t> additions = depth_additions(program);
  std::set<std::uint32_t> loops;
  for (const auto& [name, at] : program.symbols)
    if (starts_with(name, "depth_step")) loops.insert(at);
  for (const std::set<std::uint32_t>& words : {additions, loops})
    for (const std::uint32_t at : words) request.options.counted[at] = std::to_string(at);
  const stats::RunObject run = execute_in_worker(request, "", nullptr).object;
  double added = 0, visits = 0;
  for (const auto& [name, count] : run.executions) {
    const auto at = static_cast<std::uint32_t>(std::stoul(name));
    if (additions.count(at)) added += static_cast<double>(count);
    if (loops.count(at)) visits += static_cast<double>(count);
  }
  DENDRO_CHECK(visits > 0, "no pixel was visited");
  return added / visits;
}

TableRow addition_row(const TableContext& context) {
  TableRow row;
  row.id = "FG86-A17";
  row.paper = "FG86";
  row.what = "additions for the depth of one pixel";
  row.unit = "1";
  row.published = 1;
  const double none = additions_per_visit(context, "none"), full = additions_per_visit(context, "full");
  row.simulated = none;
  row.low = std::min(none, full);
  row.high = std::max(none, full);
  row.note = "executions of the microwords that add to a depth, per pixel visited with a depth";
  return row;
}

std::vector<TableRow> make(const TableContext& context) {
  const std::vector<Metric> metrics = {
      {"picture", machine_seconds},
      {"load", [](const stats::RunObject& run) { return phase_seconds(run, "load_program"); }}};
  const Propagated boxed = propagate_scene(context, {}, metrics, "FG86 icosahedron");
  std::vector<TableRow> rows = {multiply_row(context), picture_row(boxed, metrics[0], boxed.intervals[0])};
  for (TableRow& row : plane_rows(context, boxed)) rows.push_back(std::move(row));
  rows.push_back(load_row(boxed, metrics[1], boxed.intervals[1]));
  rows.push_back(addition_row(context));
  for (TableRow& row : fg86_hull_rows(context)) rows.push_back(std::move(row));
  const TableRow picture = rows[1];
  for (TableRow& row : fg86_planes_rows(context, picture)) rows.push_back(std::move(row));
  return rows;
}

}  // namespace

PaperTable fg86_table() {
  return {"FG86",
          {"FG86-A7a, A10: the icosahedron, nominal and over every assumption",
           "FG86-A7b, c: the same without boxing, so that every plane scans the whole box",
           "FG86-A3: a microprogram that waits for a product",
           "FG86-A17: the icosahedron at level function, microcode packed and not",
           "FG86-A12, A18, A20: trees grown with 3 to 8 start normals, their splits counted",
           "FG86-A33, A34: shipped scenes at level function, their pixel visits and merges",
           "FG86-A22, A23, A25: Figure 5 and the grove on Pixel-Planes, every variant and over every assumption",
           "FG86-A24, A38: Figure 5 at two sizes on Pixel-Planes; the icosahedron there"},
          make,
          [](const TableContext& context) { check_run(timed_request(context, {})); }};
}

}  // namespace dendro::study
