#include "sim/study/exec.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "sim/app/arguments.h"
#include "sim/app/commands.h"
#include "sim/base/error.h"
#include "sim/study/run_folder.h"

namespace dendro::app {
namespace {

struct Options {
  study::ExecArguments exec;
  std::vector<std::string> dumps;
  std::string json, progress = "auto";
  bool quiet = false;
};

std::uint32_t number(const std::string& text, const std::string& whole) {
  std::size_t used = 0;
  unsigned long value = 0;
  try {
    if (!text.empty() && text[0] != '-') value = std::stoul(text, &used, 0);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used == 0 || used != text.size() || value > UINT32_MAX)
    throw UserError("--dump", 0, "",
                    "`" + whole + "` is not ADDRESS or ADDRESS:COUNT, as in 16, 16:8 or 0x10:8");
  return static_cast<std::uint32_t>(value);
}

/// What a program that has standard output for itself leaves on the other one.
void print_run(const study::ExecOutput& output) {
  const stats::RunObject& run = output.object;
  const double million = std::max(run.host.seconds, 1e-9) * 1e6;
  const std::string time =
      run.has_time()
          ? fmt::format("{} cycles = {}, {:.0f} million cycles/s", stats::grouped(run.cycles),
                        stats::readable_seconds(run.seconds), static_cast<double>(run.cycles) / million)
          : fmt::format("{:.0f} million/s, no time at this level", static_cast<double>(run.instructions) / million);
  fmt::print(stderr, "{}:{} level {}: {} instructions in {}, {}, exit code {}\n{}", run.machine, run.preset,
             run.level, stats::grouped(static_cast<std::int64_t>(run.instructions)),
             stats::readable_seconds(run.host.seconds), time, output.exit_code, study::cause_text(run));
  if (run.seconds_low)
    fmt::print(stderr, "99.7 % interval of the sampling: {} to {} cycles\n",
               stats::grouped(std::llround(*run.seconds_low * run.clock_hz)),
               stats::grouped(std::llround(*run.seconds_high * run.clock_hz)));
  for (const stats::PhaseRow& phase : run.phases)
    fmt::print(stderr, "phase {}: {} cycles\n", phase.name, stats::grouped(phase.cycles));
  if (!output.profile.empty()) fmt::print(stderr, "{}", study::profile_text(output.profile, run.cycles));
}

int execute(const study::Catalogue& catalogue, Options options) {
  for (const std::string& dump : options.dumps) {
    const auto colon = dump.find(':');
    const std::string count = colon == std::string::npos ? "1" : dump.substr(colon + 1);
    options.exec.dumps.emplace_back(number(dump.substr(0, colon), dump), number(count, dump));
    if (options.exec.dumps.back().second == 0)
      throw UserError("--dump", 0, "", "`" + dump + "` asks for 0 words; at least 1");
  }
  check_window(options.exec.options);
  study::OutputFile json(options.json), waveform(options.exec.options.vcd_file),
      log(options.exec.options.pipeline_file);
  options.exec.options.vcd_file = waveform.work();
  options.exec.options.pipeline_file = log.work();
  study::Progress progress(options.progress);
  const study::ExecOutput output = study::exec_program(catalogue, options.exec, &progress);
  progress.clear();
  waveform.commit();
  log.commit();
  for (const std::string& line : output.dump_lines) fmt::print("{}\n", line);
  const stats::RunObject& run = output.object;
  if (output.prints_output) {  // standard output is the program's
    if (!options.quiet) print_run(output);
    json.commit(study::exec_json(output));
    return output.exit_code;
  }
  if (!options.quiet && options.json != "-")
    fmt::print("{}:{} level {}: {} microinstructions, {}, exit code {}\n", run.machine, run.preset, run.level,
               stats::grouped(static_cast<std::int64_t>(run.instructions)),
               run.has_time()
                   ? stats::grouped(run.cycles) + " cycles = " + stats::readable_seconds(run.seconds)
                   : "no time at this level",
               output.exit_code);
  json.commit(study::exec_json(output));
  return kGood;
}

}  // namespace

void add_exec(CLI::App& app, const study::Catalogue& catalogue, Action& action) {
  const auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("exec", "run any program on a machine that has a processor, or whose host commands programs");
  MachineOptions& machine = o->exec.options;
  command->add_option("machine", o->exec.machine, "NAME[:PRESET] or FILE.toml")->required();
  command->add_option("program", o->exec.program, ".ucode file, .gia or .igc source; an ELF file for sgi-4d35")
      ->required();
  command->add_option("args", o->exec.arguments, "arguments of the program, after --; pixel-planes: commands, as NAME:A,B,C:guard=2 or REGISTER=VALUE");
  command->add_option("--level", o->exec.level, "function, cycle or clocked, ELF files also estimate; cycle where the machine has it")
      ->check(some_text());
  command->add_option("--set", o->exec.settings, "key=value of the machine")->allow_extra_args(false);
  command->add_option("--limit", machine.tick_limit, "ticks the processor may run, of ELF files instructions; 10,000,000,000 unless told")
      ->check(whole_number(1));
  command->add_option("--dump", o->dumps, "ADDRESS[:COUNT] scratch words, or pixels, to print; one without COUNT")
      ->allow_extra_args(false);
  command->add_option("--json", o->json, "also write the result here; - is standard output")
      ->check(some_text());
  command->add_option("--progress", o->progress, "auto, on or off")
      ->check(CLI::IsMember({"auto", "on", "off"}));
  command->add_flag("--profile", o->exec.profile, "ELF files, level cycle: cycles by function");
  command->add_option("--gdb", o->exec.gdb_port,
                      "ELF files: port of 127.0.0.1 to wait on for gdb-multiarch; 0: a free one")
      ->check(whole_number(0, 65535));
  command->add_flag("--quiet", o->quiet, "print no summary");
  add_waveform(*command, machine);
  add_pipeline_log(*command, machine);
  command->callback(
      [&catalogue, &action, o] { action = [&catalogue, o] { return execute(catalogue, *o); }; });
}

}  // namespace dendro::app
