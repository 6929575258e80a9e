#include "sim/study/compare.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "sim/app/arguments.h"
#include "sim/app/commands.h"
#include "sim/study/run_folder.h"

namespace dendro::app {
namespace {

struct Options {
  std::string first, second, out, json;
  bool quiet = false;
};

int compare(const Options& options) {
  const study::DrawnRun first = study::read_drawn_run(options.first), second = study::read_drawn_run(options.second);
  const study::Comparison comparison = study::compare_runs(first, second);
  study::OutputFile json(options.json);
  if (!options.out.empty()) study::write_picture(options.out, study::comparison_picture(first, second, comparison));
  if (!options.quiet && options.json != "-")
    std::fputs(study::comparison_text(first, second, comparison).c_str(), stdout);
  json.commit(study::comparison_json(first, second, comparison));
  return kGood;
}

}  // namespace

void add_compare(CLI::App& app, Action& action) {
  const auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("compare", "where two runs of a scene differ from double precision, and each other");
  command->add_option("first", o->first, "run directory of `dendro run`")->required()->check(some_text());
  command->add_option("second", o->second, "another one, of another machine, level or setting")->required()->check(some_text());
  command->add_option("--out", o->out, "picture of the wrong pixels, PNG")->check(some_text());
  command->add_option("--json", o->json, "also write the figures here; - is standard output")->check(some_text());
  command->add_flag("--quiet", o->quiet, "print nothing");
  command->callback([&action, o] { action = [o] { return compare(*o); }; });
}

}  // namespace dendro::app
