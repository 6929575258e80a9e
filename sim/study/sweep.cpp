#include "sim/study/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>

#include "sim/base/error.h"
#include "sim/config/nearest.h"
#include "sim/study/cache.h"

namespace dendro::study {
namespace {

namespace fs = std::filesystem;

/// Runs that are prepared at once: few enough for memory, enough to keep the workers busy.
constexpr std::size_t kBatch = 256;

std::string reason(const UserError& error) {
  return error.key().empty() ? error.message() : error.key() + ": " + error.message();
}

/// Figures that a run may lack for a good reason.
bool may_be_missing(const std::string& output) { return output == "error.psnr_db"; }

RunRequest prepare(const Catalogue& catalogue, const Study& study, const std::string& machine, const std::string& level,
                   const std::vector<std::string>& settings) {
  RunArguments arguments;
  arguments.scene = study.scene;
  arguments.machine = machine;
  arguments.level = level;
  arguments.settings = settings;
  arguments.seed = study.seed;
  return prepare_run(catalogue, arguments);
}

/// Blames the place in the study for an error in what it put in; an error of the scene stays where it is.
template <class Action>
void blaming(const Study& study, const config::Where& where, const std::string& key, const Action& action) {
  try {
    action();
  } catch (const UserError& error) {
    if (error.file().empty())
      throw UserError(study.scene_where.file, study.scene_where.line, "scene", error.what());
    if (error.file() == "--machine") {
      config::Where named = study.machine_where;
      for (const StudyAxis& axis : study.axes)
        if (axis.key == kMachineKey) named = axis.where;
      throw UserError(named.file, named.line, kMachineKey, error.message());
    }
    if (error.file() != "--set" && error.file() != "--level") throw;
    throw UserError(where.file, where.line, key.empty() ? error.key() : key, error.message());
  }
}

/// Every level, machine and value alone, so that a wrong key or type costs no run.
void check_settings(const Catalogue& catalogue, const Study& study) {
  const std::string machine = study.machine_of(0), &level = study.levels.front();
  for (const std::string& one : study.levels)
    blaming(study, study.levels_where, "levels", [&] { prepare(catalogue, study, machine, one, {}); });
  blaming(study, study.settings_where, "", [&] { prepare(catalogue, study, machine, level, study.settings); });
  for (const StudyAxis& axis : study.axes) {
    // One value of a long range stands for the others: they differ in nothing but their size.
    const std::size_t step = axis.values.size() > kBatch ? axis.values.size() - 1 : 1;
    for (std::size_t i = 0; i < axis.values.size(); i += step)
      blaming(study, axis.where, axis.key, [&] {
        if (axis.key == kMachineKey) {
          prepare(catalogue, study, std::get<std::string>(axis.values[i]), level, study.settings);
          return;
        }
        std::vector<std::string> settings = study.settings;
        settings.push_back(axis.key + "=" + config::to_text(axis.values[i]));
        prepare(catalogue, study, machine, level, settings);
      });
  }
}

void check_outputs(const Study& study, const SweepRow& row) {
  // A level without time has no phases and units, and a study may ask for them at its other levels.
  if (!row.refused.empty() || row.level == level_name(Level::kFunction)) return;
  std::vector<std::string> names;
  for (const auto& [name, value] : row.figures) names.push_back(name);
  for (const std::string& output : study.outputs)
    for (const std::string& figure : figures_of(output))
      if (row.figures.count(figure) == 0 && !may_be_missing(figure))
        throw UserError(study.outputs_where.file, study.outputs_where.line, "outputs",
                        "runs have no figure `" + figure + "`" + config::did_you_mean(figure, names));
}

/// True when it was not there before.
bool make_folder(const std::string& folder) {
  std::error_code error;
  const bool made = fs::create_directories(folder, error);
  if (error) throw UserError(folder, 0, "", "cannot write here: " + error.message());
  return made;
}

/// A folder that was made for nothing goes again.
void remove_folder(const std::string& folder) {
  std::error_code error;
  fs::remove(fs::path(folder) / "results.sqlite", error);
  fs::remove(folder, error);
}

class Sweeper {
 public:
  Sweeper(const Catalogue& catalogue, const Study& study, const SweepOptions& options, Progress* progress)
      : catalogue_(catalogue),
        study_(study),
        options_(options),
        progress_(progress),
        results_(options.folder + "/results.sqlite"),
        git_(git_state()) {}

