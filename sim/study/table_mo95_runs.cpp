#include <fmt/format.h>

#include <algorithm>

#include "sim/base/check.h"
#include "sim/base/error.h"
#include "sim/study/table_mo95.h"

namespace dendro::study {
namespace {

constexpr const char* kMachine = "sgi-4d35";
constexpr const char* kPrecompute = "zbuffer_views_precompute";

bool is_precompute(const std::string& phase) {
  return phase.compare(0, std::string(kPrecompute).size(), kPrecompute) == 0;
}

/// What is done before the first picture of a sequence.
bool is_once(const std::string& phase) {
  const std::string name = phase.substr(phase.rfind('.') + 1);
  return name == "start" || name == "read" || name == "normals" || name == "directions";
}

template <class Chosen>
double seconds_of(const stats::RunObject& run, Chosen chosen) {
  double seconds = 0;
  for (const stats::PhaseRow& phase : run.phases) seconds += chosen(phase.name) ? phase.seconds : 0;
  return seconds;
}

std::vector<stats::RunObject> objects(const std::vector<Outcome>& outcomes) {
  std::vector<stats::RunObject> list;
  for (const Outcome& outcome : outcomes) list.push_back(from_bytes(outcome.value()).object);
  return list;
}

/// A tree of a few thousand triangles, all programs' loops.
SceneRun small_run() {
  return mo95_scene("video-2", {"image.width=80", "image.height=80", "object.0.age=6",
                                "zbuffer_views.bands=2", "zbuffer_views.view_width=100",
                                "zbuffer_views.view_height=160", "zbuffer_views.precompute=timed"});
}

std::vector<Assignment> corners_of_all(const TableContext& context, const std::string& name) {
  const RunRequest small = request_of(context, small_run());
  const RunMaker make =
      worker_runs(context.options.jobs, context.progress, name + " corners", &context.cache);
  const stats::RunObject nominal = objects(make({small})).front();
  std::vector<Assignment> list =
      corners(small, nominal, {{"frame", mo95_frame_seconds}, {"views", mo95_precompute_seconds}}, make);
  // In less memory a sequence reads views again, which is another experiment.
  for (Assignment& assignment : list) assignment.erase("memory.main_bytes");
  return list;
}

}  // namespace

double mo95_frame_seconds(const stats::RunObject& run) {
  return seconds_of(run, [](const std::string& phase) { return !is_precompute(phase) && !is_once(phase); });
}

double mo95_precompute_seconds(const stats::RunObject& run) { return seconds_of(run, is_precompute); }

double mo95_tree_seconds(const stats::RunObject& run) {
  return seconds_of(run, [](const std::string& phase) { return !is_precompute(phase) && is_once(phase); });
}

double mo95_sample_cycles(const stats::RunObject& run) {
  const double samples = fact(run, "samples.camera") + fact(run, "samples.light");
  return samples == 0 ? 0 : mo95_frame_seconds(run) * run.clock_hz / samples;
}

double mo95_cycles_an_instruction(const stats::RunObject& run) {
  return static_cast<double>(run.machine_cycles) / static_cast<double>(run.instructions);
}

std::string mo95_stalls(const stats::RunObject& run) {
  const std::string stall = "stall_";
  std::vector<std::pair<double, std::string>> shares;
  for (const stats::UnitRow& unit : run.units)
    for (const auto& [name, value] : unit.values)
      if (unit.unit == "sgi_4d35.processor" && name.compare(0, stall.size(), stall) == 0)
        shares.emplace_back(100.0 * static_cast<double>(value) / static_cast<double>(run.machine_cycles),
                            name.substr(stall.size()));
  std::sort(shares.rbegin(), shares.rend());
  std::string text = "of all cycles";
  for (std::size_t i = 0; i < std::min<std::size_t>(3, shares.size()); ++i)
    text += fmt::format("{} {:.1f} % wait for {}", i == 0 ? "" : ",", shares[i].first, shares[i].second);
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

SceneRun mo95_scene(const std::string& scene, const std::vector<std::string>& settings) {
  SceneRun run{scene, {"zbuffer_views.frames=1"}, "", {}, kMachine};
  run.settings.insert(run.settings.end(), settings.begin(), settings.end());
  return run;
}

std::vector<stats::RunObject> mo95_runs(const TableContext& context, const std::vector<SceneRun>& runs,
                                        const std::string& name) {
  std::vector<RunRequest> requests;
  for (const SceneRun& run : runs) requests.push_back(request_of(context, run));
  return objects(worker_runs(context.options.jobs, context.progress, name, &context.cache)(requests));
}

std::vector<Mo95Variant> mo95_program_variants() {
  return {{"-O1", {"zbuffer_views.compiler=O1"}},
          {"rounding by FCR31", {"zbuffer_views.compiler=fcr31"}},
          {"unmapped", {"zbuffer_views.mapped=false"}}};
}

const stats::RunObject& Mo95Spread::run(const std::string& name) const {
  for (std::size_t i = 0; i < plan.readings.size(); ++i)
    if (plan.readings[i].name == name) return readings[i];
  for (std::size_t i = 0; i < plan.others.size(); ++i)
    if (plan.others[i].name == name) return others[i];
  DENDRO_CHECK(false, "{}", name);
  return nominal;
}

Mo95Spread mo95_spread(const TableContext& context, const Mo95Plan& plan) {
  const std::string name = "MO95 " + plan.scene;
  const auto with = [&](const Mo95Variant& variant) {
    std::vector<std::string> settings = plan.settings;
    settings.insert(settings.end(), variant.settings.begin(), variant.settings.end());
    return request_of(context, mo95_scene(plan.scene, settings));
  };
  const RunRequest nominal = request_of(context, mo95_scene(plan.scene, plan.settings));
  const std::vector<Assignment> all = corners_of_all(context, name);
  // Others may be the dearest; begun last, one of them would keep a single core busy.
  std::vector<RunRequest> requests;
  for (const Mo95Variant& variant : plan.others) requests.push_back(with(variant));
  requests.push_back(nominal);
  for (const Assignment& assignment : all) requests.push_back(with_values(nominal, assignment));
  for (const Mo95Variant& variant : plan.readings) requests.push_back(with(variant));
  std::vector<stats::RunObject> made =
      objects(worker_runs(context.options.jobs, context.progress, name, &context.cache)(requests));
  const auto others = made.begin() + static_cast<std::ptrdiff_t>(plan.others.size());
  const auto readings = others + 1 + static_cast<std::ptrdiff_t>(all.size());
  Mo95Spread spread;
  spread.plan = plan;
  spread.nominal = *others;
  spread.others.assign(made.begin(), others);
  spread.corners.assign(others + 1, readings);
  spread.readings.assign(readings, made.end());
  // Behind all low and all high only parameters that moved something were put elsewhere.
  config::ParameterSet moved;
  for (std::size_t i = 2; i < all.size(); ++i)
    for (const auto& [key, value] : all[i])
      if (moved.find(key) == nullptr) moved.add(*nominal.preset.parameters.find(key));
  const auto assumptions = moved.assumptions();
  spread.assumptions.assign(assumptions.begin(), assumptions.end());
  return spread;
}

void set_spread(TableRow& row, const Mo95Spread& spread, const Mo95Metric& metric) {
  const double value = metric(spread.nominal);
  set_single(row, value);
  for (const auto* runs : {&spread.corners, &spread.readings})
    for (const stats::RunObject& run : *runs) {
      if (metric(run) == 0) continue;
      row.low = std::min(*row.low, metric(run));
      row.high = std::max(*row.high, metric(run));
    }
  row.assumptions = spread.assumptions;
}

void scale_to(TableRow& row, double nominal) {
  const double factor = nominal / *row.simulated;
  set_range(row, nominal, *row.low * factor, *row.high * factor);
}

std::string told(const std::vector<Mo95Variant>& variants, const std::vector<stats::RunObject>& runs,
                 const Mo95Metric& metric) {
  std::string text;
  for (std::size_t i = 0; i < variants.size(); ++i)
    if (const double value = metric(runs[i]); value != 0)
      text += fmt::format("{}{} {:.3g} s", text.empty() ? "" : ", ", variants[i].name, value);
  return text;
}

std::string beside(const TableRow& row, double low, double high) {
  const char* place = *row.simulated < low ? "below" : *row.simulated > high ? "above" : "within";
  return fmt::format("the figure lies {} {:.4g} to {:.4g}", place, low, high);
}

std::string outside_note(const TableRow& row, const std::string& slower, const std::string& faster) {
  if (!row.published || row.inside()) return "";
  return *row.high < *row.published ? "; the paper is slower: " + slower : "; the paper is faster: " + faster;
}

}  // namespace dendro::study
