#include <fmt/format.h>

#include <algorithm>

#include "sim/base/check.h"
#include "sim/base/error.h"
#include "sim/study/table.h"

namespace dendro::study {
namespace {

/// A claim of so many primitives a second.
struct Claim {
  const char* id;
  const char* what;
  double published;
  const char* scene;
  std::vector<std::string> settings;  ///< of the scene, so that it is quickly run
  const char* fact;                   ///< how many primitives were drawn
  const char* reading;
};

const std::vector<Claim>& claims() {
  static const std::vector<Claim> list = {
      {"FGHS85-1", "smooth triangles with a depth buffer", 30000, "teapot",
       {"raster_primitives.patch_steps=1", "raster_primitives.cull=true"}, "triangles",
       "\"30,000 smooth-shaded triangles a second\", an estimate"},
      {"FGHS85-2", "smooth triangles that cast shadows", 21000, "shadows",
       {"raster_primitives.patch_steps=1"}, "triangles",
       "\"21,000 smooth-shaded and shadowed triangles a second\", an estimate; every triangle is drawn and casts a shadow"},
      {"FGHS85-3", "shaded spheres with a depth buffer", 25000, "buckyball", {}, "spheres",
       "\"more than 25,000 spheres a second\", an estimate; 60 spheres of 42 pixels' radius"},
  };
  return list;
}

double fact(const stats::RunObject& run, const std::string& name) {
  for (const auto& [key, value] : run.facts)
    if (key == name) return value;
  DENDRO_CHECK(false, "{} is not reported", name);
  return 0;
}

std::uint64_t counter(const stats::RunObject& run, const std::string& unit, const std::string& name) {
  for (const stats::UnitRow& row : run.units)
    if (row.unit == unit)
      for (const auto& [key, value] : row.values)
        if (key == name) return value;
  DENDRO_CHECK(false, "{}.{} is not counted", unit, name);
  return 0;
}

/// What is done once a picture.
bool is_once(const std::string& phase) { return phase == "load_program" || phase == "clear"; }

/// Clocks in which the array works on primitives, or another user keeps it from that.
double array_clocks(const stats::RunObject& run) {
  double clocks = 0;
  for (const char* name : {"busy", "stall_refresh", "stall_video"})
    clocks += static_cast<double>(counter(run, "pixel_planes.controller", name));
  for (const stats::PhaseRow& p : run.phases) clocks -= p.name == "clear" ? static_cast<double>(p.cycles) : 0;
  return clocks;
}

double seconds_without_loading(const stats::RunObject& run) {
  double seconds = 0;
  for (const stats::PhaseRow& p : run.phases) seconds += is_once(p.name) ? 0 : p.seconds;
  return seconds;
}

RunRequest request_for(const TableContext& context, const std::string& scene, const std::vector<std::string>& settings) {
  RunArguments arguments;
  arguments.scene = scene;
  arguments.level = context.options.level;
  arguments.settings = settings;
  arguments.settings.insert(arguments.settings.end(), context.options.settings.begin(), context.options.settings.end());
  RunRequest request = prepare_run(context.catalogue, arguments);
  if (request.level == Level::kFunction)
    throw UserError("--level", 0, "", "a table of times needs a level with time: cycle or clocked");
  return request;
}

using Settings = std::vector<std::string>;

Settings joined(Settings settings, const Settings& more) {
  settings.insert(settings.end(), more.begin(), more.end());
  return settings;
}

/// Rows, one a metric, over the machine's assumptions and several readings of the scene, the first of them nominal.
struct Measured {
  std::vector<TableRow> rows;
  std::vector<stats::RunObject> nominal;  ///< by reading
};

Measured measure(const TableContext& context, const std::string& id, const std::string& scene,
                 const std::vector<Settings>& readings, const std::vector<Metric>& metrics) {
  const RunMaker make = worker_runs(context.options.jobs, context.progress, id, &context.cache);
  Measured out;
  out.rows.resize(metrics.size());
  for (const Settings& reading : readings) {
    const RunRequest request = request_for(context, scene, reading);
    const stats::RunObject nominal = from_bytes(make({request}).front().value()).object;
    const std::vector<Interval> intervals = propagate(request, nominal, metrics, make, 0);
    for (std::size_t m = 0; m < metrics.size(); ++m) {
      TableRow& row = out.rows[m];
      if (out.nominal.empty()) {
        row.simulated = metrics[m].of(nominal);
        set_interval(row, intervals[m], request.preset.parameters);
      } else {
        row.low = std::min(*row.low, intervals[m].low);
        row.high = std::max(*row.high, intervals[m].high);
      }
    }
    out.nominal.push_back(nominal);
  }
  return out;
}

/// Usual, shortest and longest words that the assumption sheet allows.
const std::vector<Settings>& word_lengths() {
  static const std::vector<Settings> list = {
      {},
      {"raster_primitives.depth_bits=12", "raster_primitives.fraction_bits=9", "raster_primitives.sphere_digits=1"},
      {"raster_primitives.depth_bits=24", "raster_primitives.fraction_bits=11", "raster_primitives.sphere_digits=3"}};
  return list;
}

std::vector<TableRow> claim_rows(const TableContext& context, const Claim& claim) {
  const auto count = [&claim](const stats::RunObject& run) { return fact(run, claim.fact); };
  std::vector<Settings> readings;
  for (const Settings& lengths : word_lengths()) readings.push_back(joined(claim.settings, lengths));
  Measured measured = measure(
      context, claim.id, claim.scene, readings,
      {{"array", [count](const stats::RunObject& run) { return count(run) * run.clock_hz / array_clocks(run); }},
       {"system", [count](const stats::RunObject& run) { return count(run) / seconds_without_loading(run); }}});
  std::vector<TableRow>& rows = measured.rows;
  const stats::RunObject& nominal = measured.nominal.front();
  std::vector<double> clocks;
  for (const stats::RunObject& run : measured.nominal) clocks.push_back(array_clocks(run) / count(run));
  rows[0].note = fmt::format("{:.0f} clocks of the array each ({:.0f} to {:.0f} by word lengths); the claim leaves {:.0f} at 10 MHz",
                             clocks[0], clocks[1], clocks[2], 10e6 / claim.published);
  rows[1].note = fmt::format("the host takes {:.0f} floating-point operations each; {:.0f} drawn",
                             fact(nominal, std::string("host.flops_per_") + claim.fact), count(nominal));
  for (std::size_t m = 0; m < rows.size(); ++m) {
    TableRow& row = rows[m];
    row.id = std::string(claim.id) + (m == 0 ? "a" : "b");
    row.paper = "FGHS85";
    row.what = std::string(claim.what) + (m == 0 ? ", array alone" : ", with the host");
    row.unit = "1/s";
    row.published = claim.published;
    row.reading = std::string(claim.reading) +
                  (m == 0 ? "; commands always waiting" : "; host program and array together, without loading and clearing");
    row.assumptions.insert(row.assumptions.begin(), "DEV-095");
  }
  return rows;
}

constexpr const char* kEqualisation = "radiograph";
constexpr double kWholePicture = 512 * 512;

/// Rows of the picture take the same time each, so a strip stands for all 512.
const std::vector<Settings>& equalisations() {
  static const std::vector<Settings> list = {
      {"image.height=64"},
      {"image.height=32", "image.width=256", "adaptive_equalisation.region=32", "adaptive_equalisation.grey_bits=8", "adaptive_equalisation.method=rows"},
      {"image.height=128", "image.width=256", "adaptive_equalisation.region=128", "adaptive_equalisation.grey_bits=16"}};
  return list;
}

double equalisation_seconds(const stats::RunObject& run, bool with_loading) {
  double seconds = 0;
  for (const stats::PhaseRow& p : run.phases)
    seconds += is_once(p.name) || (!with_loading && p.name == "load_picture") ? 0 : p.seconds;
  return seconds * kWholePicture / fact(run, "pixels");
}

std::vector<TableRow> equalisation_rows(const TableContext& context) {
  Measured measured = measure(context, "FGHS85-4", kEqualisation, equalisations(),
                              {{"equalise", [](const stats::RunObject& run) { return equalisation_seconds(run, false); }},
                               {"with loading", [](const stats::RunObject& run) { return equalisation_seconds(run, true); }}});
  const stats::RunObject& nominal = measured.nominal.front();
  double clocks = 0;
  for (const stats::PhaseRow& p : nominal.phases)
    if (!p.on_host && (p.name == "region" || p.name == "rank")) clocks += static_cast<double>(p.cycles);
  for (std::size_t m = 0; m < measured.rows.size(); ++m) {
    TableRow& row = measured.rows[m];
    row.id = m == 0 ? "FGHS85-4a" : "FGHS85-4b";
    row.paper = "FGHS85";
    row.what = std::string("adaptive histogram equalisation of 512x512 pixels") + (m == 0 ? ", the picture in the array" : ", loaded first");
    row.unit = "s";
    row.published = 4;
    row.reading = "\"within 4 seconds\", an upper bound; every grey value sent to the pixels around it, 64x64 of 12 bits";
    row.assumptions.insert(row.assumptions.begin(), "DEV-100");
  }
  measured.rows[0].note = fmt::format("{:.0f} clocks a pixel; the bound leaves {:.0f} at 10 MHz; a strip, scaled; 32x32 of 8 bits by rows to "
                                      "128x128 of 16 bits", clocks / fact(nominal, "pixels"), 4 * 10e6 / kWholePicture);
  measured.rows[1].note = "a pixel at a time through the tree";
  return measured.rows;
}

std::vector<TableRow> make(const TableContext& context) {
  std::vector<TableRow> rows;
  for (const Claim& claim : claims())
    for (TableRow& row : claim_rows(context, claim)) rows.push_back(std::move(row));
  for (TableRow& row : equalisation_rows(context)) rows.push_back(std::move(row));
  return rows;
}

}  // namespace

PaperTable fghs85_table() {
  std::vector<std::string> plan;
  for (const Claim& claim : claims())
    plan.push_back(fmt::format("{}: {}, nominal and over every assumption, with three word lengths", claim.id, claim.scene));
  plan.push_back(fmt::format("FGHS85-4: {}, nominal and over every assumption, with three sizes of region", kEqualisation));
  return {"FGHS85", "Fast Spheres, Shadows, Textures ... in Pixel-Planes, 1985: primitives on pixel-planes", plan, make, [](const TableContext& context) {
            for (const Claim& claim : claims()) check_run(request_for(context, claim.scene, claim.settings));
            check_run(request_for(context, kEqualisation, equalisations().front()));
          }};
}

}  // namespace dendro::study
