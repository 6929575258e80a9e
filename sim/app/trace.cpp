#include "sim/study/trace.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "sim/app/arguments.h"
#include "sim/app/commands.h"
#include "sim/base/error.h"
#include "sim/study/run_folder.h"

namespace dendro::app {
namespace {

struct RecordOptions {
  study::RecordArguments record;
  std::vector<std::string> exec, settings;
  std::string out, progress = "auto";
  bool quiet = false;
};

int record(const study::Catalogue& catalogue, RecordOptions options) {
  study::RecordArguments& arguments = options.record;
  const bool scene = !arguments.run.scene.empty();
  if (scene != options.exec.empty()) throw UserError("give a scene, or --exec MACHINE PROGRAM");
  arguments.run.settings = arguments.exec.settings = options.settings;
  if (!scene) {
    if (!arguments.run.machine.empty()) throw UserError("--machine", 0, "", "--exec names the machine");
    arguments.exec.machine = options.exec.at(0);
    arguments.exec.program = options.exec.at(1);
    arguments.exec.arguments.assign(options.exec.begin() + 2, options.exec.end());
    arguments.exec.options = arguments.run.options;
  }
  study::OutputFile out(options.out);
  study::Progress progress(options.progress);
  const study::Recorded recorded = study::record_trace(catalogue, arguments, &progress);
  progress.clear();
  out.commit(recorded.bytes);
  if (!options.quiet && options.out != "-")
    fmt::print("{}: {} records in {} bytes: {}\n", arguments.boundary, recorded.records, recorded.bytes.size(), options.out);
  return kGood;
}

struct ReplayOptions {
  study::ReplayArguments replay;
  std::string json, picture;
  bool print = false, quiet = false;
};

void print_trace(const study::Catalogue& catalogue, const std::string& path) {
  const auto trace = study::open_trace(catalogue, path);
  std::string text = trace::header_text(trace->header());
  trace::Record record;
  while (trace->next(record)) {
    trace::append_text(record, text);
    text += '\n';
    if (text.size() < 1 << 16) continue;
    std::fwrite(text.data(), 1, text.size(), stdout);
    text.clear();
  }
  std::fwrite(text.data(), 1, text.size(), stdout);
}

int replay(const study::Catalogue& catalogue, const ReplayOptions& options) {
  if (!options.replay.boundary.empty() && (options.print || !options.picture.empty()))
    throw UserError("--boundary", 0, "", "--print and --picture are of traces that dendro has written");
  if (options.print && options.json == "-") throw UserError("--json", 0, "", "standard output has the trace of --print");
  study::OutputFile json(options.json);
  const study::ReplayOutput output = study::replay_trace(catalogue, options.replay);
  if (options.print) print_trace(catalogue, options.replay.trace);
  if (!options.picture.empty())
    study::write_picture(options.picture, study::trace_picture(catalogue, options.replay.trace));
  json.commit(study::replay_json(output));
  std::fflush(stdout);
  if (output.result.difference) {
    fmt::print(stderr, "dendro: {}\n", *output.result.difference);
    return kComparisonFailed;
  }
  if (!options.quiet && !options.replay.boundary.empty() && options.json != "-") {
    fmt::print("{} level {}: {} accesses in {} cycles\n", output.unit, output.level, output.result.transactions,
               output.result.cycles);
    for (const std::string& line : output.summary) fmt::print("  {}\n", line);
    return kGood;
  }
  if (!options.quiet && !options.print && options.json != "-")
    fmt::print("{} level {}: {} transactions in {} cycles, no difference\n", output.unit, output.level,
               output.result.transactions, output.result.cycles);
  return kGood;
}

}  // namespace

void add_record(CLI::App& app, const study::Catalogue& catalogue, Action& action) {
  const auto o = std::make_shared<RecordOptions>();
  CLI::App* command = app.add_subcommand("record", "write down what passes the boundary of one unit");
  command->add_option("scene", o->record.run.scene, "built-in scene or scene file");
  command->add_option("--exec", o->exec, "MACHINE[:PRESET] PROGRAM [COMMAND]... instead of a scene")->expected(2, 1000);
  command->add_option("--boundary", o->record.boundary, "the unit, as rds3000.frame_memory")->required();
  command->add_option("--from", o->record.from, "first tick")->check(CLI::NonNegativeNumber);
  command->add_option("--to", o->record.to, "tick before which it ends")->check(CLI::NonNegativeNumber);
  command->add_option("--out", o->out, "the trace; - is standard output")->required();
  command->add_flag("--text", o->record.as_text, "one record per line instead of compressed");
  command->add_option("--machine", o->record.run.machine, "NAME[:PRESET] or FILE.toml");
  command->add_option("--set", o->settings, "key=value of scene or machine")->allow_extra_args(false);
  command->add_option("--seed", o->record.run.seed, "of everything random");
  command->add_option("--limit", o->record.run.options.tick_limit, "ticks the processor may run")->check(CLI::PositiveNumber);
  command->add_option("--progress", o->progress, "auto, on or off")->check(CLI::IsMember({"auto", "on", "off"}));
  command->add_flag("--quiet", o->quiet, "print no summary");
  command->callback([&catalogue, &action, o] { action = [&catalogue, o] { return record(catalogue, *o); }; });
}

void add_replay(CLI::App& app, const study::Catalogue& catalogue, Action& action) {
  const auto o = std::make_shared<ReplayOptions>();
  CLI::App* command = app.add_subcommand("replay", "drive one unit alone with a trace and check what it does");
  command->add_option("trace", o->replay.trace, "recorded or hand-written trace")->required();
  command->add_option("--boundary", o->replay.boundary, "of a memory trace from elsewhere: sgi_4d35.processor")
      ->check(some_text());
  command->add_option("--level", o->replay.level, "cycle or clocked");
  command->add_option("--set", o->replay.settings, "key=value of the machine")->allow_extra_args(false);
  command->add_option("--json", o->json, "also write the result here; - is standard output");
  command->add_option("--picture", o->picture, "also draw the operations over time, as PNG")->check(some_text());
  command->add_flag("--print", o->print, "print the trace as text");
  command->add_flag("--quiet", o->quiet, "print no summary");
  command->callback([&catalogue, &action, o] { action = [&catalogue, o] { return replay(catalogue, *o); }; });
}

}  // namespace dendro::app
