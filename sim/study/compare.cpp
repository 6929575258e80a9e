#include "sim/study/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "sim/base/error.h"
#include "sim/scene/canvas.h"
#include "sim/stats/run_object.h"

namespace dendro::study {
namespace {

using scene::Canvas;
using scene::Colour;
using Json = nlohmann::ordered_json;

constexpr double kOtherSurface = 1.5;  ///< units of the register
constexpr int kScale = 2, kRoom = 76;
constexpr Colour kInk = {40, 40, 40}, kFirst = {214, 39, 40}, kSecond = {31, 90, 200}, kBoth = {0, 0, 0};

Json read_stats(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw UserError(path, 0, "", "there is no such file: a run directory of `dendro run` is needed");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object() || json.value("command", "") != "run")
    throw UserError(path, 0, "", "is not the run object of `dendro run`");
  return json;
}

const std::vector<float>& channel(const std::vector<scene::FloatChannel>& channels, const std::string& name,
                                  const std::string& path) {
  for (const auto& [known, values] : channels)
    if (known == name) return values;
  throw UserError(path, 0, "", "has no channel " + name + ": only runs of half_space can be compared");
}

/// A run's pixel against its reference; counts what is wrong.
bool is_wrong(const DrawnRun& run, std::size_t at, RunFaults& faults) {
  const bool covered = run.depth[at] < run.max_depth, wanted = run.reference[at] < run.max_depth;
  if (covered != wanted) {
    ++(wanted ? faults.lost : faults.gained);
    return true;
  }
  if (!covered) return false;
  const double off = std::abs(run.depth[at] + 0.5 - run.reference[at]);
  if (off > kOtherSurface) {
    ++faults.other_surface;
    return true;
  }
  faults.max_depth_error = std::max(faults.max_depth_error, off);
  return false;
}

std::string describe(const DrawnRun& run, const RunFaults& faults) {
  return fmt::format("{}: {} wrong pixels ({} lost, {} gained, {} of another surface), depth off by at most {:.3f} of {:g} units",
                     run.name(), stats::grouped(faults.wrong()), faults.lost, faults.gained, faults.other_surface,
                     faults.max_depth_error, run.max_depth + 1);
}

Json json_of(const DrawnRun& run, const RunFaults& faults) {
  return {{"folder", run.folder},
          {"machine", run.machine},
          {"preset", run.preset},
          {"level", run.level},
          {"max_depth", run.max_depth},
          {"wrong_pixels", faults.wrong()},
          {"lost", faults.lost},
          {"gained", faults.gained},
          {"other_surface", faults.other_surface},
          {"max_depth_error", faults.max_depth_error}};
}

std::int64_t alone(const RunFaults& faults, const Comparison& c) { return faults.wrong() - c.both; }

}  // namespace

DrawnRun read_drawn_run(const std::string& folder) {
  const std::string stats = folder + "/stats.json", picture = folder + "/image.exr";
  const Json json = read_stats(stats);
  DrawnRun run;
  run.folder = folder;
  try {
    run.scene = json.at("scene").get<std::string>(), run.machine = json.at("machine").get<std::string>();
    run.preset = json.at("preset").get<std::string>(), run.level = json.at("level").get<std::string>();
    run.max_depth = json.at("facts").at("max_depth").get<double>();
  } catch (const Json::exception&) {
    throw UserError(stats, 0, "", "does not say the greatest depth (facts.max_depth): only runs of half_space can be compared");
  }
  const auto channels = scene::read_exr(picture, run.width, run.height);
  run.depth = channel(channels, "Z", picture);
  run.reference = channel(channels, "reference.Z", picture);
  return run;
}

