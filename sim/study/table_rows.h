#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/study/exec.h"
#include "sim/study/table.h"

namespace dendro::study {

/// Rows that one experiment fills. A setting that the experiment's scene or program refuses costs these rows,
/// not the table.
struct RowGroup {
  std::string plan;            ///< what is run, one line; empty: nothing worth announcing
  std::vector<TableRow> rows;  ///< made by claim(): no figures yet
  /// Puts figures and notes into the rows; a row may stay without a figure if its note says why.
  std::function<void(const TableContext&, std::vector<TableRow>&)> fill;
};

/// A table made of groups, its rows in the order of the claims' numbers. A group that throws UserError leaves
/// its rows without figures and the error as their note.
PaperTable grouped_table(const std::string& key, const std::string& title, std::vector<RowGroup> groups,
                         std::function<void(const TableContext&)> check);

/// A row before its experiment. `id` is the claim's: "FG86-A7a".
TableRow claim(const std::string& id, const std::string& what, const std::string& unit,
               std::optional<double> published = std::nullopt, const std::string& reading = "");

/// A figure that nothing assumed moves.
void set_single(TableRow& row, double value);

/// A figure and what it was over several trees, angles, ...
void set_range(TableRow& row, double value, double low, double high);

/// Leaves the row without a figure.
void set_refused(TableRow& row, const UserError& error);

/// A shipped scene that a table runs.
struct SceneRun {
  std::string scene;
  std::vector<std::string> settings;  ///< key=value, after the table's own
  std::string level;                  ///< empty: the table's
  /// Words of the run's programs to count (`function` only); may be empty.
  std::function<std::map<std::uint32_t, std::string>(const RunRequest&)> counted;
  std::string machine = {};  ///< NAME or NAME:PRESET; empty: the scene's
};

/// Throws UserError.
RunRequest request_of(const TableContext& context, const SceneRun& run);

/// Runs with their pictures compared, from the cache where it has them; a scene that refuses a setting comes
/// back with its error.
std::vector<Outcome> compared_runs(const TableContext& context, const std::vector<SceneRun>& runs,
                                   const std::string& name);

/// A scene's nominal run and what the assumptions make of it.
struct Propagated {
  RunRequest request;
  stats::RunObject nominal;
  std::vector<Interval> intervals;  ///< one per metric
};

/// Runs at the table's level, which must have time. Throws UserError.
Propagated propagate_scene(const TableContext& context, const SceneRun& run,
                           const std::vector<Metric>& metrics, const std::string& name);

/// The same for any request with a level that has time.
Propagated propagate_request(const TableContext& context, const RunRequest& request,
                             const std::vector<Metric>& metrics, const std::string& name);

/// Puts metric `i` of `p` and its interval into a row.
void set_metric(TableRow& row, const Propagated& p, const std::vector<Metric>& metrics, std::size_t i);

/// Throws UserError for a level without time.
void check_level(const TableContext& context);

/// Those of the table's settings that are parameters of the machine: a scene's keys mean nothing to a program
/// without scene.
std::vector<std::string> parameter_settings(const TableContext& context, const std::string& machine);

/// A microprogram's run with the table's settings of the machine.
ExecOutput exec_text(const TableContext& context, const std::string& name, const std::string& text,
                     const std::vector<std::string>& settings = {}, const std::string& level = "",
                     const std::vector<std::pair<std::uint32_t, std::uint32_t>>& dumps = {});

double fact(const stats::RunObject& run, const std::string& name);           ///< 0 without it
double error_figure(const stats::RunObject& run, const std::string& name);   ///< must be there
double phase_seconds(const stats::RunObject& run, const std::string& name);  ///< 0 without it
double machine_seconds(const stats::RunObject& run);                         ///< phases of the machine

}  // namespace dendro::study
