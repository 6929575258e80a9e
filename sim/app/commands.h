#pragma once

#include <functional>
#include <string>

#include "sim/study/catalogue.h"

namespace CLI {
class App;
}

/// The subcommands of `dendro`, one file each. `add_*` declares a subcommand's options and leaves in `action`
/// what to do when it was chosen; that returns the exit status.
namespace dendro::app {

constexpr int kGood = 0;
constexpr int kComparisonFailed = 1;
constexpr int kUserError = 2;
constexpr int kOutsideTolerance = 3;
constexpr int kBug = 70;

using Action = std::function<int()>;

void add_run(CLI::App& app, const study::Catalogue& catalogue, Action& action);
void add_lists(CLI::App& app, const study::Catalogue& catalogue, Action& action);
void add_table(CLI::App& app, const study::Catalogue& catalogue, Action& action);
void add_levels(CLI::App& app, const study::Catalogue& catalogue, Action& action);
void add_stability(CLI::App& app, const study::Catalogue& catalogue, Action& action);
void add_sweep(CLI::App& app, const study::Catalogue& catalogue, Action& action);
void add_exec(CLI::App& app, const study::Catalogue& catalogue, Action& action);
void add_record(CLI::App& app, const study::Catalogue& catalogue, Action& action);
void add_replay(CLI::App& app, const study::Catalogue& catalogue, Action& action);
void add_asm(CLI::App& app, const study::Catalogue& catalogue, Action& action);
void add_compare(CLI::App& app, Action& action);
void add_bench(CLI::App& app, const study::Catalogue& catalogue, Action& action);

}  // namespace dendro::app
