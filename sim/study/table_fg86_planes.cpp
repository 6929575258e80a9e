#include <fmt/format.h>

#include <algorithm>

#include "sim/study/table_fg86.h"

namespace dendro::study {
namespace {

constexpr const char* kMachine = "pixel-planes";
constexpr double kPublishedClocks = 60, kFrameMs = 1000.0 / 60;
constexpr int kMemoryBits = 72;

double phase_cycles(const stats::RunObject& run, const std::string& name) {
  double cycles = 0;
  for (const stats::PhaseRow& p : run.phases) cycles += p.name == name && !p.on_host ? static_cast<double>(p.cycles) : 0;
  return cycles;
}

double array_ms(const stats::RunObject& run) {
  double seconds = 0;
  for (const stats::PhaseRow& p : run.phases) seconds += p.on_host ? 0 : p.seconds;
  return seconds * 1e3;
}

double planes_ms(const stats::RunObject& run) { return phase_cycles(run, "scan_planes") / run.clock_hz * 1e3; }

/// Everything from the first plane on: the planes are transformed again for each frame, trees and programs are not.
double frame_ms(const stats::RunObject& run) {
  double seconds = 0;
  for (const stats::PhaseRow& p : run.phases)
    seconds += p.name == "load_program" || p.name == "grow" ? 0 : p.seconds;
  return seconds * 1e3;
}

double clocks_per_plane(const stats::RunObject& run) {
  return phase_cycles(run, "scan_planes") / (fact(run, "planes.back") + fact(run, "planes.front") + fact(run, "planes.edge_on"));
}

/// "About 60" is read as 55 to 65.
const char* about(const TableRow& row) {
  const double low = kPublishedClocks - 5, high = kPublishedClocks + 5;
  if (*row.simulated >= low && *row.simulated <= high) return "\"about 60\" (55 to 65) holds";
  if (*row.low <= high && *row.high >= low) return "\"about 60\" (55 to 65) holds for part of the ranges";
  return "\"about 60\" (55 to 65) does not hold";
}

/// Two-stream and scratch-copy variants, each at four widths of the depth.
struct Variant {
  const char* letter;
  bool scratch;
  int bits;
  int memory() const { return (scratch ? 4 : 3) * bits + 24; }
};

constexpr Variant kVariants[] = {{"a", false, 12}, {"b", false, 16}, {"c", false, 20}, {"d", false, 24},
                                 {"e", true, 12},  {"f", true, 16},  {"g", true, 20},  {"h", true, 24}};

SceneRun planes_run(const std::string& scene, std::vector<std::string> settings) {
  return {scene, std::move(settings), "", {}, kMachine};
}

RowGroup variant_group(const Variant& v) {
  const std::string what = fmt::format("clocks of a plane, {} bits of depth, {}", v.bits, v.scratch ? "scratch copy" : "two streams");
  RowGroup group;
  group.plan = fmt::format("Figure 5 on Pixel-Planes over every assumption, {} bits, {}", v.bits, v.scratch ? "scratch copy" : "two streams");
  group.rows = {claim(std::string("FG86-A22") + v.letter, what, "1", kPublishedClocks,
                      "\"about 60 clocks\"; mean of 34 planes of 10 fraction bits and as many guard bits as each needs, with the "
                      "clocks that refresh and video take meanwhile")};
  group.fill = [v](const TableContext& context, std::vector<TableRow>& rows) {
    std::vector<std::string> settings{fmt::format("half_space.depth_bits={}", v.bits)};
    if (v.memory() > kMemoryBits) settings.push_back(fmt::format("parameters.array.memory_bits={}", v.memory()));
    if (v.scratch) {
      settings.push_back("parameters.array.ports=2");
      settings.push_back("half_space.variant=scratch");
    }
    const std::vector<Metric> metrics = {{"clocks", clocks_per_plane}};
    set_metric(rows[0], propagate_scene(context, planes_run("figure5", settings), metrics, "FG86 Pixel-Planes"), metrics, 0);
    const double least = v.scratch ? 2.0 * v.bits + 15 : 2.0 * v.bits + 27;
    rows[0].note = fmt::format("{} bits a pixel{}; with 2 guard bits {:g} clocks; {}", v.memory(),
                               v.memory() > kMemoryBits ? ", more than the machine's 72" : "", least, about(rows[0]));
    if (v.scratch) rows[0].note += "; needs two memory ports, more than is assumed";
  };
  return group;
}

void fill_grove(const TableContext& context, std::vector<TableRow>& rows) {
  const std::vector<Metric> metrics = {
      {"plane", [](const stats::RunObject& r) { return clocks_per_plane(r) / r.clock_hz * 1e6; }},
      {"planes", planes_ms},
      {"array", array_ms},
      {"frame", frame_ms},
      {"trunks", [](const stats::RunObject& r) { return planes_ms(r) * 20 / 12; }}};
  const Propagated p = propagate_scene(context, planes_run("grove", {}), metrics, "FG86 Pixel-Planes");
  for (std::size_t i = 0; i < rows.size(); ++i) set_metric(rows[i], p, metrics, i);
  const double planes = fact(p.nominal, "planes.back") + fact(p.nominal, "planes.front") + fact(p.nominal, "planes.edge_on");
  rows[1].note = fmt::format("{:g} planes, {:g} clocks; without anything a hull takes besides", planes,
                             phase_cycles(p.nominal, "scan_planes"));
  rows[2].note = fmt::format("clearing {:g}, nearest depth {:g}, colours {:g} clocks: what 14 ms leave out",
                             phase_cycles(p.nominal, "clear"), phase_cycles(p.nominal, "finish"), phase_cycles(p.nominal, "colour"));
  rows[3].note = fmt::format("{:g} operations a plane at an assumed rate", fact(p.nominal, "host.flops_per_plane"));
  rows[4].note = "breaks 60 pictures a second even without what a hull takes besides its planes";
}

RowGroup grove_group() {
  return {"the grove on Pixel-Planes, nominal and over every assumption",
          {claim("FG86-A22i", "one plane on Pixel-Planes", "us", 6.0, "mean of the grove's planes, two streams, 16 bits of depth"),
           claim("FG86-A23a", "planes of 200 trees of 12 planes", "ms", 14.0, "printed 14 ms; 200 x 12 x 6 us are 14.4"),
           claim("FG86-A23b", "the same with clearing, nearest depth and colours", "ms", kFrameMs,
                 "against a frame of 1/60 s, into which the paper's 14 ms are to fit"),
           claim("FG86-A23c", "the same with the front end's transformation of the planes", "ms", kFrameMs,
                 "without splitting normals (A21) and loading; against 1/60 s"),
           claim("FG86-A25", "planes of 200 trees with 8 more for a trunk", "ms", kFrameMs,
                 "\"not large\": against 1/60 s, 20 planes a tree at the measured time of 12")},
          fill_grove};
}

stats::RunObject nominal(const TableContext& context, const SceneRun& run) {
  const RunMaker make = worker_runs(context.options.jobs, context.progress, "FG86 Pixel-Planes", &context.cache);
  return from_bytes(make({request_of(context, run)}).front().value()).object;
}

void fill_size(const TableContext& context, std::vector<TableRow>& rows) {
  const auto words = [&](std::vector<std::string> settings) {
    return static_cast<double>(nominal(context, planes_run("figure5", std::move(settings))).instructions);
  };
  const std::string guard = "half_space.guard_bits=14", far = "camera.height=36";
  set_single(rows[0], words({guard}) / words({far, guard}));
  rows[0].note = fmt::format("with guard bits chosen by plane {:.3f}: the small ones' planes are steeper over the array",
                             words({}) / words({far}));
}

void fill_order(const TableContext& context, std::vector<TableRow>& rows) {
  const std::vector<Metric> metrics = {{"picture", machine_seconds}};
  const Propagated slow = propagate_scene(context, {"icosahedron", {}, "", {}}, metrics, "FG86 icosahedron");
  const double seconds = machine_seconds(nominal(context, planes_run("icosahedron", {})));
  set_metric(rows[0], slow, metrics, 0);
  rows[0].note = fmt::format("{:.3g} s and {:.3g} s of the array, 16 planes and four edges; interval of the former",
                             *rows[0].simulated, seconds);
  for (auto* figure : {&rows[0].simulated, &rows[0].low, &rows[0].high}) *figure = **figure / seconds;
  for (stats::Contribution& width : rows[0].widened_by) width.low /= seconds, width.high /= seconds;
}

}  // namespace

std::vector<RowGroup> fg86_planes_groups() {
  std::vector<RowGroup> groups;
  for (const Variant& v : kVariants) groups.push_back(variant_group(v));
  groups.push_back(grove_group());
  groups.push_back({"Figure 5 at two sizes on Pixel-Planes",
                    {claim("FG86-A24", "time of hulls ten times as large, times that of small ones", "1", 1.0,
                           "control words sent for Figure 5 as it is and at a tenth of its size, with the same 14 guard bits")},
                    fill_size});
  groups.push_back({"the icosahedron on both machines",
                    {claim("FG86-A38b", "icosahedron on the RDS-3000, times that on Pixel-Planes", "1")},
                    fill_order});
  return groups;
}

}  // namespace dendro::study
