#include "sim/study/stability.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <optional>

#include "sim/app/commands.h"
#include "sim/study/run_folder.h"
#include "sim/study/worker.h"

namespace dendro::app {
namespace {

struct Options {
  study::StabilityOptions stability;
  std::string out, json, progress = "auto";
};

void write_folder(study::RunFolder& folder, const std::vector<stability::Result>& results) {
  folder.write("stability.json", study::stability_json(results));
  folder.write("stability.csv", study::stability_csv(results));
  folder.write("summary.txt", study::stability_text(results));
  for (const stability::Result& result : results)
    for (const stability::Curve& curve : result.curves) {
      folder.write(curve.name + ".csv", study::curve_csv(curve));
      if (!curve.y_label.empty())
        folder.writing([&] { study::write_curve_picture(curve, folder.work() + "/" + curve.name + ".png"); });
    }
  folder.commit();
}

int check(const study::Catalogue& catalogue, const Options& options) {
  if (options.stability.cases == std::vector<std::string>{"list"}) {
    fmt::print("{}", study::stability_list(study::stability_suites()));
    return kGood;
  }
  study::OutputFile json(options.json);
  std::optional<study::RunFolder> folder;
  if (!options.out.empty()) folder.emplace(options.out);
  study::Progress progress(options.progress);
  const auto results =
      study::run_stability(catalogue, study::stability_suites(), options.stability, &progress);
  if (options.json != "-") fmt::print("{}", study::stability_text(results));
  if (folder) write_folder(*folder, results);
  json.commit(study::stability_json(results));
  return study::all_pass(results) ? kGood : kComparisonFailed;
}

}  // namespace

void add_stability(CLI::App& app, const study::Catalogue& catalogue, Action& action) {
  const auto o = std::make_shared<Options>();
  o->stability.jobs = study::default_jobs();
  CLI::App* command =
      app.add_subcommand("stability", "the hard numerical cases: measured error beside its bound");
  command->add_option("case", o->stability.cases, "ids, such as N-A1 or X2; default: all; `list` names them");
  command->add_option("--out", o->out, "folder for rows, curves and their pictures");
  command->add_option("--json", o->json, "also write the rows here; - is standard output");
  command->add_option("--seed", o->stability.seed, "of the random cases");
  command->add_option("--jobs", o->stability.jobs, "worker processes")->check(CLI::Range(1, 1024));
  command->add_option("--progress", o->progress, "auto, on or off")
      ->check(CLI::IsMember({"auto", "on", "off"}));
  command->callback([&catalogue, &action, o] { action = [&catalogue, o] { return check(catalogue, *o); }; });
}

}  // namespace dendro::app
