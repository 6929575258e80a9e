#include "sim/study/levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "sim/stats/run_object.h"

namespace dendro::study {
namespace {

using Json = nlohmann::ordered_json;

struct Made {
  LevelRow row;
  std::optional<RunOutput> output;
};

/// Host time of a level is told from the level before it: function words to cycle ticks, cycle ticks to
/// clocked ones. The factors are generous, so that a budget is kept rather than used up.
double predicted_seconds(Level level, const std::optional<RunOutput>& before) {
  if (!before) return 0;
  const double factor = level == Level::kClocked ? 100.0 : 20.0;
  return before->object.host.seconds * factor;
}

void compare_with(const RunOutput& reference, Made& made) {
  if (!made.output) return;
  const RunOutput& run = *made.output;
  LevelRow& row = made.row;
  if (run.object.cycles > 0 && reference.object.cycles > 0)
    row.cycle_error = static_cast<double>(run.object.cycles - reference.object.cycles) /
                      static_cast<double>(reference.object.cycles);
  const bool same_size = run.rgb.size() == reference.rgb.size();
  double squares = 0;
  for (std::size_t pixel = 0; same_size && pixel < run.rgb.size(); pixel += 3) {
    bool different = false;
    for (std::size_t c = pixel; c < pixel + 3; ++c) {
      const double d = static_cast<double>(run.rgb[c]) - reference.rgb[c];
      squares += d * d;
      different = different || d != 0;
    }
    row.different_pixels += different ? 1 : 0;
  }
  if (!same_size) {
    row.different_pixels = static_cast<std::int64_t>(run.rgb.size() / 3);
    row.image_psnr_db = 0.0;
  } else if (squares > 0) {
    row.image_psnr_db = 10 * std::log10(255.0 * 255.0 * static_cast<double>(run.rgb.size()) / squares);
  }
}

}  // namespace

std::vector<LevelRow> compare_levels(const Catalogue& catalogue, const RunArguments& arguments, double budget,
                                     Progress* progress) {
  RunRequest request = prepare_run(catalogue, arguments);
  std::vector<Made> all;
  double spent = 0;
  std::optional<RunOutput> before;
  for (const Level level : {Level::kFunction, Level::kEstimate, Level::kCycle, Level::kClocked}) {
    Made made;
    made.row.level = level_name(level);
    const auto& has = request.type->levels;
    const double ahead = predicted_seconds(level, before);
    if (std::find(has.begin(), has.end(), level) == has.end()) {
      made.row.skipped = request.type->name + " has no such level";
    } else if (budget > 0 && spent + ahead > budget) {
      made.row.skipped = fmt::format("would take about {:.0f} s, the budget has {:.1f} s left", ahead,
                                     std::max(0.0, budget - spent));
    } else {
      request.level = level;
      made.output = execute_in_worker(request, "", progress);
      made.row.host_seconds = made.output->object.host.seconds;
      made.row.cycles = made.output->object.cycles;
      spent += made.row.host_seconds;
      before = made.output;
    }
    all.push_back(std::move(made));
  }
  if (progress) progress->clear();
  const RunOutput* reference = nullptr;
  for (const Made& made : all)
    if (made.output) reference = &*made.output;
  std::vector<LevelRow> rows;
  const std::optional<RunOutput>& clocked = all.back().output;
  for (Made& made : all) {
    if (reference) compare_with(*reference, made);
    if (made.output && clocked && made.row.host_seconds > 0)
      made.row.speedup_over_clocked = clocked->object.host.seconds / made.row.host_seconds;
    rows.push_back(made.row);
  }
  return rows;
}

std::string levels_json(const std::vector<LevelRow>& rows) {
  Json list = Json::array();
  for (const LevelRow& row : rows) {
    Json json;
    json["level"] = row.level;
    if (row.skipped) {
      for (const char* key : {"host_seconds", "cycles", "cycle_error", "interval", "image_psnr_db",
                              "different_pixels", "speedup_over_clocked"})
        json[key] = nullptr;
      json["skipped"] = *row.skipped;
    } else {
      json["host_seconds"] = row.host_seconds;
      const bool timed = row.level != level_name(Level::kFunction);
      json["cycles"] = timed ? Json(row.cycles) : Json(nullptr);
      json["cycle_error"] = timed ? Json(row.cycle_error) : Json(nullptr);
      json["interval"] = timed ? Json({row.cycles, row.cycles}) : Json(nullptr);
      json["image_psnr_db"] = row.image_psnr_db ? Json(*row.image_psnr_db) : Json(nullptr);
      json["different_pixels"] = row.different_pixels;
      json["speedup_over_clocked"] =
          row.speedup_over_clocked ? Json(*row.speedup_over_clocked) : Json(nullptr);
      json["skipped"] = nullptr;
    }
    list.push_back(json);
  }
  return Json({{"schema", 1}, {"command", "levels"}, {"rows", list}}).dump(1) + "\n";
}

std::string levels_text(const std::vector<LevelRow>& rows) {
  std::string text = fmt::format("{:<10}{:>10}{:>16}{:>14}{:>12}{:>18}{:>10}\n", "level", "host s", "cycles",
                                 "cycle error", "picture", "different pixels", "speed-up");
  for (const LevelRow& row : rows) {
    if (row.skipped) {
      text += fmt::format("{:<10}  skipped: {}\n", row.level, *row.skipped);
      continue;
    }
    text += fmt::format("{:<10}{:>10.3f}{:>16}{:>14}{:>12}{:>18}{:>10}\n", row.level, row.host_seconds,
                        row.cycles == 0 ? "no time" : stats::grouped(row.cycles),
                        row.cycles == 0 ? "" : fmt::format("{:.2g}", row.cycle_error),
                        row.image_psnr_db ? fmt::format("{:.1f} dB", *row.image_psnr_db) : "identical",
                        row.different_pixels,
                        row.speedup_over_clocked ? fmt::format("{:.1f}x", *row.speedup_over_clocked) : "");
  }
  return text;
}

}  // namespace dendro::study
