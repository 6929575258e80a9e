#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

/// Everything that a hull takes of the array besides its planes.
double besides_ms(const stats::RunObject& run) { return array_ms(run) - planes_ms(run); }

/// 8 planes more a tree, at the measured time of its 12.
double with_trunks_ms(const stats::RunObject& run) { return planes_ms(run) * 20 / 12; }

/// "About 60" is read as 55 to 65.
const char* about(const TableRow& row) {
  const double low = kPublishedClocks - 5, high = kPublishedClocks + 5;
  if (*row.simulated >= low && *row.simulated <= high) return "\"about 60\" (55 to 65) HOLDS";
  if (*row.low <= high && *row.high >= low) return "\"about 60\" (55 to 65) holds for part of the ranges only";
  return "\"about 60\" (55 to 65) does not hold";
}

const char* in_a_frame(const TableRow& row) {
  return *row.high <= kFrameMs  ? "fits 1/60 s over all ranges"
         : *row.low <= kFrameMs ? "fits 1/60 s for part of the ranges"
                                : "does not fit 1/60 s";
}

/// Two-stream and scratch-copy variants, each at four widths of the depth.
struct Variant {
  bool scratch;
  int bits;

  int memory() const { return (scratch ? 4 : 3) * bits + 24; }
  std::string name() const { return fmt::format("{} bits, {}", bits, scratch ? "scratch copy" : "two streams"); }
  std::vector<std::string> settings() const {
    std::vector<std::string> settings{fmt::format("half_space.depth_bits={}", bits)};
    if (memory() > kMemoryBits) settings.push_back(fmt::format("parameters.array.memory_bits={}", memory()));
    if (scratch) {
      settings.push_back("parameters.array.ports=2");
      settings.push_back("half_space.variant=scratch");
    }
    return settings;
  }
};

constexpr Variant kVariants[] = {{false, 12}, {false, 16}, {false, 20}, {false, 24},
                                 {true, 12},  {true, 16},  {true, 20},  {true, 24}};
constexpr std::size_t kShipped = 1;  ///< what the firmware does unless a scene says otherwise

/// The shipped variant comes first, the others behind it in their order.
std::string id_of(const char* claim, char first, std::size_t variant) {
  const std::size_t place = variant == kShipped ? 0 : variant < kShipped ? variant + 1 : variant;
  return fmt::format("FG86-{}{}", claim, static_cast<char>(first + static_cast<char>(place)));
}

SceneRun planes_run(const std::string& scene, std::vector<std::string> settings) {
  return {scene, std::move(settings), "", {}, kMachine};
}

void fill_variant(const Variant& v, const TableContext& context, std::vector<TableRow>& rows) {
  const std::vector<Metric> metrics = {
      {"clocks", clocks_per_plane}, {"planes", planes_ms}, {"array", array_ms}, {"trunks", with_trunks_ms}};
  const Propagated p = propagate_scene(context, planes_run("grove", v.settings()), metrics, "FG86 Pixel-Planes");
  for (std::size_t i = 0; i < rows.size(); ++i) set_metric(rows[i], p, metrics, i);
  const double least = v.scratch ? 2.0 * v.bits + 15 : 2.0 * v.bits + 27;
  rows[0].note = fmt::format("{}; {} bits a pixel{}; with 2 guard bits and nothing stolen {:g} clocks", about(rows[0]), v.memory(),
                             v.memory() > kMemoryBits ? ", more than the machine's 72" : "", least);
  if (v.scratch) rows[0].note += "; needs two memory ports, more than is assumed";
  rows[1].note = fmt::format("{}; {:g} clocks, without anything a hull takes besides", in_a_frame(rows[1]),
                             phase_cycles(p.nominal, "scan_planes"));
  const double hull_clocks = besides_ms(p.nominal) * 1e-3 * p.nominal.clock_hz / fact(p.nominal, "hulls.visible");
  rows[2].note = fmt::format("{}; clearing {:g}, nearest depth {:g}, colours {:g} clocks: {:.0f} a hull, {:.0f} % of what its planes "
                             "take, which 14 ms leave out",
                             in_a_frame(rows[2]), phase_cycles(p.nominal, "clear"), phase_cycles(p.nominal, "finish"),
                             phase_cycles(p.nominal, "colour"), hull_clocks, 100 * besides_ms(p.nominal) / planes_ms(p.nominal));
  rows[3].note = in_a_frame(rows[3]);
}

