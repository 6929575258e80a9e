#include <fmt/format.h>

#include <cmath>

#include "firmware/zbuffer_views/stability/cases.h"
#include "firmware/zbuffer_views/stability/plane.h"

// N-B8: a plane tilted to a light from above, its slope along the diagonal of the light's pixels. The camera and the light take
// different views, whose samples lie in the middle of a pixel of each: only the place in the light's buffer is rounded. Half a
// diagonal times the tangent is then what a point may lie behind its pixel's sample.

namespace dendro::zbuffer_views {
namespace {

constexpr double kTilts[] = {30, 60, 75, 85};  // degrees
constexpr int kSide = 128, kBisections = 9;
constexpr float kPitch = 1.0f / 64;
constexpr std::size_t kLightView = 0, kCameraView = 3;  ///< of 2 bands: from above; at the equator, 144 degrees

/// Through the tree's centre; what lies `above` it by so much covers every light pixel that touches it.
Plane tilted(double degrees, double above) {
  const double slope = std::tan(degrees * M_PI / 180) * std::sqrt(0.5), half = 0.7;
  // y = slope (z - x) looks towards x and against z.
  if (above > 0) return {{slope, 1, -slope}, above, half + static_cast<double>(kPitch), 64};
  return {{slope, 1, -slope}, 0, half};
}

struct Setting {
  ViewsFile views;
  JobFile job;
};

/// The camera's view has the plane, the light's has it and what lies `gap` above it.
Setting setting(const stability::Rig& rig, double degrees, double gap) {
  Blank blank = blank_views(rig, 2, kSide, kPitch);
  store_plane(blank.views, kCameraView, tilted(degrees, 0), 0);
  store_plane(blank.views, kLightView, tilted(degrees, gap), 1);
  blank.views.facts.radius = blank.views.facts.half_height = 1;
  zbv_job& facts = blank.job.facts;
  facts.width = facts.height = kSide;
  facts.centre_x = facts.centre_y = 0.5f * (kSide - 1);
  facts.scale = 1 / kPitch;
  facts.shadows = 1;
  // A multiple of 1/2 in the middle on both axes, as the stored window has it.
  facts.light_width = facts.light_height = 2 * kSide;
  facts.light_scale = 1 / kPitch;
  const zbv_view& camera = blank.views.views[kCameraView];
  zbv_frame frame = {};
  for (std::size_t i = 0; i < 9; ++i) frame.frame[i] = camera.frame[i];
  for (std::size_t i = 0; i < 3; ++i) frame.eye[i] = -4 * camera.frame[6 + i];
  frame.light[1] = 1;
  blank.job.frames = {frame};
  return {blank.views, blank.job};
}

zbv_picture counted(const stability::Rig& rig, Setting setting, double epsilon) {
  setting.job.facts.epsilon = static_cast<float>(epsilon);
  return reconstructed(rig, setting.views, setting.job).pictures.at(0).facts;
}

/// Light pixels: the least threshold without a shadow, from above.
double least_epsilon(const stability::Rig& rig, const Setting& setting, double high) {
  double low = 0;
  if (counted(rig, setting, high).shadowed > 0) return HUGE_VAL;
  for (int k = 0; k < kBisections; ++k) {
    const double middle = (low + high) / 2;
    (counted(rig, setting, middle).shadowed > 0 ? low : high) = middle;
  }
  return high;
}

}  // namespace

stability::Result shadow_threshold(const stability::Rig& rig, std::uint64_t) {
  stability::Result result;
  for (const double tilt : kTilts) {
    const double bound = std::sqrt(0.5) * std::tan(tilt * M_PI / 180);
    const Setting alone = setting(rig, tilt, 0);
    const std::uint32_t covered = counted(rig, alone, bound).covered;
    const double least = least_epsilon(rig, alone, 2 * bound);
    result.rows.push_back({"N-B8", fmt::format("{} degrees: least threshold without a shadow on a lit plane of {} pixels", tilt, covered),
                           least, bound, "light pixels", "geometry", Bound::kAtMost, ""});
    result.rows.push_back(must_show("N-B8", fmt::format("{} degrees: pixels in shadow at 3/4 of that threshold", tilt),
                                    counted(rig, alone, 0.75 * bound).shadowed, "pixels", "geometry"));
    // Rounding takes at most one threshold from the distance of two, and what is left has to be more than one.
    const auto lit_below = [&](double thresholds) {
      const zbv_picture below = counted(rig, setting(rig, tilt, thresholds * bound * static_cast<double>(kPitch)), bound);
      return static_cast<double>(below.covered - below.shadowed);
    };
    result.rows.push_back({"N-B8", fmt::format("{} degrees: pixels lit under a plane 2.002 thresholds above", tilt), lit_below(2.002), 0,
                           "pixels", "geometry", Bound::kAtMost, ""});
    result.rows.push_back(must_show("N-B8", fmt::format("{} degrees: pixels lit under a plane 1.5 thresholds above", tilt),
                                    lit_below(1.5), "pixels", "geometry"));
  }
  return result;
}

}  // namespace dendro::zbuffer_views
