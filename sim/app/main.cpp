#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "sim/app/commands.h"
#include "sim/app/machines.h"
#include "sim/base/error.h"
#include "sim/study/worker.h"

namespace {

// SystemC prints its banner when its first object is made; nothing of ours may come before this.
__attribute__((constructor(101))) void silence_systemc() {
  ::setenv("SYSTEMC_DISABLE_COPYRIGHT_MESSAGE", "1", 1);
}

std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

int say(int status, const std::string& text) {
  std::fflush(stdout);
  if (!text.empty()) std::fprintf(stderr, "dendro: %s\n", one_line(text).c_str());
  return status;
}

/// Standard output that could not be written is an error, whatever the action says.
int flushed(int status) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
  return say(dendro::app::kUserError, "standard output: cannot write: the disk is full or it was closed");
}

int guarded(const dendro::app::Action& action) {
  std::error_code gone;
  const auto folder = std::filesystem::current_path(gone);
  if (gone || folder.empty())
    return say(dendro::app::kUserError, "the working directory cannot be used: " + gone.message());
  try {
    return flushed(action());
  } catch (const dendro::UserError& error) {
    return say(dendro::app::kUserError, error.what());
  } catch (const dendro::study::Interrupted& interrupted) {
    return say(128 + interrupted.signal_number, "interrupted");
  } catch (const dendro::study::WorkerCrash& crash) {
    const std::string what = crash.what();
    return say(dendro::app::kBug, what.empty() ? "" : "bug: " + what);
  } catch (const std::exception& error) {
    return say(dendro::app::kBug, std::string("bug: ") + error.what());
  }
}

std::string names_of(const CLI::App& app) {
  std::string names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names += (names.empty() ? "" : ", ") + command->get_name();
  return names;
}

/// What is wrong with the command line, in one line.
std::string complaint(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  const std::string first = argc > 1 ? argv[1] : "";
  if (app.get_subcommands().empty() && (first.empty() || first[0] != '-'))
    return (first.empty() ? "a command is missing" : first + ": there is no such command") + ": known are " +
           names_of(app);
  if (app.get_subcommands().empty()) return first + ": unknown option (dendro --help says what is allowed)";
  const std::string command =
      app.get_subcommands().empty() ? "" : " " + app.get_subcommands().front()->get_name();
  return std::string(error.what()) + " (dendro" + command + " --help says what is allowed)";
}

}  // namespace

int main(int argc, char** argv) {
  using namespace dendro;
  study::catch_interrupts();
  const study::Catalogue catalogue = {app::machines(), study::algorithms(), study::share_folder()};
  CLI::App command{
      "dendro: a cycle-level simulator of the graphics machines on which computer-graphics trees were first "
      "drawn",
      "dendro"};
  command.require_subcommand(1);
  command.set_version_flag("--version", "dendro 0.1.0");
  app::Action action;
  app::add_run(command, catalogue, action);
  app::add_lists(command, catalogue, action);
  app::add_table(command, catalogue, action);
  app::add_levels(command, catalogue, action);
  app::add_stability(command, catalogue, action);
  app::add_sweep(command, catalogue, action);
  app::add_compare(command, action);
  app::add_exec(command, catalogue, action);
  app::add_record(command, catalogue, action);
  app::add_replay(command, catalogue, action);
  app::add_asm(command, catalogue, action);
  app::add_bench(command, catalogue, action);
  try {
    command.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return command.exit(error);
    return say(app::kUserError, complaint(command, error, argc, argv));
  }
  return guarded(action);
}
