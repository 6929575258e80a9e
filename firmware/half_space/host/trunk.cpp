#include "firmware/half_space/host/trunk.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "firmware/half_space/host/layout.h"
#include "firmware/half_space/host/scene_setup.h"
#include "sim/base/error.h"

namespace dendro::half_space {
namespace {

constexpr int kSides = 6;                    // [FG86 6.2]
constexpr double kLargestEdge = 16000;       // pixels: twice that still fits 16.16
const double kApothem = std::sqrt(3.0) / 2;  // of a hexagon whose corners are 1 from its centre

glm::dvec3 outward(int side) {
  const double angle = side * 360.0 / kSides;
  return {scene::sine_of_degrees(angle), 0, scene::cosine_of_degrees(angle)};
}

glm::dvec3 mean(const std::vector<glm::dvec3>& points, std::size_t from, std::size_t to) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = from; i < to; ++i) sum += points[i];
  return sum / static_cast<double>(to - from);
}

}  // namespace

TrunkSettings read_trunk(const scene::Object& object) {
  scene::Options options("object", object.source_where);
  for (const auto& [key, value] : object.trunk_parameters) options.set(key, value);
  static const std::vector<std::string> kKinds = {"none", "cylinder", "cone", "painter"};
  const std::string kind = options.choice("trunk", "none", kKinds);
  TrunkSettings settings;
  settings.kind = static_cast<TrunkKind>(std::find(kKinds.begin(), kKinds.end(), kind) - kKinds.begin());
  settings.width = options.real("trunk_width", settings.width, 0.001, 2);
  settings.height = options.real("trunk_height", settings.height, 0.01, 10);
  const bool fitted = object.groups.count("trunk") != 0;
  for (const char* key : {"trunk_width", "trunk_height"}) {
    if (!options.has(key)) continue;
    if (settings.kind == TrunkKind::kNone)
      options.fail(key, "goes with trunk = \"cylinder\", \"cone\" or \"painter\"");
    if (fitted) options.fail(key, "goes without groups.trunk, which the trunk is fitted to");
  }
  if (fitted && settings.kind == TrunkKind::kNone)
    options.fail("trunk", "groups.trunk needs trunk = \"cylinder\", \"cone\" or \"painter\"");
  options.finish();
  return settings;
}

std::optional<CrownSize> crown_size(const ObjectPlanes& crown) {
  const scene::PlaneSet* around = nullptr;
  if (scene::is_bounded(crown.planes))
    around = &crown.planes;
  else if (crown.grown && scene::is_bounded(crown.bound))
    around = &crown.bound;
  if (around == nullptr) {
    if (!crown.grown) return std::nullopt;
    return CrownSize{crown.centre, 2 * crown.reach, 2 * crown.reach};
  }
  const auto corners = scene::intersection_vertices(*around);
  if (!corners) return std::nullopt;
  glm::dvec3 lowest(INFINITY), highest(-INFINITY);
  for (const glm::dvec3& p : *corners) lowest = glm::min(lowest, p), highest = glm::max(highest, p);
  const glm::dvec3 size = highest - lowest;
  return CrownSize{crown.grown ? crown.centre : (lowest + highest) / 2.0, (size.x + size.z) / 2, size.y};
}

TrunkShape trunk_shape(const TrunkSettings& settings, const CrownSize& crown, double scale) {
  const double length = settings.height * crown.height * scale;
  return {crown.centre, crown.centre - glm::dvec3(0, length, 0), settings.width * crown.width / 2 * scale};
}

TrunkShape fit_trunk(const std::vector<glm::dvec3>& points, const CrownSize& crown,
                     const scene::Object& object) {
  std::vector<glm::dvec3> below;
  for (const glm::dvec3& p : points)
    if (p.y < crown.centre.y) below.push_back(p);
  if (below.size() < 6) blame(object, "the group of groups.trunk does not reach below the crown's centre");
  std::sort(below.begin(), below.end(), [](const glm::dvec3& a, const glm::dvec3& b) { return a.y < b.y; });
  const std::size_t tenth = (below.size() + 9) / 10;
  const glm::dvec3 low = mean(below, 0, tenth), high = mean(below, below.size() - tenth, below.size());
  if (!(high.y > low.y)) blame(object, "the group of groups.trunk is flat");
  const glm::dvec3 slope = (high - low) / (high.y - low.y);
  TrunkShape shape;
  shape.top = low + slope * (crown.centre.y - low.y);
  shape.bottom = low + slope * (below.front().y - low.y);
  for (const glm::dvec3& p : below) {
    const glm::dvec3 off = p - (low + slope * (p.y - low.y));
    shape.radius += std::hypot(off.x, off.z) / static_cast<double>(below.size());
  }
  return shape;
}

scene::PlaneSet trunk_planes(TrunkKind kind, const TrunkShape& shape) {
  const glm::dvec3 along = shape.bottom - shape.top;
  const double length = glm::length(along), apothem = kApothem * shape.radius;
  const glm::dvec3 down = along / length;
  scene::PlaneSet planes;
  for (int side = 0; side < kSides; ++side) {
    // An axis that leans shears the sides with it: they stay parallel to it, or meet in its top.
    glm::dvec3 normal = outward(side);
    normal -= down * glm::dot(normal, down);
    normal /= glm::length(normal);
    if (kind == TrunkKind::kCylinder) {
      planes.push_back({normal, glm::dot(normal, shape.top) + apothem});
    } else {
      const glm::dvec3 slanted = glm::normalize(normal * length - down * apothem);
      planes.push_back({slanted, glm::dot(slanted, shape.top)});
    }
  }
  planes.push_back({down, glm::dot(down, shape.bottom)});
  if (kind == TrunkKind::kCylinder) planes.push_back({-down, -glm::dot(down, shape.top)});
  return planes;
}

std::vector<std::uint32_t> Trapezium::words() const {
  std::vector<std::uint32_t> words;
  for (const double value : {left, right, left_step, right_step})
    words.push_back(static_cast<std::uint32_t>(
        static_cast<std::int32_t>(std::nearbyint(std::ldexp(value, kFractionBits)))));
  return words;
}

std::optional<Trapezium> trapezium_of(const TrunkShape& shape, const scene::Affine& view,
                                      double pixels_per_metre, int width, int height) {
  glm::dvec3 a = view(shape.top), b = view(shape.bottom);
  if (a.y > b.y) std::swap(a, b);
  const double lines = b.y - a.y;
  if (!(lines >= 1)) return std::nullopt;
  const double half = shape.radius * pixels_per_metre;
  Trapezium t;
  const double slope = (b.x - a.x) / lines;
  const double first = std::ceil(std::max(a.y, 0.0)), last = std::floor(std::min(b.y, height - 1.0));
  if (!(first <= last)) return std::nullopt;
  t.box = {0, static_cast<int>(first), width - 1, static_cast<int>(last)};
  const double middle = a.x + slope * (first - a.y);
  t.left = middle - half, t.right = middle + half;
  t.left_step = t.right_step = slope;
  const double ends[] = {middle, middle + slope * (last - first)};
  const double lowest = std::min(ends[0], ends[1]) - half, highest = std::max(ends[0], ends[1]) + half;
  if (highest < 0 || lowest > width - 1 || highest - lowest > kLargestEdge) return std::nullopt;
  t.box.x0 = std::max(0, static_cast<int>(std::floor(lowest)));
  t.box.x1 = std::min(width - 1, static_cast<int>(std::ceil(highest)));
  return t;
}

}  // namespace dendro::half_space
