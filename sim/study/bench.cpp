#include "sim/study/bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "sim/base/error.h"

namespace dendro::study {
namespace {

using Json = nlohmann::ordered_json;

using Settings = std::vector<std::string>;

struct Work {
  const char* machine;
  const char* scene;
  Settings settings, clocked;  ///< beside the scene's; `clocked` comes on top at that level
  bool views = false;          ///< the scene's programs work on views, which are made once
};

/// What each machine is measured on. The magnolia: one frame of 400 x 400 from four views of three layers,
/// with shadows; at `clocked` a 16th of its samples and pixels.
const std::vector<Work>& works() {
  static const std::vector<Work> all = {
      {"rds3000", "icosahedron", {}, {}},
      {"pixel-planes", "grove", {}, {}},
      {"sgi-4d35",
       "magnolia",
       {"image.width=400", "image.height=400", "zbuffer_views.bands=4", "zbuffer_views.layers=3"},
       {"image.width=100", "image.height=100", "zbuffer_views.view_width=76",
        "zbuffer_views.view_height=152"},
       true}};
  return all;
}

/// A folder that is removed with everything in it.
class TemporaryFolder {
 public:
  TemporaryFolder() : path_((std::filesystem::temp_directory_path() / "dendro-bench-XXXXXX").string()) {
    if (::mkdtemp(path_.data()) == nullptr) throw UserError(path_, 0, "", "cannot be made");
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

BenchRow best_of(const RunRequest& request, int repeats, Progress* progress) {
  BenchRow best;
  best.machine = request.type->name;
  best.level = level_name(request.level);
  best.work = request.file.scene.name;
  for (int i = 0; i < repeats; ++i) {
    const stats::RunObject run = execute_in_worker(request, "", progress).object;
    const stats::HostInfo& host = run.host;
    if (host.simulated_hz <= best.simulated_hz) continue;
    best.simulated_hz = host.simulated_hz;
    best.real_time_factor = host.real_time_factor;
    best.ticks = static_cast<double>(run.cycles > 0 ? run.cycles : run.instructions);
    best.host_seconds = host.seconds;
    best.peak_rss_bytes = host.peak_rss_bytes;
  }
  return best;
}

RunRequest request_of(const Catalogue& catalogue, const Work& work, Settings settings, const Settings& more) {
  RunArguments arguments;
  arguments.scene = work.scene;
  arguments.machine = work.machine;
  arguments.settings = work.settings;
  arguments.settings.insert(arguments.settings.end(), more.begin(), more.end());
  arguments.settings.insert(arguments.settings.end(), settings.begin(), settings.end());
  return prepare_run(catalogue, arguments);
}

/// The level named, if any of the measured machines has it; else throws UserError.
Level any_level(const std::string& name, const Catalogue& catalogue) {
  const MachineType* last = nullptr;
  for (const Work& work : works()) {
    last = catalogue.machine(work.machine);
    for (const Level level : last->levels)
      if (name == level_name(level)) return level;
  }
  return level_of(name, *last);
}

/// The same run with views that are there already: they are made here, into `folder`.
RunRequest with_views(const Catalogue& catalogue, const Work& work, const Settings& settings, Settings more,
                      const std::string& folder, Progress* progress) {
  Settings save = more;
  save.push_back("zbuffer_views.save_views=true");
  RunRequest request = request_of(catalogue, work, settings, save);
  request.level = Level::kFunction;
  execute_in_worker(request, folder, progress);
  more.push_back("zbuffer_views.views=" + folder + "/views.zbv");
  request = request_of(catalogue, work, settings, more);
  request.with_picture = false;
  return request;
}

void compare_estimate(std::vector<BenchRow>& rows) {
  for (BenchRow& row : rows) {
    if (row.level != level_name(Level::kEstimate)) continue;
    for (const BenchRow& exact : rows) {
      if (exact.machine != row.machine || exact.level != level_name(Level::kCycle)) continue;
      row.times_cycle = exact.host_seconds / row.host_seconds;
      row.tick_error = row.ticks / exact.ticks - 1;
    }
  }
}

}  // namespace

std::vector<BenchRow> bench(const Catalogue& catalogue, const std::string& machine, const std::string& level,
                            const std::vector<std::string>& settings, int repeats, Progress* progress) {
  std::vector<BenchRow> rows;
  std::string names;
  for (const Work& work : works()) {
    names += (names.empty() ? "" : ", ") + std::string(work.machine);
    if (!machine.empty() && machine != work.machine) continue;
    const MachineType& type = *request_of(catalogue, work, settings, {}).type;
    std::vector<Level> levels = type.levels;
    if (!level.empty()) {
      const Level only = machine.empty() ? any_level(level, catalogue) : level_of(level, type);
      if (std::find(levels.begin(), levels.end(), only) == levels.end()) continue;
      levels = {only};
    }
    std::optional<RunRequest> same;
    const TemporaryFolder views, clocked_views;
    for (const Level l : levels) {
      const bool clocked = l == Level::kClocked;
      if (!same || clocked) {
        const Settings more = clocked ? work.clocked : Settings();
        same = work.views ? with_views(catalogue, work, settings, more,
                                       clocked ? clocked_views.path() : views.path(), progress)
                          : request_of(catalogue, work, settings, more);
      }
      same->level = l;
      rows.push_back(best_of(*same, clocked ? 1 : repeats, progress));
    }
  }
  if (rows.empty())
    throw UserError("--machine", 0, "",
                    fmt::format("no machine `{}` is measured: known are {}", machine, names));
  compare_estimate(rows);
  if (progress) progress->clear();
  return rows;
}

std::string bench_json(const std::vector<BenchRow>& rows) {
  Json list = Json::array();
  for (const BenchRow& row : rows) {
    list.push_back({{"machine", row.machine},
                    {"level", row.level},
                    {"work", row.work},
                    {"ticks", row.ticks},
                    {"simulated_hz", row.simulated_hz},
                    {"real_time_factor", row.real_time_factor},
                    {"host_seconds", row.host_seconds},
                    {"peak_rss_bytes", row.peak_rss_bytes}});
    if (!row.times_cycle) continue;
    list.back()["times_cycle"] = *row.times_cycle;
    list.back()["tick_error"] = *row.tick_error;
  }
  return Json({{"schema", 1}, {"command", "bench"}, {"rows", list}}).dump(1) + "\n";
}

std::string bench_text(const std::vector<BenchRow>& rows) {
  std::string text = fmt::format("{:<14}{:<10}{:<14}{:>22}{:>18}{:>10}{:>9}\n", "machine", "level", "work",
                                 "million ticks / s", "times real time", "host s", "MB");
  for (const BenchRow& row : rows)
    text += fmt::format("{:<14}{:<10}{:<14}{:>22.1f}{:>18.2f}{:>10.2f}{:>9}\n", row.machine, row.level,
                        row.work, row.simulated_hz / 1e6, row.real_time_factor, row.host_seconds,
                        row.peak_rss_bytes / 1000000);
  for (const BenchRow& row : rows)
    if (row.times_cycle)
      text += fmt::format("{} at estimate: {:.2f} times as fast as cycle, its ticks differ by {:.3f} %\n",
                          row.machine, *row.times_cycle, 100 * *row.tick_error);
  return text;
}

}  // namespace dendro::study
