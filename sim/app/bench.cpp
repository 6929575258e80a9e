#include "sim/study/bench.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "sim/app/arguments.h"
#include "sim/app/commands.h"
#include "sim/study/run_folder.h"

namespace dendro::app {
namespace {

struct Options {
  std::string machine, level, json, progress = "auto";
  std::vector<std::string> settings;
  int repeats = 3;
};

int measure(const study::Catalogue& catalogue, const Options& options) {
  study::OutputFile json(options.json);
  study::Progress progress(options.progress);
  const auto rows = study::bench(catalogue, options.machine, options.level, options.settings, options.repeats, &progress);
  if (options.json != "-") std::fputs(study::bench_text(rows).c_str(), stdout);
  json.commit(study::bench_json(rows));
  return kGood;
}

}  // namespace

void add_bench(CLI::App& app, const study::Catalogue& catalogue, Action& action) {
  const auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("bench", "host speed of each machine and level");
  command->add_option("--machine", o->machine, "only this machine")->check(some_text());
  command->add_option("--level", o->level, "only this level")->check(some_text());
  command->add_option("--set", o->settings, "key=value of the scene that is run")->allow_extra_args(false);
  command->add_option("--repeats", o->repeats, "runs, of which the best counts")
      ->check(whole_number(1, 1000));
  command->add_option("--json", o->json, "also write the rows here; - is standard output")
      ->check(some_text());
  command->add_option("--progress", o->progress, "auto, on or off")
      ->check(CLI::IsMember({"auto", "on", "off"}));
  command->callback(
      [&catalogue, &action, o] { action = [&catalogue, o] { return measure(catalogue, *o); }; });
}

}  // namespace dendro::app