RowGroup variant_group(std::size_t index) {
  const Variant v = kVariants[index];
  RowGroup group;
  group.plan = fmt::format("the grove on Pixel-Planes over every assumption, {}", v.name());
  group.rows = {claim(id_of("A22", 'a', index), "clocks of a plane, " + v.name(), "1", kPublishedClocks,
                      "\"about 60 clocks\"; mean of the grove's planes, with 10 fraction bits and as many guard bits as each "
                      "needs, and the clocks that refresh and video take meanwhile"),
                claim(id_of("A23", 'a', index), "planes of 200 trees, " + v.name(), "ms", 14.0,
                      "printed 14 ms; 200 x 12 x 6 us are 14.4"),
                claim(id_of("A23", 'i', index), "all that hulls take, " + v.name(), "ms", kFrameMs,
                      "planes, clearing, nearest depth and colours; against a frame of 1/60 s, into which the 14 ms are to fit"),
                claim(id_of("A25", 'a', index), "planes with trunks, " + v.name(), "ms", kFrameMs,
                      "8 planes more for a trunk, \"not large\": against 1/60 s, 20 planes a tree at the measured time of 12")};
  group.fill = [v](const TableContext& context, std::vector<TableRow>& rows) { fill_variant(v, context, rows); };
  return group;
}

void fill_grove(const TableContext& context, std::vector<TableRow>& rows) {
  const std::vector<Metric> metrics = {
      {"plane", [](const stats::RunObject& r) { return clocks_per_plane(r) / r.clock_hz * 1e6; }}, {"frame", frame_ms}};
  const Propagated p = propagate_scene(context, planes_run("grove", {}), metrics, "FG86 Pixel-Planes");
  for (std::size_t i = 0; i < rows.size(); ++i) set_metric(rows[i], p, metrics, i);
  rows[1].note = fmt::format("{:g} operations a plane at an assumed rate", fact(p.nominal, "host.flops_per_plane"));
}

RowGroup grove_group() {
  return {"the grove on Pixel-Planes, nominal and over every assumption",
          {claim("FG86-A22i", "one plane on Pixel-Planes", "us", 6.0, "mean of the grove's planes, two streams, 16 bits of depth"),
           claim("FG86-A23q", "with the front end's transformation, 16 bits", "ms", kFrameMs,
                 "planes and all that hulls take, without splitting normals (A21) and loading; against 1/60 s")},
          fill_grove};
}

stats::RunObject nominal(const TableContext& context, const SceneRun& run) {
  const RunMaker make = worker_runs(context.options.jobs, context.progress, "FG86 Pixel-Planes", &context.cache);
  return from_bytes(make({request_of(context, run)}).front().value()).object;
}

/// Words sent for hulls at their size and at a tenth of it.
double size_ratio(const TableContext& context, const Variant& v, bool same_guard) {
  const auto words = [&](const char* more) {
    std::vector<std::string> settings = v.settings();
    if (same_guard) settings.push_back("half_space.guard_bits=14");
    if (*more != 0) settings.push_back(more);
    return static_cast<double>(nominal(context, planes_run("figure5", std::move(settings))).instructions);
  };
  return words("") / words("camera.height=36");
}

void fill_size(const TableContext& context, std::vector<TableRow>& rows) {
  double low = INFINITY, high = -INFINITY, least = INFINITY, most = -INFINITY;
  for (const Variant& v : kVariants) {
    const double same = size_ratio(context, v, true), chosen = size_ratio(context, v, false);
    low = std::min(low, same), high = std::max(high, same);
    least = std::min(least, chosen), most = std::max(most, chosen);
  }
  set_range(rows[0], size_ratio(context, kVariants[1], true), low, high);
  rows[0].note = fmt::format("all variants and widths; with guard bits chosen by plane {:.3f} to {:.3f}: the small ones' planes are "
                             "steeper over the array", least, most);
}

void fill_order(const TableContext& context, std::vector<TableRow>& rows) {
  const std::vector<Metric> metrics = {{"picture", machine_seconds}};
  const Propagated slow = propagate_scene(context, {"icosahedron", {}, "", {}}, metrics, "FG86 icosahedron");
  const double seconds = machine_seconds(nominal(context, planes_run("icosahedron", {})));
  double least = seconds, most = seconds;
  for (const Variant& v : kVariants) {
    const double one = machine_seconds(nominal(context, planes_run("icosahedron", v.settings())));
    least = std::min(least, one), most = std::max(most, one);
  }
  set_metric(rows[0], slow, metrics, 0);
  rows[0].note = fmt::format("{:.3g} s and {:.3g} s of the array, 16 planes and four edges; interval of the former, and of the latter "
                             "over all variants and widths ({:.3g} to {:.3g} s)",
                             *rows[0].simulated, seconds, least, most);
  *rows[0].simulated /= seconds, *rows[0].low /= most, *rows[0].high /= least;
  for (stats::Contribution& width : rows[0].widened_by) width.low /= seconds, width.high /= seconds;
}

}  // namespace

std::vector<RowGroup> fg86_planes_groups() {
  std::vector<RowGroup> groups;
  for (std::size_t v = 0; v < std::size(kVariants); ++v) groups.push_back(variant_group(v));
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
