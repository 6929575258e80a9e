#include "firmware/zbuffer_views/reference/reference.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "firmware/zbuffer_views/reference/raster.h"

namespace dendro::zbuffer_views {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kNothing = std::numeric_limits<double>::infinity();

/// Where a picture's pixels are in the world: columns from the left, rows from the lowest.
struct Window {
  Axes axes;
  glm::dvec3 origin{};
  bool perspective = false;
  double scale = 0, centre_x = 0, centre_y = 0, near = 0;
  int width = 0, height = 0;

  /// The index of the pixel, lowest row first, or -1 for a point outside; depth as measured from the origin.
  std::int64_t pixel(const glm::dvec3& world, double& depth) const {
    const glm::dvec3 q = axes(world - origin);
    depth = q.z;
    if (perspective && !(q.z > near)) return -1;
    const double divisor = perspective ? q.z : 1;
    const double column = std::floor(scale * q.x / divisor + centre_x + 0.5);
    const double row = std::floor(scale * q.y / divisor + centre_y + 0.5);
    if (!(column >= 0 && column < width && row >= 0 && row < height)) return -1;
    return static_cast<std::int64_t>(row) * width + static_cast<std::int64_t>(column);
  }

  /// The point that the centre of pixel (column, row) shows at a depth.
  glm::dvec3 point(int column, int row, double depth) const {
    const double factor = (perspective ? depth : 1) / scale;
    return origin + axes.inverse({(column - centre_x) * factor, (row - centre_y) * factor, depth});
  }
};

glm::dvec3 turned(const glm::dvec3& p, int turn) {
  const double angle = 2 * kPi * turn / 256, c = std::cos(angle), s = std::sin(angle);
  return {c * p.x + s * p.z, p.y, c * p.z - s * p.x};
}

struct Buffer {
  std::vector<double> depth;
  std::vector<Sample> samples;  ///< z unused

  explicit Buffer(const Window& window)
      : depth(static_cast<std::size_t>(window.width) * window.height, kNothing), samples(depth.size()) {}
};

/// The views of a placed tree for a direction to the viewer.
std::vector<int> views_towards(const Prepared& p, const Placement& placement, const glm::dvec3& direction) {
  return choose_views(p.views.bands, turned(direction, -placement.turn));
}

glm::dvec3 to_camera(const Prepared& p, const Frame& frame, const Placement& placement) {
  return p.perspective ? frame.eye - placement.at : -frame.axes.forward;
}

/// V6 (or V7) of all trees; `towards` is the direction to the viewer from a tree's centre.
template <class Towards>
Buffer reproject(const Prepared& p, const std::vector<StoredView>& views, const Window& window, const Towards& towards) {
  Buffer buffer(window);
  const double pitch = window_pitch(p.tree, p.views);
  for (const Placement& placement : p.placements) {
    for (const int number : views_towards(p, placement, towards(placement))) {
      const StoredView& view = views[static_cast<std::size_t>(number)];
      for (const std::vector<Sample>& layer : view.layers)
        for (std::size_t at = 0; at < layer.size(); ++at) {
          if (layer[at].colour == kNoColour) continue;
          const auto i = static_cast<double>(at % p.views.width), j = static_cast<double>(at / p.views.width);
          const glm::dvec3 own = view.axes.inverse({view.x0 + i * pitch, view.y0 + j * pitch, layer[at].z});
          double depth = 0;
          const std::int64_t pixel = window.pixel(turned(own, placement.turn) + placement.at, depth);
          if (pixel < 0 || !(depth < buffer.depth[static_cast<std::size_t>(pixel)])) continue;
          buffer.depth[static_cast<std::size_t>(pixel)] = depth;
          Sample& sample = buffer.samples[static_cast<std::size_t>(pixel)];
          sample = layer[at];
          sample.normal.longitude = static_cast<std::uint8_t>(sample.normal.longitude + placement.turn);
        }
    }
  }
  return buffer;
}

Window camera_window(const Prepared& p, const Frame& frame) {
  return {frame.axes, frame.eye, p.perspective, p.scale, p.centre_x, p.centre_y, p.near, p.width, p.height};
}

/// The middle of the trees is in the middle of the light's picture.
Window light_window(const Prepared& p, const Frame& frame) {
  glm::dvec3 low = p.placements.front().at, high = low;
  for (const Placement& placement : p.placements) low = glm::min(low, placement.at), high = glm::max(high, placement.at);
  const glm::dvec3& d = frame.to_light;
  const Axes axes = view_axes(std::atan2(std::hypot(d.x, d.z), d.y), std::atan2(d.x, d.z));
  return {axes, (low + high) / 2.0, false, p.light_scale, (p.light_width - 1) / 2.0, (p.light_height - 1) / 2.0, 0,
          p.light_width, p.light_height};
}

class Shader {
 public:
  Shader(const Prepared& p, const Frame& frame) : p_(p), frame_(frame), window_(camera_window(p, frame)) {
    picture_.width = p.width, picture_.height = p.height;
    const std::size_t pixels = static_cast<std::size_t>(p.width) * p.height;
    picture_.depth.assign(pixels, kNothing);
    picture_.colour.assign(pixels, kNoColour);
    picture_.shadow.assign(pixels, 0);
    for (std::size_t i = 0; i < pixels; ++i)
      for (const std::uint8_t channel : p.background) picture_.rgb.push_back(channel);
  }

