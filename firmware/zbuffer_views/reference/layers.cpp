#include "firmware/zbuffer_views/reference/layers.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "firmware/zbuffer_views/reference/raster.h"
#include "sim/base/check.h"

namespace dendro::zbuffer_views {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kWindowMargin = 1.02;

std::array<glm::dvec3, 3> corners_of(const Tree& tree, std::size_t triangle) {
  std::array<glm::dvec3, 3> corners;
  for (std::size_t c = 0; c < 3; ++c)
    corners[c] = tree.model.vertices[tree.model.triangles[triangle][c]] - tree.centre;
  return corners;
}

}  // namespace

NormalBytes NormalBytes::of(const glm::dvec3& n) {
  NormalBytes bytes;
  const double latitude = std::asin(std::clamp(n.y, -1.0, 1.0));
  bytes.latitude = static_cast<std::uint8_t>(std::floor((latitude + kPi / 2) / kPi * 255 + 0.5));
  const auto turn = static_cast<int>(std::floor(std::atan2(n.x, n.z) / (2 * kPi) * 256 + 0.5));
  bytes.longitude = static_cast<std::uint8_t>(turn & 255);
  return bytes;
}

glm::dvec3 NormalBytes::decoded() const {
  const double lat = latitude / 255.0 * kPi - kPi / 2, lon = longitude / 256.0 * 2 * kPi;
  return {std::cos(lat) * std::sin(lon), std::sin(lat), std::cos(lat) * std::cos(lon)};
}

std::vector<Fragment> insert_layers(const std::vector<Fragment>& fragments, int layers, double threshold) {
  std::vector<Fragment> stored;
  for (const Fragment& fragment : fragments) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(layers); ++k) {
      if (k == stored.size()) {
        stored.push_back(fragment);
        break;
      }
      if (std::abs(fragment.z - stored[k].z) < threshold) {
        if (fragment.z < stored[k].z) stored[k] = fragment;
        break;
      }
      if (fragment.z < stored[k].z) {
        stored.insert(stored.begin() + static_cast<std::ptrdiff_t>(k), fragment);
        if (stored.size() > static_cast<std::size_t>(layers)) stored.pop_back();
        break;
      }
    }
  }
  return stored;
}

std::vector<Fragment> peel_layers(std::vector<Fragment> fragments, int layers, double threshold) {
  std::stable_sort(fragments.begin(), fragments.end(), [](const Fragment& a, const Fragment& b) { return a.z < b.z; });
  std::vector<Fragment> stored;
  for (const Fragment& fragment : fragments) {
    if (stored.size() == static_cast<std::size_t>(layers)) break;
    // Without a threshold equal depths are layers of their own, as they are when inserted.
    if (stored.empty() || fragment.z >= stored.back().z + threshold) stored.push_back(fragment);
  }
  return stored;
}

double window_pitch(const Tree& tree, const ViewSettings& settings) {
  if (settings.pitch > 0) return settings.pitch;
  double high = 0;
  for (const Direction& direction : view_directions(settings.bands)) {
    const Axes axes = view_axes(direction.theta, direction.phi);
    for (const auto& triangle : tree.model.triangles)
      for (const std::uint32_t corner : triangle)
        high = std::max(high, std::abs(glm::dot(axes.up, tree.model.vertices[corner] - tree.centre)));
  }
  return std::max(2 * tree.radius * kWindowMargin / settings.width, 2 * high * kWindowMargin / settings.height);
}

StoredView make_view(const Tree& tree, const ViewSettings& settings, const Direction& direction) {
  StoredView view;
  view.direction = direction;
  view.axes = view_axes(direction.theta, direction.phi);
  view.x0 = -(settings.width - 1) / 2.0 * settings.pitch;
  view.y0 = -(settings.height - 1) / 2.0 * settings.pitch;
  DENDRO_CHECK(settings.pitch > 0);
  std::vector<Fragment> fragments;
  for (std::size_t t = 0; t < tree.model.triangles.size(); ++t) {
    std::array<glm::dvec3, 3> p;
    const auto corners = corners_of(tree, t);
    for (std::size_t c = 0; c < 3; ++c) {
      p[c] = view.axes(corners[c]);
      p[c].x = (p[c].x - view.x0) / settings.pitch;
      p[c].y = (p[c].y - view.y0) / settings.pitch;
    }
    scan_triangle(p, settings.width, settings.height, [&](int i, int j, const std::array<double, 3>& weight) {
      fragments.push_back({static_cast<std::uint32_t>(j * settings.width + i), static_cast<std::uint32_t>(t),
                           weight[0] * p[0].z + weight[1] * p[1].z + weight[2] * p[2].z});
    });
  }
  std::stable_sort(fragments.begin(), fragments.end(), [](const Fragment& a, const Fragment& b) { return a.pixel < b.pixel; });
  view.layers.assign(static_cast<std::size_t>(settings.layers),
                     std::vector<Sample>(static_cast<std::size_t>(settings.width) * settings.height));
  for (std::size_t first = 0, last = 0; first < fragments.size(); first = last) {
    while (last < fragments.size() && fragments[last].pixel == fragments[first].pixel) ++last;
    const std::vector<Fragment> here(fragments.begin() + static_cast<std::ptrdiff_t>(first),
                                     fragments.begin() + static_cast<std::ptrdiff_t>(last));
    const std::vector<Fragment> stored = settings.peel ? peel_layers(here, settings.layers, settings.threshold)
                                                       : insert_layers(here, settings.layers, settings.threshold);
    for (std::size_t k = 0; k < stored.size(); ++k) {
      const auto corners = corners_of(tree, stored[k].triangle);
      glm::dvec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
      std::uint8_t colour = tree.colour_of[stored[k].triangle];
      const Colour& entry = tree.colours[colour];
      if (settings.early && entry.part == Part::kLeaf && glm::dot(normal, view.axes.forward) > 0) {
        normal = -normal;
        colour = static_cast<std::uint8_t>(entry.below);
      }
      view.layers[k][stored[k].pixel] = {stored[k].z, NormalBytes::of(normal), colour};
    }
  }
  return view;
}

std::vector<StoredView> make_views(const Tree& tree, const ViewSettings& settings) {
  ViewSettings resolved = settings;
  resolved.pitch = window_pitch(tree, settings);
  std::vector<StoredView> views;
  for (const Direction& direction : view_directions(settings.bands)) views.push_back(make_view(tree, resolved, direction));
  return views;
}

}  // namespace dendro::zbuffer_views
