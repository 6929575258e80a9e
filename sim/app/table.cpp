#include "sim/study/table.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "sim/app/arguments.h"
#include "sim/app/commands.h"
#include "sim/study/run_folder.h"
#include "sim/study/table_picture.h"

namespace dendro::app {
namespace {

struct Options {
  std::string key = "all";
  study::TableOptions table;
  std::string out, json, progress = "auto";
  std::optional<double> tolerance;
};

bool within(const std::vector<study::TableRow>& rows, double tolerance) {
  for (const study::TableRow& row : rows)
    if (const auto ratio = row.ratio(); ratio && std::abs(*ratio - 1) > tolerance) return false;
  return true;
}

void write_folder(study::RunFolder& folder, const std::vector<study::TableRow>& rows) {
  folder.write("table.json", study::table_json(rows));
  folder.write("summary.txt", study::table_text(rows));
  if (const auto picture = study::draw_table(rows)) scene::write_png(folder.work() + "/table.png", *picture);
  folder.commit();
}

int list_tables() {
  for (const study::PaperTable& table : study::paper_tables()) fmt::print("{:<8} {}\n", table.key, table.title);
  return kGood;
}

int make(const study::Catalogue& catalogue, const Options& options) {
  if (options.key == "list") return list_tables();
  const auto plan = study::table_plan(options.key);
  const study::RunCache cache;
  study::Progress progress(options.progress);
  const study::TableContext context = {catalogue, options.table, cache, &progress};
  study::check_table(options.key, context);
  study::OutputFile json(options.json);
  std::optional<study::RunFolder> folder;
  if (!options.out.empty()) folder.emplace(options.out);
  const bool print = options.json != "-";
  if (print && options.table.rows.empty()) {
    fmt::print("plan:\n");
    for (const std::string& line : plan) fmt::print("  {}\n", line);
    std::fflush(stdout);
  }
  const auto rows = study::make_table(options.key, context);
  if (print) fmt::print("{}{}", options.table.rows.empty() ? "\n" : "", study::table_text(rows));
  if (folder) write_folder(*folder, rows);
  json.commit(study::table_json(rows));
  return !options.tolerance || within(rows, *options.tolerance) ? kGood : kOutsideTolerance;
}

}  // namespace

void add_table(CLI::App& app, const study::Catalogue& catalogue, Action& action) {
  const auto o = std::make_shared<Options>();
  o->table.jobs = study::default_jobs();
  CLI::App* command = app.add_subcommand("table", "a paper's timing table beside the simulated one");
  command->add_option("key", o->key, "the paper's key, or all; list names the tables");
  command->add_flag("--full", o->table.full, "sample all assumptions at once, too");
  command->add_option("--level", o->table.level, "cycle or clocked")->check(some_text());
  command->add_option("--set", o->table.settings, "key=value, applied to every run")->allow_extra_args(false);
  command->add_option("--row", o->table.rows, "make this row only; several may be given")->allow_extra_args(false);
  command->add_option("--jobs", o->table.jobs, "worker processes")->check(whole_number(1, 1024));
  command->add_option("--tolerance", o->tolerance, "exit 3 when a ratio is further than this from 1")
      ->check(finite_number(0, false));
  command->add_option("--out", o->out, "folder for the rows and their picture")->check(some_text());
  command->add_option("--json", o->json, "also write the rows here; - is standard output")
      ->check(some_text());
  command->add_option("--progress", o->progress, "auto, on or off")
      ->check(CLI::IsMember({"auto", "on", "off"}));
  command->callback([&catalogue, &action, o] { action = [&catalogue, o] { return make(catalogue, *o); }; });
}

}  // namespace dendro::app