  /// V8 of one pixel; row from the lowest. `lit` is asked for a point of the surface.
  template <class Lit>
  void shade(int column, int row, double depth, std::uint8_t colour, glm::dvec3 normal, bool late, const Lit& lit) {
    const std::size_t at = static_cast<std::size_t>(p_.height - 1 - row) * p_.width + static_cast<std::size_t>(column);
    const glm::dvec3 point = window_.point(column, row, depth);
    const glm::dvec3 to_eye = p_.perspective ? frame_.eye - point : -frame_.axes.forward;
    const Colour& entry = p_.tree.colours[colour];
    const bool below = late && entry.part == Part::kLeaf && glm::dot(normal, to_eye) < 0;
    if (below) normal = -normal;
    const int shown = below ? entry.below : colour;
    const bool bright = lit(point);
    const double shade = p_.ambient + (bright ? p_.diffuse * std::max(0.0, glm::dot(normal, frame_.to_light)) : 0);
    picture_.depth[at] = depth;
    picture_.colour[at] = static_cast<std::uint8_t>(shown);
    picture_.shadow[at] = !bright;
    for (std::size_t c = 0; c < 3; ++c) picture_.rgb[3 * at + c] = p_.tree.colours[static_cast<std::size_t>(shown)].rgb[c] * shade;
  }

  ReferencePicture take() { return std::move(picture_); }

 private:
  const Prepared& p_;
  const Frame& frame_;
  const Window window_;
  ReferencePicture picture_;
};

}  // namespace

std::int64_t ReferencePicture::covered() const {
  return static_cast<std::int64_t>(colour.size()) - std::count(colour.begin(), colour.end(), kNoColour);
}

std::vector<StoredView> needed_views(const Prepared& p, const Frame& frame) {
  const std::vector<Direction> directions = view_directions(p.views.bands);
  ViewSettings settings = p.views;
  settings.pitch = window_pitch(p.tree, p.views);
  std::vector<bool> needed(directions.size(), false);
  for (const Placement& placement : p.placements) {
    for (const int number : views_towards(p, placement, to_camera(p, frame, placement))) needed[static_cast<std::size_t>(number)] = true;
    for (const int number : views_towards(p, placement, frame.to_light)) needed[static_cast<std::size_t>(number)] = needed[static_cast<std::size_t>(number)] || p.shadows;
  }
  std::vector<StoredView> views(directions.size());
  for (std::size_t i = 0; i < views.size(); ++i)
    if (needed[i]) views[i] = make_view(p.tree, settings, directions[i]);
  return views;
}

ReferencePicture reconstruct(const Prepared& p, const std::vector<StoredView>& views, const Frame& frame) {
  const Window window = camera_window(p, frame), light = light_window(p, frame);
  const Buffer seen = reproject(p, views, window, [&](const Placement& placement) { return to_camera(p, frame, placement); });
  std::vector<double> lit_depth;
  if (p.shadows) lit_depth = reproject(p, views, light, [&](const Placement&) { return frame.to_light; }).depth;
  const auto lit = [&](const glm::dvec3& point) {
    if (!p.shadows) return true;
    double depth = 0;
    const std::int64_t pixel = light.pixel(point, depth);
    return pixel < 0 || !(depth - lit_depth[static_cast<std::size_t>(pixel)] > p.epsilon / p.light_scale);
  };
  Shader shader(p, frame);
  for (int row = 0; row < p.height; ++row)
    for (int column = 0; column < p.width; ++column) {
      const std::size_t at = static_cast<std::size_t>(row) * p.width + static_cast<std::size_t>(column);
      const Sample& sample = seen.samples[at];
      if (sample.colour == kNoColour) continue;
      shader.shade(column, row, seen.depth[at], sample.colour, sample.normal.decoded(), !p.views.early, lit);
    }
  return shader.take();
}

ReferencePicture draw_polygons(const Prepared& p, const Frame& frame) {
  struct Nearest {
    double depth = kNothing;
    std::uint8_t colour = kNoColour;
    glm::dvec3 normal{};
  };
  std::vector<Nearest> nearest(static_cast<std::size_t>(p.width) * p.height);
  for (const Placement& placement : p.placements)
    for (std::size_t t = 0; t < p.tree.model.triangles.size(); ++t) {
      std::array<glm::dvec3, 3> world, q;
      bool behind = false;
      for (std::size_t c = 0; c < 3; ++c) {
        const glm::dvec3 own = p.tree.model.vertices[p.tree.model.triangles[t][c]] - p.tree.centre;
        world[c] = turned(own, placement.turn) + placement.at;
        q[c] = frame.axes(world[c] - frame.eye);
        behind |= p.perspective && !(q[c].z > p.near);
        const double divisor = p.perspective ? q[c].z : 1;
        q[c].x = p.scale * q[c].x / divisor + p.centre_x, q[c].y = p.scale * q[c].y / divisor + p.centre_y;
      }
      if (behind) continue;
      scan_triangle(q, p.width, p.height, [&](int i, int j, const std::array<double, 3>& w) {
        const double depth = p.perspective ? 1 / (w[0] / q[0].z + w[1] / q[1].z + w[2] / q[2].z)
                                           : w[0] * q[0].z + w[1] * q[1].z + w[2] * q[2].z;
        Nearest& pixel = nearest[static_cast<std::size_t>(j) * p.width + static_cast<std::size_t>(i)];
        if (!(depth < pixel.depth)) return;
        pixel = {depth, p.tree.colour_of[t], glm::normalize(glm::cross(world[1] - world[0], world[2] - world[0]))};
      });
    }
  Shader shader(p, frame);
  for (int row = 0; row < p.height; ++row)
    for (int column = 0; column < p.width; ++column) {
      const Nearest& pixel = nearest[static_cast<std::size_t>(row) * p.width + static_cast<std::size_t>(column)];
      if (pixel.colour == kNoColour) continue;
      shader.shade(column, row, pixel.depth, pixel.colour, pixel.normal, true, [](const glm::dvec3&) { return true; });
    }
  return shader.take();
}

}  // namespace dendro::zbuffer_views
