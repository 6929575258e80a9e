#include "sim/study/table_rows.h"

#include <algorithm>
#include <memory>
#include <tuple>

#include "sim/base/check.h"
#include "sim/base/error.h"

namespace dendro::study {
namespace {

/// Points of the Latin hypercube that `--full` adds to the corners.
constexpr int kSamples = 100;

/// The parts of "FG86-A12c" behind the paper: what stands before the number, the number, what follows it.
std::tuple<std::string, int, std::string> order(const std::string& id) {
  const std::size_t letters = id.find('-') + 1, at = id.find_first_of("0123456789", letters);
  DENDRO_CHECK(at != std::string::npos, "{}", id);
  std::size_t used = 0;
  const int number = std::stoi(id.substr(at), &used);
  return {id.substr(letters, at - letters), number, id.substr(at + used)};
}

bool any_wanted(const RowGroup& group, const TableOptions& options) {
  return std::any_of(group.rows.begin(), group.rows.end(), [&](const TableRow& row) { return options.wants(row.id); });
}

std::vector<TableRow> make(const std::vector<RowGroup>& groups, const TableContext& context) {
  std::vector<TableRow> all;
  for (const RowGroup& group : groups) {
    if (!any_wanted(group, context.options)) continue;
    std::vector<TableRow> rows = group.rows;
    try {
      group.fill(context, rows);
    } catch (const UserError& error) {
      rows = group.rows;
      for (TableRow& row : rows) set_refused(row, error);
    }
    for (const TableRow& row : rows)
      DENDRO_CHECK(row.simulated || !row.note.empty(), "{} has neither a figure nor a reason", row.id);
    for (TableRow& row : rows)
      if (context.options.wants(row.id)) all.push_back(std::move(row));
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const TableRow& a, const TableRow& b) { return order(a.id) < order(b.id); });
  return all;
}

std::string claims_of(const RowGroup& group) {
  std::string text;
  for (const TableRow& row : group.rows) {
    const std::string id = row.id.substr(row.id.find('-') + 1);
    text += (text.empty() ? "" : ", ") + id;
  }
  return text;
}

bool is_parameter(const std::string& setting) { return setting.compare(0, 11, "parameters.") == 0; }

}  // namespace

PaperTable grouped_table(const std::string& key, const std::string& title, std::vector<RowGroup> groups,
                         std::function<void(const TableContext&)> check) {
  PaperTable table;
  table.key = key;
  table.title = title;
  for (const RowGroup& group : groups)
    if (!group.plan.empty()) table.plan.push_back(key + "-" + claims_of(group) + ": " + group.plan);
  const auto shared = std::make_shared<std::vector<RowGroup>>(std::move(groups));
  table.make = [shared](const TableContext& context) { return make(*shared, context); };
  table.check = std::move(check);
  return table;
}

TableRow claim(const std::string& id, const std::string& what, const std::string& unit,
               std::optional<double> published, const std::string& reading) {
  TableRow row;
  row.id = id;
  row.paper = id.substr(0, id.find('-'));
  row.what = what;
  row.unit = unit;
  row.published = published;
  row.reading = reading;
  return row;
}

void set_single(TableRow& row, double value) { row.simulated = row.low = row.high = value; }

void set_range(TableRow& row, double value, double low, double high) {
  row.simulated = value;
  row.low = low;
  row.high = high;
}

void set_refused(TableRow& row, const UserError& error) {
  row.note = std::string("no figure: ") + error.what();
}

RunRequest request_of(const TableContext& context, const SceneRun& run) {
  RunArguments arguments;
  arguments.scene = run.scene;
  arguments.machine = run.machine;
  arguments.level = run.level.empty() ? context.options.level : run.level;
  const std::string machine = run.machine.empty() ? "rds3000" : run.machine.substr(0, run.machine.find(':'));
  arguments.settings = settings_for(context, machine);
  arguments.settings.insert(arguments.settings.end(), run.settings.begin(), run.settings.end());
  RunRequest request = prepare_run(context.catalogue, arguments);
  if (run.counted) request.options.counted = run.counted(request);
  return request;
}

