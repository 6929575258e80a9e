#include "firmware/half_space/reference/reference.h"

#include <algorithm>
#include <cmath>

#include "sim/base/check.h"
#include "sim/scene/psnr.h"

namespace dendro::half_space {
namespace {

constexpr unsigned kLoresPixel = 2;  // bus function code

struct Hit {
  int face = 0;
  double depth = 0;
};

/// `planes` in the order of their faces, so that the lowest face number wins a tie.
Hit intersect(const std::vector<ScreenPlane>& planes, double x, double y, double maxdepth) {
  double back = maxdepth;
  Hit front;
  bool outside = false;
  for (const ScreenPlane& plane : planes) {
    const double rest = plane.a * x + plane.b * y + plane.d;
    if (plane.c == 0) {
      outside = outside || rest > 0;
      continue;
    }
    const double z = -rest / plane.c;
    if (plane.c > 0)
      back = std::min(back, z);
    else if (front.face == 0 || z > front.depth)
      front = {plane.face, std::max(z, 0.0)};
  }
  const bool covered = !outside && back < maxdepth && front.depth < back;
  return covered ? front : Hit{};
}

/// True when the pixel and its 8 neighbours, beyond the border background, show one face.
bool is_interior(const ReferencePicture& picture, int x, int y) {
  const std::uint8_t face = picture.face[picture.at(x, y)];
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u) {
      const bool inside = u >= 0 && v >= 0 && u < picture.width && v < picture.height;
      if ((inside ? picture.face[picture.at(u, v)] : 0) != face) return false;
    }
  return true;
}

}  // namespace

ReferencePicture render_reference(const std::vector<ScreenPlane>& planes, const std::vector<Rgb>& shades,
                                  int width, int height, int maxdepth) {
  ReferencePicture picture{width, height, {}, {}, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Hit hit = intersect(planes, x, y, maxdepth);
      picture.face.push_back(static_cast<std::uint8_t>(hit.face));
      picture.depth.push_back(hit.depth);
      picture.rgb.insert(picture.rgb.end(), shades[hit.face].begin(), shades[hit.face].end());
    }
  return picture;
}

SimulatedPicture read_back(const MachineView& machine, int width, int height) {
  SimulatedPicture picture;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::uint32_t word =
          machine.peek(static_cast<std::uint32_t>(x) << 1 | static_cast<std::uint32_t>(y) << 11, kLoresPixel);
      picture.face.push_back(static_cast<std::uint8_t>(word >> kFaceLow & kFaceMask));
      picture.front.push_back(static_cast<std::uint16_t>(word & kFieldMask));
    }
  return picture;
}

ErrorReport compare(const ReferencePicture& reference, const SimulatedPicture& simulated,
                    const std::uint8_t* rgb) {
  DENDRO_CHECK(reference.face.size() == simulated.face.size());
  ErrorReport report;
  std::int64_t far_away = 0;
  int worst_x = -1, worst_y = -1;
  for (int y = 0; y < reference.height; ++y)
    for (int x = 0; x < reference.width; ++x) {
      const std::size_t i = reference.at(x, y);
      if (reference.face[i] != 0) ++report.covered_pixels;
      if (reference.face[i] != simulated.face[i]) {
        ++report.wrong_pixels;
        if (is_interior(reference, x, y)) ++far_away;
      } else if (reference.face[i] != 0) {
        const double error = std::abs(simulated.front[i] + 0.5 - reference.depth[i]);
        if (error > report.max_depth_error) report.max_depth_error = error, worst_x = x, worst_y = y;
      }
    }
  report.psnr_db = scene::psnr(reference.rgb, rgb);
  report.extra = {{"wrong_pixels_far", static_cast<double>(far_away)},
                  {"worst_x", static_cast<double>(worst_x)},
                  {"worst_y", static_cast<double>(worst_y)}};
  return report;
}

}  // namespace dendro::half_space
