#include "sim/study/levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "sim/scene/chart.h"
#include "sim/scene/psnr.h"
#include "sim/stats/run_object.h"

namespace dendro::study {
namespace {

using Json = nlohmann::ordered_json;

struct Made {
  LevelRow row;
  std::optional<RunOutput> output;
};

/// Host time of a level is told from the level before it: function words to cycle ticks, cycle ticks to
/// clocked ones. The factors are about twice what scenes take, so that a budget is kept rather than used up.
double predicted_seconds(Level level, const std::optional<RunOutput>& before) {
  if (!before) return 0;
  const double factor = level == Level::kClocked ? 50.0 : 4.0;
  return before->object.host.seconds * factor;
}

void compare_with(const RunOutput& reference, Made& made) {
  if (!made.output) return;
  const RunOutput& run = *made.output;
  LevelRow& row = made.row;
  if (run.object.cycles > 0 && reference.object.cycles > 0)
    row.cycle_error = static_cast<double>(run.object.cycles - reference.object.cycles) /
                      static_cast<double>(reference.object.cycles);
  if (row.host_seconds > 0) row.speed = (reference.object.cycles > 0 ? reference.object.seconds : 1) / row.host_seconds;
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
  } else {
    row.image_psnr_db = scene::psnr(squares, run.rgb.size());
  }
  if (!run.rgb.empty())
    row.different_share = static_cast<double>(row.different_pixels) / (static_cast<double>(run.rgb.size()) / 3);
}

bool has_time(const LevelRow& row) { return !row.skipped && row.level != level_name(Level::kFunction); }

}  // namespace

