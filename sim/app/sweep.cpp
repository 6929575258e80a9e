#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>

#include "sim/app/commands.h"
#include "sim/base/error.h"
#include "sim/study/run_folder.h"
#include "sim/study/sweep.h"
#include "sim/study/sweep_report.h"
#include "sim/study/worker.h"

namespace dendro::app {
namespace {

constexpr std::size_t kShownRows = 40;

struct Options {
  std::string study, out, json, progress = "auto";
  bool yes = false, quiet = false, list = false;
  int jobs = study::default_jobs();
};

int list_studies() {
  for (const study::BuiltInStudy& s : study::built_in_studies())
    std::printf("%-24s %s\n", s.name.c_str(), s.description.c_str());
  return kGood;
}

void write_files(const study::Study& study, const study::SweepOutcome& outcome, const std::string& folder) {
  study::OutputFile csv(folder + "/results.csv");
  csv.commit(study::sweep_csv(study, outcome.rows));
  if (!study::has_picture(study)) return;
  for (const std::string& output : study.outputs) {
    std::string name = output;
    std::replace(name.begin(), name.end(), ' ', '-');
    study::write_picture(folder + "/" + name + ".png", study::sweep_picture(study, outcome.rows, output));
  }
}

int sweep(const study::Catalogue& catalogue, const Options& options) {
  if (options.list) return list_studies();
  const study::Study study = study::load_study(options.study, options.yes);
  const std::string folder = options.out.empty() ? "out/sweep/" + study.name : options.out;
  study::OutputFile json(options.json);
  study::Progress progress(options.progress);
  const study::SweepOutcome outcome = study::sweep(catalogue, study, {folder, options.jobs}, &progress);
  write_files(study, outcome, folder);
  if (!options.quiet && options.json != "-") {
    std::fputs(study::sweep_text(study, outcome.rows, kShownRows).c_str(), stdout);
    std::printf("%zu runs: %zu made, %zu there already, %zu refused; results.sqlite, results.csv%s in %s\n",
                outcome.rows.size(), outcome.made, outcome.found, outcome.refused,
                study::has_picture(study) ? " and pictures" : "", folder.c_str());
  }
  json.commit(study::sweep_json(study, outcome));
  return kGood;
}

}  // namespace

void add_sweep(CLI::App& app, const study::Catalogue& catalogue, Action& action) {
  const auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("sweep", "what-if: a grid of parameters, resumable, one row per run");
  CLI::Option* list = command->add_flag("--list", o->list, "list the studies that ship with dendro");
  CLI::Option* study = command->add_option("study", o->study, "built-in study or study file");
  command->add_option("--jobs", o->jobs, "worker processes")->check(CLI::Range(1, 1024));
  command->add_option("--out", o->out, "folder of the results; default: out/sweep/STUDY");
  command->add_flag("--yes", o->yes, "make more runs than 10,000");
  command->add_option("--json", o->json, "also write the rows here; - is standard output");
  command->add_option("--progress", o->progress, "auto, on or off")->check(CLI::IsMember({"auto", "on", "off"}));
  command->add_flag("--quiet", o->quiet, "print nothing");
  command->callback([&catalogue, &action, o, list, study] {
    if (list->count() == 0 && study->count() == 0) throw CLI::RequiredError("study");
    action = [&catalogue, o] { return sweep(catalogue, *o); };
  });
}

}  // namespace dendro::app
