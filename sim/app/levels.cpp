#include "sim/study/levels.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "sim/app/arguments.h"
#include "sim/app/commands.h"
#include "sim/study/run_folder.h"

namespace dendro::app {
namespace {

struct Options {
  study::RunArguments run;
  double budget = 0;
  std::string json, progress = "auto";
};

int compare(const study::Catalogue& catalogue, const Options& options) {
  study::OutputFile json(options.json);
  study::Progress progress(options.progress);
  const auto rows = study::compare_levels(catalogue, options.run, options.budget, &progress);
  if (options.json != "-") std::fputs(study::levels_text(rows).c_str(), stdout);
  json.commit(study::levels_json(rows));
  return kGood;
}

}  // namespace

void add_levels(CLI::App& app, const study::Catalogue& catalogue, Action& action) {
  const auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("levels", "speed against error of every level, on one scene");
  command->add_option("scene", o->run.scene, "built-in scene or scene file")->required();
  command->add_option("--machine", o->run.machine, "NAME[:PRESET] or FILE.toml; default: the scene's")
      ->check(some_text());
  command->add_option("--set", o->run.settings, "key=value of the scene")->allow_extra_args(false);
  command->add_option("--budget", o->budget, "host seconds; levels beyond it are skipped")
      ->check(finite_number(0, true));
  command->add_option("--json", o->json, "also write the rows here; - is standard output")
      ->check(some_text());
  command->add_option("--progress", o->progress, "auto, on or off")
      ->check(CLI::IsMember({"auto", "on", "off"}));
  command->callback(
      [&catalogue, &action, o] { action = [&catalogue, o] { return compare(catalogue, *o); }; });
}

}  // namespace dendro::app
