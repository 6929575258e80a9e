#include "firmware/half_space/reference/hulls_reference.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "firmware/half_space/host/hulls_layout.h"
#include "firmware/half_space/reference/reference.h"
#include "sim/base/check.h"
#include "sim/scene/psnr.h"

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

/// How far a point lies inside a painter's trunk, in pixels along its line; negative outside.
double inside_of(const Trapezium& trapezium, int x, int y) {
  const Box& box = trapezium.box;
  if (y < box.y0 || y > box.y1 || x < box.x0 || x > box.x1) return -INFINITY;
  const int lines = y - box.y0;
  return std::min(x - (trapezium.left + lines * trapezium.left_step),
                  trapezium.right + lines * trapezium.right_step - x);
}

/// What is known of a pixel so far: the depth, and what the integers may make of it.
struct Seen {
  double depth;
  int hull, lower, upper;
  bool sure = false;  ///< the integers cover the pixel by that hull, too
};

class Renderer {
 public:
  Renderer(const PreparedHulls& prepared, const FrontMove& move, HullsReference& picture)
      : prepared_(prepared), move_(move), far_(prepared.maxdepth), picture_(picture) {}

  void pixel(int x, int y) {
    Seen seen{far_, -1, prepared_.maxdepth, prepared_.maxdepth};
    bool unbounded = false;
    for (std::size_t i = 0; i < prepared_.hulls.size(); ++i) {
      const Span span = span_at(prepared_.hulls[i].screen, x, y);
      unbounded = unbounded || is_unbounded(span, far_);
      merge(span, i, move_ ? std::optional(move_(i, x, y)) : std::nullopt, seen);
    }
    for (const Trunk& trunk : prepared_.trunks)
      if (trunk.visible()) merge_trunk(trunk, x, y, seen);
    picture_.depth.push_back(seen.depth);
    picture_.hull.push_back(seen.hull);
    picture_.unbounded.push_back(unbounded && seen.hull == -1);
    picture_.lower.push_back(seen.lower), picture_.upper.push_back(seen.upper);
    picture_.certain.push_back(seen.sure && seen.hull >= 0 && seen.lower == seen.upper);
    const Rgb& rgb = prepared_.shades[static_cast<std::size_t>(floor_of(seen.depth))];
    picture_.rgb.insert(picture_.rgb.end(), rgb.begin(), rgb.end());
  }

 private:
  void merge(const Span& span, std::size_t hull, std::optional<int> move, Seen& seen) const {
    const auto moved = [&](auto front) { return move ? std::max<decltype(front)>(1, front + *move) : front; };
    const double front = moved(span.front);
    const int least = moved(floor_of(span.front - kDrift)), most = moved(floor_of(span.front + kDrift));
    if (is_possibly_covered(span, far_) && (!move || least < floor_of(span.back + kDrift)))
      seen.lower = std::min(seen.lower, least);
    const bool sure = is_surely_covered(span, far_) && (!move || most < floor_of(span.back - kDrift));
    if (sure) seen.upper = std::min(seen.upper, most);
    if (is_covered(span, far_) && (!move || front < span.back) && front < seen.depth)
      seen.depth = front, seen.hull = static_cast<int>(hull), seen.sure = sure;
  }

  void merge_trunk(const Trunk& trunk, int x, int y, Seen& seen) const {
    bool wins, may_win, must_win;
    if (trunk.painter) {
      const double inside = inside_of(trunk.trapezium, x, y);
      wins = inside >= 0 && seen.hull == -1;
      may_win = inside > -kDrift && seen.upper == prepared_.maxdepth;
      must_win = inside > kDrift && seen.lower == prepared_.maxdepth;
    } else {
      const Span span = span_at(trunk.hull.screen, x, y);
      wins = is_covered(span, far_) && span.front < seen.depth;
      may_win = is_possibly_covered(span, far_) && floor_of(span.front - kDrift) < seen.upper;
      must_win = is_surely_covered(span, far_) && floor_of(span.front + kDrift) < seen.lower;
    }
    if (wins) seen.depth = kTrunkMark, seen.hull = HullsReference::kTrunkHull;
    if (may_win) seen.lower = kTrunkMark;
    if (must_win) seen.upper = kTrunkMark;
  }

  int floor_of(double depth) const {
    return static_cast<int>(std::clamp(std::floor(depth), 0.0, static_cast<double>(prepared_.maxdepth)));
  }

  const PreparedHulls& prepared_;
  const FrontMove& move_;
  double far_;
  HullsReference& picture_;
};

}  // namespace

HullsReference render_hulls_reference(const PreparedHulls& prepared, const FrontMove& move) {
  HullsReference picture;
  picture.width = prepared.width, picture.height = prepared.height;
  Renderer renderer(prepared, move, picture);
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
    const bool trunk = reference.hull[i] == HullsReference::kTrunkHull;
    const bool covered = reference.hull[i] != -1, drawn = nearest[i] < maxdepth;
    report.covered_pixels += covered;
    report.wrong_pixels += covered != drawn || (trunk && nearest[i] != kTrunkMark);
    unbounded.covered += covered, unbounded.unbounded += reference.unbounded[i];
    outside += nearest[i] < reference.lower[i] || nearest[i] > reference.upper[i];
    if (reference.certain[i] && drawn)
      report.max_depth_error =
          std::max(report.max_depth_error, std::abs(nearest[i] + 0.5 - reference.depth[i]));
  }
  report.psnr_db = scene::psnr(reference.rgb, rgb);
  report.extra = {{"outside_enclosure", static_cast<double>(outside)},
                  {"unbounded_pixels", static_cast<double>(unbounded.unbounded)},
                  {"unbounded_share", unbounded.share()}};
  return report;
}

}  // namespace dendro::half_space
