#include "sim/study/table_fg86_planes.h"

#include <fmt/format.h>

#include <algorithm>

#include "sim/base/check.h"

namespace dendro::study {
namespace {

constexpr const char* kMachine = "pixel-planes";
constexpr double kPublishedClocks = 60, kFrameMs = 1000.0 / 60;
constexpr int kSamples = 200;
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

double fact(const stats::RunObject& run, const std::string& name) {
  for (const auto& [key, value] : run.facts)
    if (key == name) return value;
  DENDRO_CHECK(false, "{} is not reported", name);
  return 0;
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

class Rows {
 public:
  Rows(const TableContext& context, const TableRow& picture)
      : context_(context), picture_(picture), settings_(settings_for(context, kMachine)) {}

  std::vector<TableRow> make() {
    plane_rows();
    grove_rows();
    size_row();
    order_rows();
    return std::move(rows_);
  }

 private:
  RunRequest request(const std::string& scene, const std::vector<std::string>& settings) const {
    RunArguments arguments;
    arguments.scene = scene;
    arguments.machine = kMachine;
    arguments.level = context_.options.level;
    arguments.settings = settings_;
    arguments.settings.insert(arguments.settings.end(), settings.begin(), settings.end());
    return prepare_run(context_.catalogue, arguments);
  }

  stats::RunObject run(const RunRequest& r) const {
    const RunMaker make = worker_runs(context_.options.jobs, context_.progress, "FG86 Pixel-Planes", &context_.cache);
    return from_bytes(make({r}).front().value()).object;
  }

  struct Spread {
    RunRequest request;
    stats::RunObject nominal;
    std::vector<Interval> intervals;
  };

  Spread spread(const std::string& scene, const std::vector<std::string>& settings, const std::vector<Metric>& metrics) const {
    Spread s;
    s.request = request(scene, settings);
    const RunMaker make = worker_runs(context_.options.jobs, context_.progress, "FG86 Pixel-Planes", &context_.cache);
    s.nominal = run(s.request);
    s.intervals = propagate(s.request, s.nominal, metrics, make, context_.options.full ? kSamples : 0);
    return s;
  }

  TableRow& add(const std::string& id, const std::string& what, const std::string& unit, std::optional<double> published) {
    TableRow row;
    row.id = id, row.paper = "FG86", row.what = what, row.unit = unit, row.published = published;
    rows_.push_back(std::move(row));
    return rows_.back();
  }

  TableRow& add(const std::string& id, const std::string& what, const std::string& unit, double published,
                const Metric& metric, const Spread& s, std::size_t number) {
    TableRow& row = add(id, what, unit, published);
    row.simulated = metric.of(s.nominal);
    set_interval(row, s.intervals[number], s.request.preset.parameters);
    return row;
  }

  /// A22: a plane in every variant and depth width, on Figure 5's 34 planes.
  void plane_rows() {
    char letter = 'a';
    for (const bool scratch : {false, true})
      for (const int bits : {12, 16, 20, 24}) {
        const int memory = (scratch ? 4 : 3) * bits + 24;
        std::vector<std::string> settings{fmt::format("half_space.depth_bits={}", bits)};
        if (memory > kMemoryBits) settings.push_back(fmt::format("parameters.array.memory_bits={}", memory));
        if (scratch) {
          settings.push_back("parameters.array.ports=2");
          settings.push_back("half_space.variant=scratch");
        }
        const Metric metric{"clocks", clocks_per_plane};
        const Spread s = spread("figure5", settings, {metric});
        TableRow& row = add(fmt::format("FG86-A22{}", letter++),
                            fmt::format("clocks of a plane, {} bits of depth, {}", bits, scratch ? "scratch copy" : "two streams"),
                            "1", kPublishedClocks, metric, s, 0);
        row.reading = "\"about 60 clocks\"; mean of 34 planes of 10 fraction bits and as many guard bits as each needs, "
                      "with the clocks that refresh and video take meanwhile";
        const double least = scratch ? 2.0 * bits + 15 : 2.0 * bits + 27;
        row.note = fmt::format("{:g} bits a pixel{}; with 2 guard bits {:g} clocks; {}", static_cast<double>(memory),
                               memory > kMemoryBits ? ", more than the machine's 72" : "", least,
                               about(row));
        if (scratch) row.note += "; needs two memory ports, more than is assumed";
      }
  }

  /// A22i, A23, A25: two hundred trees of twelve planes.
  void grove_rows() {
    const std::vector<Metric> metrics = {
        {"plane", [](const stats::RunObject& r) { return clocks_per_plane(r) / r.clock_hz * 1e6; }},
        {"planes", planes_ms},
        {"array", array_ms},
        {"frame", frame_ms},
        {"trunks", [](const stats::RunObject& r) { return planes_ms(r) * 20 / 12; }}};
    const Spread s = spread("grove", {}, metrics);
    const double planes = fact(s.nominal, "planes.back") + fact(s.nominal, "planes.front") + fact(s.nominal, "planes.edge_on");
    add("FG86-A22i", "one plane", "us", 6, metrics[0], s, 0).reading =
        fmt::format("mean of the grove's {:g} planes, two streams, 16 bits of depth", planes);
    TableRow& bare = add("FG86-A23a", "planes of 200 trees of 12 planes", "ms", 14, metrics[1], s, 1);
    bare.reading = "printed 14 ms; 200 x 12 x 6 us are 14.4";
    bare.note = fmt::format("{:g} planes, {:g} clocks; without anything a hull takes besides", planes,
                            phase_cycles(s.nominal, "scan_planes"));
    TableRow& array = add("FG86-A23b", "the same with clearing, nearest depth and colours", "ms", kFrameMs, metrics[2], s, 2);
    array.reading = "against a frame of 1/60 s, into which the paper's 14 ms are to fit";
    array.note = fmt::format("clearing {:g}, nearest depth {:g}, colours {:g} clocks: what 14 ms leave out",
                             phase_cycles(s.nominal, "clear"), phase_cycles(s.nominal, "finish"),
                             phase_cycles(s.nominal, "colour"));
    TableRow& frame = add("FG86-A23c", "the same with the front end's transformation of the planes", "ms", kFrameMs,
                          metrics[3], s, 3);
    frame.reading = "without splitting normals (A21) and loading; against 1/60 s";
    frame.note = fmt::format("{:g} operations a plane at an assumed rate", fact(s.nominal, "host.flops_per_plane"));
    TableRow& trunks = add("FG86-A25", "planes of 200 trees with 8 more for a trunk", "ms", kFrameMs, metrics[4], s, 4);
    trunks.reading = "\"not large\": against 1/60 s, 20 planes a tree at the measured time of 12";
    trunks.note = "breaks 60 pictures a second even without what a hull takes besides its planes";
  }

  void size_row() {
    TableRow& row = add("FG86-A24", "time of hulls ten times as large, times that of small ones", "1", 1);
    const stats::RunObject small = run(request("figure5", {"camera.height=36", "half_space.guard_bits=14"}));
    const stats::RunObject large = run(request("figure5", {"half_space.guard_bits=14"}));
    row.simulated = row.low = row.high = static_cast<double>(large.instructions) / static_cast<double>(small.instructions);
    row.reading = "control words sent for Figure 5 as it is and at a tenth of its size, with the same 14 guard bits";
    const double with_guard = static_cast<double>(run(request("figure5", {})).instructions) /
                              static_cast<double>(run(request("figure5", {"camera.height=36"})).instructions);
    row.note = fmt::format("with guard bits chosen by plane {:.3f}: the small ones' planes are steeper over the array",
                           with_guard);
  }

  void order_rows() {
    TableRow& slow = add("FG86-A38a", "icosahedron on the RDS-3000, in frames of 1/60 s", "1", 720);
    slow.simulated = *picture_.simulated * 60;
    slow.low = *picture_.low * 60, slow.high = *picture_.high * 60;
    slow.assumptions = picture_.assumptions;
    slow.reading = "\"several orders of magnitude\" from real time: 12 s";
    TableRow& fast = add("FG86-A38b", "icosahedron on the RDS-3000, times that on Pixel-Planes", "1", std::nullopt);
    const double seconds = array_ms(run(request("icosahedron", {}))) / 1e3;
    fast.simulated = *picture_.simulated / seconds;
    fast.low = *picture_.low / seconds, fast.high = *picture_.high / seconds;
    fast.assumptions = picture_.assumptions;
    fast.note = fmt::format("{:.3g} s and {:.3g} s of the array, 16 planes and four edges; interval of the former",
                            *picture_.simulated, seconds);
  }

  const TableContext& context_;
  const TableRow& picture_;
  std::vector<std::string> settings_;
  std::vector<TableRow> rows_;
};

}  // namespace

std::vector<TableRow> fg86_planes_rows(const TableContext& context, const TableRow& picture) {
  if (context.catalogue.machine(kMachine) == nullptr) return {};
  return Rows(context, picture).make();
}

}  // namespace dendro::study
