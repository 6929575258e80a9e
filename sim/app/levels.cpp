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
  std::string out, json, progress = "auto";
};

int compare(const study::Catalogue& catalogue, const Options& options) {
  const std::string scene = study::prepare_run(catalogue, options.run).file.scene.name;
  study::RunFolder folder(options.out.empty() ? "out/levels/" + scene : options.out);
  study::OutputFile json(options.json);
  study::Progress progress(options.progress);
  const auto rows = study::compare_levels(catalogue, options.run, options.budget, &progress);
  const std::string object = study::levels_json(rows), text = study::levels_text(rows);
  folder.writing([&] { scene::write_png(folder.work() + "/levels.png", study::levels_picture(scene, rows)); });
  folder.write("levels.csv", study::levels_csv(rows));
  folder.write("levels.json", object);
  folder.write("summary.txt", text);
  json.write(object);
  folder.commit();
  if (options.json != "-") std::printf("%sfiles in %s\n", text.c_str(), folder.path().c_str());
  json.commit();
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
  command->add_option("--out", o->out, "folder of the table and its picture; default: out/levels/SCENE")
      ->check(some_text());
  command->add_option("--json", o->json, "also write the rows here; - is standard output")
      ->check(some_text());
  command->add_option("--progress", o->progress, "auto, on or off")
      ->check(CLI::IsMember({"auto", "on", "off"}));
  command->callback(
      [&catalogue, &action, o] { action = [&catalogue, o] { return compare(catalogue, *o); }; });
}

}  // namespace dendro::app
