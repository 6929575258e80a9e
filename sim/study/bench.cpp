#include "sim/study/bench.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace dendro::study {
namespace {

using Json = nlohmann::ordered_json;

struct Work {
  const char* machine;
  const char* scene;
};

/// What each machine is measured on.
constexpr Work kWorks[] = {{"rds3000", "icosahedron"}, {"pixel-planes", "grove"}};

BenchRow best_of(const RunRequest& request, int repeats, Progress* progress) {
  BenchRow best{request.type->name, level_name(request.level), request.file.scene.name};
  for (int i = 0; i < repeats; ++i) {
    const stats::HostInfo host = execute_in_worker(request, "", progress).object.host;
    if (host.simulated_hz <= best.simulated_hz) continue;
    best.simulated_hz = host.simulated_hz;
    best.real_time_factor = host.real_time_factor;
    best.host_seconds = host.seconds;
    best.peak_rss_bytes = host.peak_rss_bytes;
  }
  return best;
}

}  // namespace

std::vector<BenchRow> bench(const Catalogue& catalogue, const std::string& level,
                            const std::vector<std::string>& settings, int repeats, Progress* progress) {
  std::vector<BenchRow> rows;
  for (const Work& work : kWorks) {
    RunArguments arguments;
    arguments.scene = work.scene;
    arguments.machine = work.machine;
    arguments.settings = settings;
    RunRequest request = prepare_run(catalogue, arguments);
    std::vector<Level> levels = request.type->levels;
    if (!level.empty()) levels = {level_of(level, *request.type)};
    for (const Level l : levels) {
      request.level = l;
      rows.push_back(best_of(request, l == Level::kClocked ? 1 : repeats, progress));
    }
  }
  if (progress) progress->clear();
  return rows;
}

std::string bench_json(const std::vector<BenchRow>& rows) {
  Json list = Json::array();
  for (const BenchRow& row : rows)
    list.push_back({{"machine", row.machine},
                    {"level", row.level},
                    {"work", row.work},
                    {"simulated_hz", row.simulated_hz},
                    {"real_time_factor", row.real_time_factor},
                    {"host_seconds", row.host_seconds},
                    {"peak_rss_bytes", row.peak_rss_bytes}});
  return Json({{"schema", 1}, {"command", "bench"}, {"rows", list}}).dump(1) + "\n";
}

std::string bench_text(const std::vector<BenchRow>& rows) {
  std::string text = fmt::format("{:<14}{:<10}{:<14}{:>22}{:>18}{:>10}{:>9}\n", "machine", "level", "work",
                                 "million ticks / s", "times real time", "host s", "MB");
  for (const BenchRow& row : rows)
    text += fmt::format("{:<14}{:<10}{:<14}{:>22.1f}{:>18.2f}{:>10.2f}{:>9}\n", row.machine, row.level,
                        row.work, row.simulated_hz / 1e6, row.real_time_factor, row.host_seconds,
                        row.peak_rss_bytes / 1000000);
  return text;
}

}  // namespace dendro::study