Comparison compare_runs(const DrawnRun& first, const DrawnRun& second) {
  if (first.scene != second.scene)
    throw UserError(second.folder, 0, "", fmt::format("is a picture of {}, the first of {}", second.scene, first.scene));
  if (first.width != second.width || first.height != second.height)
    throw UserError(second.folder, 0, "", fmt::format("is {}x{} pixels, the first {}x{}", second.width, second.height, first.width,
                                                      first.height));
  Comparison c;
  std::int64_t right = 0;
  for (std::size_t at = 0; at < first.depth.size(); ++at) {
    const bool wanted = first.reference[at] < first.max_depth, wanted_too = second.reference[at] < second.max_depth;
    c.covered += wanted, c.references_differ += wanted != wanted_too;
    if (wanted && wanted_too)
      c.reference_distance =
          std::max(c.reference_distance, std::abs(first.reference[at] / first.max_depth - second.reference[at] / second.max_depth));
    const bool a = is_wrong(first, at, c.first), b = is_wrong(second, at, c.second);
    c.both += a && b;
    c.pixels.push_back(a && b ? PixelFault::kBoth : a ? PixelFault::kFirst : b ? PixelFault::kSecond : PixelFault::kNone);
    if (a || b || !wanted) continue;
    const double off = std::abs((first.depth[at] + 0.5) / first.max_depth - (second.depth[at] + 0.5) / second.max_depth);
    c.depth_distance = std::max(c.depth_distance, off), c.mean_depth_distance += off;
    ++right;
  }
  if (right > 0) c.mean_depth_distance /= static_cast<double>(right);
  return c;
}

scene::RgbImage comparison_picture(const DrawnRun& first, const DrawnRun& second, const Comparison& c) {
  Canvas canvas(kScale * first.width, kScale * first.height + kRoom);
  float nearest = INFINITY, farthest = -INFINITY;
  for (const float z : second.depth)
    if (z < second.max_depth) nearest = std::min(nearest, z), farthest = std::max(farthest, z);
  const auto dot = [&](int x, int y, int margin, const Colour& colour) {
    canvas.fill(std::max(0, kScale * x - margin), std::max(0, kScale * y - margin), kScale * (x + 1) + margin,
                std::min(kScale * (y + 1) + margin, kScale * first.height), colour);
  };
  for (int y = 0; y < first.height; ++y)
    for (int x = 0; x < first.width; ++x) {
      const float z = second.depth[static_cast<std::size_t>(y) * first.width + x];
      if (!(z < second.max_depth)) continue;
      const auto grey = static_cast<std::uint8_t>(170 + 65 * (z - nearest) / std::max(1.0f, farthest - nearest));
      dot(x, y, 0, {grey, grey, grey});
    }
  // Wrong pixels are drawn larger than they are, or they would not be seen.
  for (int y = 0; y < first.height; ++y)
    for (int x = 0; x < first.width; ++x)
      switch (c.pixels[static_cast<std::size_t>(y) * first.width + x]) {
        case PixelFault::kNone: break;
        case PixelFault::kFirst: dot(x, y, 1, kFirst); break;
        case PixelFault::kSecond: dot(x, y, 1, kSecond); break;
        case PixelFault::kBoth: dot(x, y, 1, kBoth); break;
      }
  int line = kScale * first.height + 8;
  for (const auto& [colour, text] :
       {std::pair{kFirst, fmt::format("{} alone wrong: {}", first.name(), alone(c.first, c))},
        {kSecond, fmt::format("{} alone wrong: {}", second.name(), alone(c.second, c))},
        {kBoth, fmt::format("both wrong: {}, of {} covered", c.both, c.covered)}}) {
    canvas.fill(4, line, 18, line + 14, colour);
    canvas.text(26, line, text, kInk);
    line += 22;
  }
  return canvas.image();
}

std::string comparison_text(const DrawnRun& first, const DrawnRun& second, const Comparison& c) {
  return fmt::format(
      "{}: {} pixels covered in double precision; the runs' references cover {} others and differ by {:.2g} of the depths\n"
      "  {}\n  {}\n"
      "  wrong on both {}, on the first alone {}, on the second alone {}\n"
      "  where both are right their depths differ by {:.4f} % of the depths on the average and {:.4f} % at most\n",
      first.scene, stats::grouped(c.covered), c.references_differ, c.reference_distance, describe(first, c.first),
      describe(second, c.second), c.both, alone(c.first, c), alone(c.second, c), 100 * c.mean_depth_distance,
      100 * c.depth_distance);
}

std::string comparison_json(const DrawnRun& first, const DrawnRun& second, const Comparison& c) {
  return Json{{"schema", 1},
              {"command", "compare"},
              {"scene", first.scene},
              {"covered_pixels", c.covered},
              {"references_differ", c.references_differ},
              {"reference_distance", c.reference_distance},
              {"runs", {json_of(first, c.first), json_of(second, c.second)}},
              {"wrong_on_both", c.both},
              {"depth_distance", c.depth_distance},
              {"mean_depth_distance", c.mean_depth_distance}}
             .dump(1) +
         "\n";
}

}  // namespace dendro::study
