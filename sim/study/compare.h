#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/scene/image_io.h"

namespace dendro::study {

/// What a run directory says about its picture: stats.json and image.exr.
struct DrawnRun {
  std::string folder, scene, machine, preset, level;
  int width = 0, height = 0;
  double max_depth = 0;  ///< of the depth register; background has it
  std::vector<float> depth, reference;  ///< of every pixel, in units of the register; the reference is double precision's

  std::string name() const { return machine + ":" + preset + ", " + level; }
};

/// Throws UserError when the directory lacks one of the files, or they do not say what a run of half-spaces says.
DrawnRun read_drawn_run(const std::string& folder);

enum class PixelFault : std::uint8_t { kNone, kFirst, kSecond, kBoth };

/// One run's pixels against its reference.
struct RunFaults {
  std::int64_t lost = 0, gained = 0;  ///< covered in the reference only, in the run only
  std::int64_t other_surface = 0;     ///< covered in both, the depth off by more than 1.5 units
  double max_depth_error = 0;         ///< units of the register, of the other pixels: the middle of a unit against the real depth

  std::int64_t wrong() const { return lost + gained + other_surface; }
};

struct Comparison {
  std::int64_t covered = 0;            ///< by the first run's reference
  std::int64_t references_differ = 0;  ///< pixels covered in one reference and not in the other
  double reference_distance = 0;       ///< largest distance of the references' depths, share of the range
  RunFaults first, second;
  std::int64_t both = 0;               ///< pixels wrong in both runs
  double depth_distance = 0, mean_depth_distance = 0;  ///< of the runs where both are right, share of the range
  std::vector<PixelFault> pixels;
};

/// Throws UserError for runs of different scenes or sizes.
Comparison compare_runs(const DrawnRun& first, const DrawnRun& second);

/// Where the runs are wrong, each pixel of the picture 2 x 2, over the depth of the second in grey.
scene::RgbImage comparison_picture(const DrawnRun& first, const DrawnRun& second, const Comparison& comparison);

std::string comparison_text(const DrawnRun& first, const DrawnRun& second, const Comparison& comparison);
std::string comparison_json(const DrawnRun& first, const DrawnRun& second, const Comparison& comparison);

}  // namespace dendro::study
