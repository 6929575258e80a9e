#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "sim/app/commands.h"
#include "sim/app/machines.h"
#include "sim/base/error.h"
#include "sim/study/worker.h"

namespace {

// SystemC prints its banner when its first object is made; nothing of ours may come before this.
__attribute__((constructor(101))) void silence_systemc() { ::setenv("SYSTEMC_DISABLE_COPYRIGHT_MESSAGE", "1", 1); }

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

int guarded(const dendro::app::Action& action) {
  try {
    return action();
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

}  // namespace

int main(int argc, char** argv) {
  using namespace dendro;
  study::catch_interrupts();
  const study::Catalogue catalogue = {app::machines(), study::algorithms(), study::share_folder()};
  CLI::App app{"dendro: a cycle-level simulator of the graphics machines on which computer-graphics trees were first drawn",
               "dendro"};
  app.require_subcommand(1);
  app.set_version_flag("--version", "dendro 0.1.0");
  app::Action action;
  app::add_run(app, catalogue, action);
  app::add_lists(app, catalogue, action);
  app::add_table(app, catalogue, action);
  app::add_levels(app, catalogue, action);
  app::add_exec(app, catalogue, action);
  app::add_asm(app, catalogue, action);
  app::add_bench(app, catalogue, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(error);
    return say(app::kUserError, std::string(error.what()) + " (dendro --help and dendro COMMAND --help say what is allowed)");
  }
  return guarded(action);
}
