#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "sim/app/arguments.h"
#include "sim/app/commands.h"
#include "sim/base/error.h"
#include "sim/study/cache.h"
#include "sim/study/interval.h"
#include "sim/study/run_folder.h"
#include "sim/study/timeline.h"
#include "sim/study/worker.h"

namespace dendro::app {
namespace {

struct Options {
  study::RunArguments run;
  bool interval = false;
  std::string out, json, progress = "auto";
  std::string vcd_units, timeline;
  bool quiet = false;
  int jobs = study::default_jobs();
};

std::vector<std::string> split_units(const std::string& list) {
  std::vector<std::string> units;
  std::string unit;
  for (const char c : list + ",") {
    if (c != ',') {
      unit += c;
    } else if (!unit.empty()) {
      units.push_back(unit);
      unit.clear();
    }
  }
  return units;
}

void add_interval(const study::RunRequest& request, int jobs, study::Progress& progress,
                  stats::RunObject& object) {
  const std::vector<study::Metric> metrics = {
      {"seconds", [](const stats::RunObject& run) { return run.seconds; }}};
  const auto interval =
      study::propagate(request, object, metrics, study::worker_runs(jobs, &progress, request.file.scene.name))
          .front();
  object.seconds_low = interval.low;
  object.seconds_high = interval.high;
  object.contributions = interval.contributions;
  object.interval_notes = interval.notes;
}

int run(const study::Catalogue& catalogue, Options options) {
  check_window(options.run.options);
  options.run.options.vcd_units = split_units(options.vcd_units);
  study::RunRequest request = study::prepare_run(catalogue, options.run);
  if (options.interval && request.level == Level::kFunction)
    throw UserError("--interval", 0, "", "there is no time at --level function");
  study::RunFolder folder(options.out.empty() ? "out/" + request.file.scene.name : options.out);
  if (!options.timeline.empty() && request.level == Level::kFunction)
    throw UserError("--timeline", 0, "", "there is no time at --level function");
  study::OutputFile json(options.json), waveform(request.options.vcd_file), timeline(options.timeline);
  request.options.vcd_file = waveform.work();
  if (!options.timeline.empty()) request.options.activity = study::kTimelineWindows;
  study::Progress progress(options.progress);
  study::expect_ticks(request, progress);
  study::RunOutput output =
      folder.writing([&] { return study::execute_in_worker(request, folder.work(), &progress); });
  progress.clear();
  output.object.image.path = folder.path() + "/image.png";
  request.options.vcd_file.clear();  // waveform and timeline are the nominal run's
  request.options.activity = 0;
  if (options.interval) add_interval(request, options.jobs, progress, output.object);

  const std::string object = stats::to_json(output.object) + "\n";
  const std::string summary = stats::to_summary(output.object) + "  files in " + folder.path() + "\n";
  folder.write("stats.json", object);
  folder.write("stats.csv", stats::to_csv(output.object));
  folder.write("summary.txt", summary);
  folder.write("resolved.toml", study::resolved_scene(request, output, folder.path()));
  if (!options.timeline.empty())
    folder.writing([&] { scene::write_png(folder.work() + "/timeline.png", study::timeline_picture(output)); });
  // All that can fail for want of space comes before anything is put in place.
  json.write(object);
  timeline.write(options.timeline.empty() ? "" : study::timeline_json(output));
  folder.commit();
  waveform.commit();
  if (!options.quiet) std::fputs(summary.c_str(), stdout);
  timeline.commit();
  json.commit();
  return kGood;
}

}  // namespace

void add_run(CLI::App& app, const study::Catalogue& catalogue, Action& action) {
  const auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("run", "draw a scene and say how long the machine took");
  MachineOptions& machine = o->run.options;
  command->add_option("scene", o->run.scene, "built-in scene or scene file")->required();
  command->add_option("--machine", o->run.machine, "NAME[:PRESET] or FILE.toml; default: the scene's")
      ->check(some_text());
  command
      ->add_option("--level", o->run.level,
                   "function, estimate, cycle or clocked; default: the scene's, else cycle")
      ->check(some_text());
  command->add_option("--set", o->run.settings, "key=value of the scene; parameters.* are the machine's")
      ->allow_extra_args(false);
  command->add_option("--seed", o->run.seed, "of everything random")->check(whole_number(0));
  command->add_flag("--interval", o->interval, "propagate the ranges of all assumptions");
  command->add_flag("--cost", machine.cost, "also draw where the ticks went, pixel by pixel; --level cycle");
  command->add_option("--timeline", o->timeline, "phases and activity of the units as a Chrome trace, for ui.perfetto.dev")
      ->check(some_text());
  command->add_option("--out", o->out, "run directory; default: out/SCENE")->check(some_text());
  command->add_option("--json", o->json, "also write the run object here; - is standard output")
      ->check(some_text());
  command->add_option("--progress", o->progress, "auto, on or off")
      ->check(CLI::IsMember({"auto", "on", "off"}));
  command->add_flag("!--no-cache", o->run.use_cache, "make views of trees again that an earlier run left in the cache, and leave none there");
  command->add_flag("--quiet", o->quiet, "print nothing");
  command->add_option("--jobs", o->jobs, "worker processes of --interval")->check(whole_number(1, 1024));
  command->add_option("--limit", machine.tick_limit, "ticks the processor may run in one start")
      ->check(whole_number(1));
  command->add_flag("--all-units", machine.all_units, "elaborate units that the scene does not use, too");
  add_waveform(*command, machine);
  command->add_option("--vcd-units", o->vcd_units, "units in the waveform, separated by commas")
      ->check(some_text())
      ->needs("--vcd");
  command->callback([&catalogue, &action, o] { action = [&catalogue, o] { return run(catalogue, *o); }; });
}

}  // namespace dendro::app
