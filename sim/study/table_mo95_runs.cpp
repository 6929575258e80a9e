#include <algorithm>

#include "sim/base/error.h"
#include "sim/study/table_mo95.h"

namespace dendro::study {
namespace {

constexpr const char* kMachine = "sgi-4d35";
constexpr const char* kPrecompute = "zbuffer_views_precompute";

bool is_precompute(const std::string& phase) { return phase.compare(0, std::string(kPrecompute).size(), kPrecompute) == 0; }

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
  return mo95_scene("video-2", {"image.width=80", "image.height=80", "object.0.age=6", "zbuffer_views.bands=2",
                                "zbuffer_views.view_width=100", "zbuffer_views.view_height=160",
                                "zbuffer_views.precompute=timed"});
}

std::vector<Assignment> corners_of_all(const TableContext& context, const std::string& name) {
  const RunRequest small = request_of(context, small_run());
  const RunMaker make = worker_runs(context.options.jobs, context.progress, name + " corners", &context.cache);
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

Mo95Spread mo95_spread(const TableContext& context, const SceneRun& run, const std::vector<SceneRun>& readings,
                       const std::string& name) {
  const RunRequest nominal = request_of(context, run);
  std::vector<RunRequest> requests = {nominal};
  const std::vector<Assignment> all = corners_of_all(context, name);
  for (const Assignment& assignment : all) requests.push_back(with_values(nominal, assignment));
  for (const SceneRun& reading : readings) requests.push_back(request_of(context, reading));
  const std::vector<stats::RunObject> made =
      objects(worker_runs(context.options.jobs, context.progress, name, &context.cache)(requests));
  Mo95Spread spread;
  spread.nominal = made.front();
  const auto middle = made.begin() + 1 + static_cast<std::ptrdiff_t>(all.size());
  spread.corners.assign(made.begin() + 1, middle);
  spread.readings.assign(middle, made.end());
  // Behind all low and all high only parameters that moved something were put elsewhere.
  config::ParameterSet moved;
  for (std::size_t i = 2; i < all.size(); ++i)
    for (const auto& [key, value] : all[i])
      if (moved.find(key) == nullptr) moved.add(*nominal.preset.parameters.find(key));
  const auto assumptions = moved.assumptions();
  spread.assumptions.assign(assumptions.begin(), assumptions.end());
  return spread;
}

void set_spread(TableRow& row, const Mo95Spread& spread, const std::function<double(const stats::RunObject&)>& metric) {
  const double value = metric(spread.nominal);
  set_range(row, value, value, value);
  for (const auto* runs : {&spread.corners, &spread.readings})
    for (const stats::RunObject& run : *runs) {
      row.low = std::min(*row.low, metric(run));
      row.high = std::max(*row.high, metric(run));
    }
  row.assumptions = spread.assumptions;
}

std::string outside_note(const TableRow& row, const std::string& slower, const std::string& faster) {
  if (!row.published || row.inside()) return "";
  return *row.high < *row.published ? "; the paper is slower: " + slower : "; the paper is faster: " + faster;
}

}  // namespace dendro::study