  SweepOutcome run() {
    outcome_.rows.resize(study_.runs());
    show();
    for (std::size_t from = 0; from < study_.runs(); from += kBatch)
      run_batch(from, std::min(from + kBatch, study_.runs()));
    if (progress_) progress_->clear();
    for (const SweepRow& row : outcome_.rows) outcome_.refused += row.refused.empty() ? 0 : 1;
    if (outcome_.refused == study_.runs())
      throw UserError(study_.file, 0, "", "every run is refused: " + outcome_.rows.front().refused);
    return std::move(outcome_);
  }

  bool has_results() const { return outcome_.made > 0; }

 private:
  struct Open {
    std::size_t run;
    std::string key;
    RunRequest request;
  };

  void run_batch(std::size_t from, std::size_t to) {
    std::vector<Open> open;
    for (std::size_t run = from; run < to; ++run) {
      check_interrupt();
      look_up(run, open);
    }
    std::vector<std::function<std::string()>> tasks;
    for (const Open& o : open) tasks.push_back([&o] { return to_bytes(execute(o.request, "", nullptr)); });
    show();
    run_in_workers(tasks, options_.jobs,
                   [&](std::size_t n, const Outcome& outcome) { finished(open[n], outcome); });
  }

  /// Takes the run from the folder, or leaves it in `open`.
  void look_up(std::size_t run, std::vector<Open>& open) {
    SweepRow& row = outcome_.rows[run];
    try {
      Open o{run, "", prepare(catalogue_, study_, study_.machine_of(run), study_.level_of(run), study_.settings_of(run))};
      o.key = RunCache::key(o.request);
      if (auto found = results_.find(o.key)) {
        row = std::move(*found);
        check_outputs(study_, row);
        ++outcome_.found;
      } else {
        open.push_back(std::move(o));
      }
    } catch (const UserError& error) {
      if (error.file() != "--set") throw;
      row.refused = reason(error);
      row.level = study_.level_of(run);
      row.git = git_;
    }
  }

  void finished(const Open& open, const Outcome& outcome) {
    SweepRow& row = outcome_.rows[open.run];
    row = outcome.error ? refused_row(open.request, reason(*outcome.error), git_)
                        : row_of(open.request, from_bytes(outcome.bytes), git_);
    // Two points may be the same run: a parameter and the one that follows it, say.
    if (!results_.has(open.key)) results_.store(open.key, row, study_.settings_of(open.run));
    ++outcome_.made;
    check_outputs(study_, row);
    show();
  }

  void show() {
    if (progress_) progress_->runs(study_.name, outcome_.made, study_.runs() - outcome_.found);
  }

  const Catalogue& catalogue_;
  const Study& study_;
  const SweepOptions& options_;
  Progress* progress_;
  SweepResults results_;
  std::string git_;
  SweepOutcome outcome_;
};

}  // namespace

SweepOutcome sweep(const Catalogue& catalogue, const Study& study, const SweepOptions& options, Progress* progress) {
  check_settings(catalogue, study);
  const bool made = make_folder(options.folder);
  std::optional<Sweeper> sweeper;
  try {
    sweeper.emplace(catalogue, study, options, progress);
    return sweeper->run();
  } catch (...) {
    const bool without_result = !sweeper || !sweeper->has_results();
    sweeper.reset();
    if (made && without_result) remove_folder(options.folder);
    throw;
  }
}

double output_of(const SweepRow& row, const std::string& output) {
  const std::vector<std::string> figures = figures_of(output);
  std::vector<double> values;
  for (const std::string& figure : figures) {
    const auto found = row.figures.find(figure);
    values.push_back(found == row.figures.end() ? std::numeric_limits<double>::quiet_NaN() : found->second);
  }
  return values.size() == 1 ? values[0] : values[0] / values[1];
}

}  // namespace dendro::study
