#include "firmware/half_space/reference/hulls_reference.h"

#include <algorithm>
#include <cmath>

#include "firmware/half_space/reference/reference.h"
#include "sim/base/check.h"

namespace dendro::half_space {
namespace {

/// More than the steps of 16.16 drift over a line and a column: 1022 · 2^-17 (FG86 N-A2).
constexpr double kDrift = 0.01;

struct Span {
  double front = 0, back = INFINITY;
  double outside = -INFINITY;  ///< largest distance beyond an edge-on plane, in pixels along an axis
};

Span span_at(const std::vector<ScreenPlane>& planes, double x, double y) {
  Span span;
  for (const ScreenPlane& plane : planes) {
    const double rest = plane.a * x + plane.b * y + plane.d;
    if (plane.c == 0) {
      const double scale = std::max(std::abs(plane.a), std::abs(plane.b));
      span.outside = std::max(span.outside, scale > 0 ? rest / scale : rest * INFINITY);
    } else if (plane.c > 0) {
      span.back = std::min(span.back, -rest / plane.c);
    } else {
      span.front = std::max(span.front, -rest / plane.c);
    }
  }
  return span;
}

bool is_covered(const Span& span, double maxdepth) {
  return !(span.outside > 0) && span.back < maxdepth && span.front < span.back;
}

bool is_unbounded(const Span& span, double maxdepth) {
  return !(span.outside > 0) && !(span.back < maxdepth) && span.front < maxdepth;
}

bool is_surely_covered(const Span& span, double maxdepth) {
  return span.outside < -kDrift && span.back < maxdepth - kDrift && span.back - span.front > 1 + 2 * kDrift;
}

bool is_possibly_covered(const Span& span, double maxdepth) {
  return span.outside < kDrift && span.back < maxdepth + kDrift && span.back > span.front - 2 * kDrift;
}

class Renderer {
 public:
  Renderer(const PreparedHulls& prepared, HullsReference& picture) : prepared_(prepared), picture_(picture) {}

  void pixel(int x, int y) {
    const double far = prepared_.maxdepth;
    double depth = far;
    int seen = -1, lower = prepared_.maxdepth, upper = prepared_.maxdepth;
    bool unbounded = false;
    for (std::size_t i = 0; i < prepared_.hulls.size(); ++i) {
      const Span span = span_at(prepared_.hulls[i].screen, x, y);
      if (is_covered(span, far) && span.front < depth) depth = span.front, seen = static_cast<int>(i);
      unbounded = unbounded || is_unbounded(span, far);
      if (is_possibly_covered(span, far)) lower = std::min(lower, floor_of(span.front - kDrift));
      if (is_surely_covered(span, far)) upper = std::min(upper, floor_of(span.front + kDrift));
    }
    picture_.depth.push_back(depth);
    picture_.hull.push_back(seen);
    picture_.unbounded.push_back(unbounded && seen < 0);
    picture_.lower.push_back(lower), picture_.upper.push_back(upper);
    const Rgb& rgb = prepared_.shades[static_cast<std::size_t>(floor_of(depth))];
    picture_.rgb.insert(picture_.rgb.end(), rgb.begin(), rgb.end());
  }

 private:
  int floor_of(double depth) const {
    return static_cast<int>(std::clamp(std::floor(depth), 0.0, static_cast<double>(prepared_.maxdepth)));
  }

  const PreparedHulls& prepared_;
  HullsReference& picture_;
};

}  // namespace

HullsReference render_hulls_reference(const PreparedHulls& prepared) {
  HullsReference picture;
  picture.width = prepared.width, picture.height = prepared.height;
  Renderer renderer(prepared, picture);
  for (int y = 0; y < prepared.height; ++y)
    for (int x = 0; x < prepared.width; ++x) renderer.pixel(x, y);
  return picture;
}

UnboundedPixels count_unbounded(const std::vector<ScreenPlane>& planes, int width, int height, int maxdepth) {
  UnboundedPixels count;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Span span = span_at(planes, x, y);
      count.unbounded += is_unbounded(span, maxdepth);
      count.covered += is_covered(span, maxdepth);
    }
  return count;
}

ErrorReport compare(const HullsReference& reference, const std::vector<std::uint8_t>& nearest, int maxdepth,
                    const std::uint8_t* rgb) {
  DENDRO_CHECK(reference.depth.size() == nearest.size());
  ErrorReport report;
  UnboundedPixels unbounded;
  std::int64_t outside = 0;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const bool covered = reference.hull[i] >= 0, drawn = nearest[i] < maxdepth;
    report.covered_pixels += covered;
    report.wrong_pixels += covered != drawn;
    unbounded.covered += covered, unbounded.unbounded += reference.unbounded[i];
    outside += nearest[i] < reference.lower[i] || nearest[i] > reference.upper[i];
    const bool certain = covered && drawn && reference.upper[i] == reference.lower[i];
    if (certain)
      report.max_depth_error =
          std::max(report.max_depth_error, std::abs(nearest[i] + 0.5 - reference.depth[i]));
  }
  report.psnr_db = psnr(reference.rgb, rgb);
  report.extra = {{"outside_enclosure", static_cast<double>(outside)},
                  {"unbounded_pixels", static_cast<double>(unbounded.unbounded)},
                  {"unbounded_share", unbounded.share()}};
  return report;
}

}  // namespace dendro::half_space
