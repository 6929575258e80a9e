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

RunRequest request_for(const TableContext& context, const Claim& claim, const std::vector<std::string>& widths) {
  RunArguments arguments;
  arguments.scene = claim.scene;
  arguments.level = context.options.level;
  arguments.settings = claim.settings;
  for (const auto* more : {&widths, &context.options.settings})
    arguments.settings.insert(arguments.settings.end(), more->begin(), more->end());
  RunRequest request = prepare_run(context.catalogue, arguments);
  if (request.level == Level::kFunction)
    throw UserError("--level", 0, "", "a table of times needs a level with time: cycle or clocked");
  return request;
}

/// Shortest and longest words that the assumption sheet allows.
const std::vector<std::vector<std::string>>& word_lengths() {
  static const std::vector<std::vector<std::string>> list = {
      {},
      {"raster_primitives.depth_bits=12", "raster_primitives.fraction_bits=9", "raster_primitives.sphere_digits=1"},
      {"raster_primitives.depth_bits=24", "raster_primitives.fraction_bits=11", "raster_primitives.sphere_digits=3"}};
  return list;
}

std::vector<TableRow> claim_rows(const TableContext& context, const Claim& claim) {
  const auto count = [&claim](const stats::RunObject& run) { return fact(run, claim.fact); };
  const std::vector<Metric> metrics = {
      {"array", [count](const stats::RunObject& run) { return count(run) * run.clock_hz / array_clocks(run); }},
      {"system", [count](const stats::RunObject& run) { return count(run) / seconds_without_loading(run); }}};
  const RunMaker make = worker_runs(context.options.jobs, context.progress, claim.id, &context.cache);
  std::vector<TableRow> rows(2);
  std::string clocks;
  for (std::size_t k = 0; k < word_lengths().size(); ++k) {
    const RunRequest request = request_for(context, claim, word_lengths()[k]);
    const stats::RunObject nominal = from_bytes(make({request}).front().value()).object;
    const std::vector<Interval> intervals = propagate(request, nominal, metrics, make, 0);
    clocks += fmt::format("{}{:.0f}", k == 0 ? "" : k == 1 ? " clocks of the array each (" : " to ",
                          array_clocks(nominal) / count(nominal));
    for (std::size_t m = 0; m < rows.size(); ++m) {
      if (k == 0) {
        rows[m].simulated = metrics[m].of(nominal);
        set_interval(rows[m], intervals[m], request.preset.parameters);
        if (m == 1)
          rows[m].note = fmt::format("the host takes {:.0f} floating-point operations each; {:.0f} drawn",
                                     fact(nominal, std::string("host.flops_per_") + claim.fact), count(nominal));
      } else {
        rows[m].low = std::min(*rows[m].low, intervals[m].low);
        rows[m].high = std::max(*rows[m].high, intervals[m].high);
      }
    }
  }
  rows[0].note = clocks + fmt::format(" by word lengths); the claim leaves {:.0f} at 10 MHz", 10e6 / claim.published);
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

std::vector<TableRow> make(const TableContext& context) {
  std::vector<TableRow> rows;
  for (const Claim& claim : claims())
    for (TableRow& row : claim_rows(context, claim)) rows.push_back(std::move(row));
  TableRow equalisation;
  equalisation.id = "FGHS85-4";
  equalisation.paper = "FGHS85";
  equalisation.what = "adaptive histogram equalisation of 512x512 pixels";
  equalisation.unit = "s";
  equalisation.published = 4;
  equalisation.reading = "\"within 4 seconds\"";
  equalisation.note = "not answered: there is no firmware for it yet";
  rows.push_back(std::move(equalisation));
  return rows;
}

}  // namespace

PaperTable fghs85_table() {
  std::vector<std::string> plan;
  for (const Claim& claim : claims())
    plan.push_back(fmt::format("{}: {}, nominal and over every assumption, with three word lengths", claim.id, claim.scene));
  return {"FGHS85", plan, make, [](const TableContext& context) {
            for (const Claim& claim : claims()) check_run(request_for(context, claim, {}));
          }};
}

}  // namespace dendro::study