std::vector<Outcome> compared_runs(const TableContext& context, const std::vector<SceneRun>& runs,
                                   const std::string& name) {
  std::vector<Outcome> outcomes(runs.size());
  std::vector<RunRequest> requests;
  std::vector<std::size_t> asked;
  for (std::size_t i = 0; i < runs.size(); ++i) try {
      requests.push_back(request_of(context, runs[i]));
      asked.push_back(i);
    } catch (const UserError& error) {
      outcomes[i].error = error;
    }
  const RunMaker make =
      worker_runs(context.options.jobs, context.progress, name, &context.cache, Pictures::kCompared);
  std::vector<Outcome> made = make(requests);
  for (std::size_t n = 0; n < asked.size(); ++n) outcomes[asked[n]] = std::move(made[n]);
  return outcomes;
}

void check_level(const TableContext& context) {
  if (context.options.level == level_name(Level::kFunction))
    throw UserError("--level", 0, "", "a table of times needs a level with time: cycle or clocked");
}

Propagated propagate_scene(const TableContext& context, const SceneRun& run,
                           const std::vector<Metric>& metrics, const std::string& name) {
  check_level(context);
  return propagate_request(context, request_of(context, run), metrics, name);
}

Propagated propagate_request(const TableContext& context, const RunRequest& request,
                             const std::vector<Metric>& metrics, const std::string& name) {
  Propagated p;
  p.request = request;
  const RunMaker make = worker_runs(context.options.jobs, context.progress, name, &context.cache);
  p.nominal = from_bytes(make({p.request}).front().value()).object;
  p.intervals = propagate(p.request, p.nominal, metrics, make, context.options.full ? kSamples : 0);
  return p;
}

void set_metric(TableRow& row, const Propagated& p, const std::vector<Metric>& metrics, std::size_t i) {
  row.simulated = metrics[i].of(p.nominal);
  set_interval(row, p.intervals[i], p.request.preset.parameters);
}

std::vector<std::string> parameter_settings(const TableContext& context, const std::string& machine) {
  std::vector<std::string> settings;
  for (const std::string& setting : settings_for(context, machine))
    if (is_parameter(setting)) settings.push_back(setting);
  return settings;
}

ExecOutput exec_text(const TableContext& context, const std::string& name, const std::string& text,
                     const std::vector<std::string>& settings, const std::string& level,
                     const std::vector<std::pair<std::uint32_t, std::uint32_t>>& dumps) {
  ExecArguments arguments;
  arguments.machine = "rds3000";
  arguments.program = name;
  arguments.text = text;
  arguments.level = level.empty() ? context.options.level : level;
  arguments.dumps = dumps;
  arguments.settings = parameter_settings(context, arguments.machine);
  arguments.settings.insert(arguments.settings.end(), settings.begin(), settings.end());
  return exec_program(context.catalogue, arguments, nullptr);
}

double fact(const stats::RunObject& run, const std::string& name) {
  for (const auto& [key, value] : run.facts)
    if (key == name) return value;
  return 0;
}

double error_figure(const stats::RunObject& run, const std::string& name) {
  for (const auto& [key, value] : run.error.extra)
    if (key == name) return value;
  DENDRO_CHECK(false, "{} is not reported", name);
  return 0;
}

double phase_seconds(const stats::RunObject& run, const std::string& name) {
  double seconds = 0;
  for (const stats::PhaseRow& p : run.phases) seconds += p.name == name ? p.seconds : 0;
  return seconds;
}

double machine_seconds(const stats::RunObject& run) {
  double seconds = 0;
  for (const stats::PhaseRow& p : run.phases) seconds += p.on_host ? 0 : p.seconds;
  return seconds;
}

}  // namespace dendro::study
