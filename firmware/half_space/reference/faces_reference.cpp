#include "firmware/half_space/reference/faces_reference.h"

#include <algorithm>
#include <cmath>

namespace dendro::half_space {
namespace {

struct Seen {
  double front = 0, back = 0;
  int face = -1;
  bool covered = false;
};

/// What one hull is at a pixel; its front planes are numbered from `first_face`.
Seen look(const StreamHull& hull, int first_face, int x, int y, double maxdepth) {
  Seen seen;
  seen.back = maxdepth;
  double farthest = -INFINITY;
  int face = first_face;
  for (const ScreenPlane& plane : hull.screen) {
    const double value = plane.a * x + plane.b * y + plane.d;
    if (plane.kind == PlaneKind::kEdgeOn) {
      if (value > 0) return seen;
      continue;
    }
    const double z = -value / plane.c;
    if (plane.kind == PlaneKind::kBack) {
      seen.back = std::min(seen.back, std::max(z, 0.0));
    } else {
      if (z > farthest) farthest = z, seen.face = face;
      ++face;
    }
  }
  seen.front = std::max(farthest, 0.0);
  seen.covered = seen.front < seen.back && seen.back < maxdepth && seen.face >= 0;
  return seen;
}

int front_planes(const StreamHull& hull) {
  return static_cast<int>(std::count_if(hull.screen.begin(), hull.screen.end(),
                                        [](const ScreenPlane& p) { return p.kind == PlaneKind::kFront; }));
}

}  // namespace

FacesReference render_faces_reference(const PreparedPlanes& prepared) {
  FacesReference out;
  const std::size_t pixels = static_cast<std::size_t>(prepared.width) * static_cast<std::size_t>(prepared.height);
  const auto maxdepth = static_cast<double>(prepared.maxdepth);
  out.face.assign(pixels, -1);
  out.hull.assign(pixels, -1);
  out.depth.assign(pixels, maxdepth);
  int first_face = 0;
  for (std::size_t h = 0; h < prepared.hulls.size(); ++h) {
    const StreamHull& hull = prepared.hulls[h];
    for (int y = hull.box.y0; hull.visible && y <= hull.box.y1; ++y)
      for (int x = hull.box.x0; x <= hull.box.x1; ++x) {
        const Seen seen = look(hull, first_face, x, y, maxdepth);
        const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(prepared.width) + static_cast<std::size_t>(x);
        if (!seen.covered || !(seen.front < out.depth[at])) continue;
        out.depth[at] = seen.front, out.hull[at] = static_cast<int>(h), out.face[at] = seen.face;
      }
    first_face += front_planes(hull);
  }
  for (const int face : out.face) {
    const Rgb& rgb = face < 0 ? prepared.background : prepared.faces[static_cast<std::size_t>(face)];
    out.rgb.insert(out.rgb.end(), rgb.begin(), rgb.end());
  }
  return out;
}

}  // namespace dendro::half_space