std::vector<LevelRow> compare_levels(const Catalogue& catalogue, const RunArguments& arguments, double budget,
                                     Progress* progress) {
  RunRequest request = prepare_run(catalogue, arguments);
  std::vector<Made> all;
  // What a run takes beside what is compared: preparing, pictures, programs without time.
  double spent = 0, beside = 0;
  std::optional<RunOutput> before;
  for (const Level level : {Level::kFunction, Level::kEstimate, Level::kCycle, Level::kClocked}) {
    Made made;
    made.row.level = level_name(level);
    const auto& has = request.type->levels;
    const double ahead = predicted_seconds(level, before) + beside;
    if (std::find(has.begin(), has.end(), level) == has.end()) {
      made.row.skipped = request.type->name + " has no such level";
    } else if (budget > 0 && spent + ahead > budget) {
      made.row.skipped = fmt::format("would take about {:.0f} s, the budget has {:.1f} s left", ahead,
                                     std::max(0.0, budget - spent));
    } else {
      request.level = level;
      request.use_cache = false;  // each level is to do all of its own work
      // `clocked` takes the ticks that `cycle` took.
      if (progress) progress->expect(level == Level::kClocked && before ? before->object.cycles : 0);
      const auto start = std::chrono::steady_clock::now();
      made.output = execute_in_worker(request, "", progress);
      const double whole = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      made.row.host_seconds = made.output->object.host.seconds;
      made.row.cycles = made.row.low = made.row.high = made.output->object.cycles;
      if (const auto low = made.output->object.seconds_low) {
        made.row.low = std::llround(*low * made.output->object.clock_hz);
        made.row.high = std::llround(*made.output->object.seconds_high * made.output->object.clock_hz);
      }
      spent += whole;
      beside = std::max(0.0, whole - made.row.host_seconds);
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

bool has_time(const std::vector<LevelRow>& rows) {
  return std::any_of(rows.begin(), rows.end(), [](const LevelRow& row) { return has_time(row); });
}

scene::RgbImage levels_picture(const std::string& scene, const std::vector<LevelRow>& rows) {
  scene::LineChart chart;
  chart.title = scene + ": speed against error of every level";
  chart.x = {"error, share", true, {}, 1e-6, 1, "none"};
  chart.y.label = has_time(rows) ? "machine s per host s" : "runs per host s";
  chart.y.logarithmic = true;
  scene::ChartSeries time{"ticks of the run", {}, {}}, picture{"pixels of the picture", {}, {}};
  double slowest = INFINITY, fastest = 0;
  for (const LevelRow& row : rows) {
    if (row.skipped || row.speed <= 0) continue;
    slowest = std::min(slowest, row.speed);
    fastest = std::max(fastest, row.speed);
    if (has_time(row)) {
      time.x.push_back(std::fabs(row.cycle_error));
      time.y.push_back(row.speed);
      time.labels.push_back(row.level);
    }
    picture.x.push_back(row.different_share);
    picture.y.push_back(row.speed);
    picture.labels.push_back(has_time(row) ? row.level : row.level + " (no time)");
  }
  if (fastest > 0) chart.y.low = slowest / 2, chart.y.high = fastest * 2;
  chart.series = {std::move(time), std::move(picture)};
  return scene::draw(chart);
}

std::string levels_csv(const std::vector<LevelRow>& rows) {
  std::string text = "level,host_seconds,speed,cycles,cycle_error,image_psnr_db,different_pixels,different_share,"
                     "speedup_over_clocked,skipped\n";
  for (const LevelRow& row : rows) {
    if (row.skipped) {
      text += fmt::format("{},,,,,,,,,\"{}\"\n", row.level, *row.skipped);
      continue;
    }
    text += fmt::format("{},{},{},{},{},{},{},{},{},\n", row.level, row.host_seconds, row.speed,
                        has_time(row) ? std::to_string(row.cycles) : "",
                        has_time(row) ? fmt::format("{}", row.cycle_error) : "",
                        row.image_psnr_db ? fmt::format("{}", *row.image_psnr_db) : "", row.different_pixels,
                        row.different_share,
                        row.speedup_over_clocked ? fmt::format("{}", *row.speedup_over_clocked) : "");
  }
  return text;
}

std::string levels_json(const std::vector<LevelRow>& rows) {
  Json list = Json::array();
  for (const LevelRow& row : rows) {
    Json json;
    json["level"] = row.level;
    if (row.skipped) {
      for (const char* key : {"host_seconds", "cycles", "cycle_error", "interval", "image_psnr_db",
                              "different_pixels", "speed", "speedup_over_clocked"})
        json[key] = nullptr;
      json["skipped"] = *row.skipped;
    } else {
      const bool timed = has_time(row);
      json["host_seconds"] = row.host_seconds;
      json["cycles"] = timed ? Json(row.cycles) : Json(nullptr);
      json["cycle_error"] = timed ? Json(row.cycle_error) : Json(nullptr);
      json["interval"] = timed ? Json({row.low, row.high}) : Json(nullptr);
      json["image_psnr_db"] = row.image_psnr_db ? Json(*row.image_psnr_db) : Json(nullptr);
      json["different_pixels"] = row.different_pixels;
      json["speed"] = row.speed;
      json["speedup_over_clocked"] =
          row.speedup_over_clocked ? Json(*row.speedup_over_clocked) : Json(nullptr);
      json["skipped"] = nullptr;
    }
    list.push_back(json);
  }
  return Json({{"schema", 1}, {"command", "levels"}, {"rows", list}}).dump(1) + "\n";
}

std::string levels_text(const std::vector<LevelRow>& rows) {
  std::string text = fmt::format("{:<10}{:>10}{:>16}{:>14}{:>12}{:>18}{:>11}{:>10}\n", "level", "host s", "cycles",
                                 "cycle error", "picture", "different pixels", has_time(rows) ? "real time" : "runs/s",
                                 "speed-up");
  for (const LevelRow& row : rows) {
    if (row.skipped) {
      text += fmt::format("{:<10}  skipped: {}\n", row.level, *row.skipped);
      continue;
    }
    text += fmt::format("{:<10}{:>10.3f}{:>16}{:>14}{:>12}{:>18}{:>11}{:>10}\n", row.level, row.host_seconds,
                        !has_time(row) ? "no time" : stats::grouped(row.cycles),
                        !has_time(row) ? "" : fmt::format("{:.2g}", row.cycle_error),
                        row.image_psnr_db ? fmt::format("{:.1f} dB", *row.image_psnr_db) : "identical",
                        row.different_pixels, fmt::format("{:.3g}x", row.speed),
                        row.speedup_over_clocked ? fmt::format("{:.1f}x", *row.speedup_over_clocked) : "");
  }
  return text;
}

}  // namespace dendro::study
