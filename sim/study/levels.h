#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/scene/image_io.h"
#include "sim/study/run.h"

namespace dendro::study {

/// One level of fidelity on one scene.
struct LevelRow {
  std::string level;
  double host_seconds = 0;
  std::int64_t cycles = 0, low = 0, high = 0;  ///< of an estimate the 99.7 % interval, else `cycles`
  double cycle_error = 0;               ///< (cycles - reference) / reference; 0 at a level without time
  std::optional<double> image_psnr_db;  ///< against the reference's picture; none: identical
  std::int64_t different_pixels = 0;
  double different_share = 0;  ///< of all pixels
  /// Seconds of the reference's machine per second of this computer; runs per second when no level with time was run.
  double speed = 0;
  std::optional<double> speedup_over_clocked;
  std::optional<std::string> skipped;  ///< why there is no run
};

/// The scene at every level, one after another, fastest first. The reference is `clocked`, or `cycle` where
/// `clocked` was skipped. A level whose predicted host time would go beyond `budget` seconds is skipped (0:
/// no budget).
std::vector<LevelRow> compare_levels(const Catalogue& catalogue, const RunArguments& arguments, double budget,
                                     Progress* progress);

/// `speed` of the rows is that of a machine's seconds: some level with time was run.
bool has_time(const std::vector<LevelRow>& rows);

/// Speed against the two errors, of time and of the picture, on logarithmic axes; an error of 0 has a place of its own.
scene::RgbImage levels_picture(const std::string& scene, const std::vector<LevelRow>& rows);
std::string levels_csv(const std::vector<LevelRow>& rows);
std::string levels_json(const std::vector<LevelRow>& rows);
std::string levels_text(const std::vector<LevelRow>& rows);

}  // namespace dendro::study
