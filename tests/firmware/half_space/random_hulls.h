#pragma once

#include <cmath>
#include <random>

#include "firmware/half_space/host/hulls_layout.h"
#include "firmware/half_space/host/prepare_hulls.h"
#include "tests/firmware/half_space/scenes.h"

namespace dendro::half_space::testing_scenes {

/// How large a random hull is and how it is cut.
struct HullShape {
  double nearest = 0.3, farthest = 0.8;  ///< of its planes from its centre
  unsigned cuts = 8;                     ///< fewer than so many beside the box
  double flatness = 2000;                ///< of every third cut, which is nearly edge-on
};

/// A random closed hull around the origin: an axis box, some of its planes edge-on, cut by random planes,
/// every third of them nearly edge-on and so steep.
inline scene::Object random_object(std::mt19937& random, const HullShape& shape) {
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> offset(shape.nearest, shape.farthest);
  scene::Object object;
  object.source_where = {"test.toml", 10};
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) {
      scene::PlaneEntry plane;
      plane.normal = {0, 0, 0};
      plane.normal[axis] = sign;
      plane.offset = offset(random);
      object.planes.push_back(plane);
    }
  const int more = static_cast<int>(random() % shape.cuts);
  for (int i = 0; i < more; ++i) {
    scene::PlaneEntry plane;
    plane.normal = {gauss(random), gauss(random),
                    i % 3 == 0 ? gauss(random) / shape.flatness : gauss(random)};
    plane.offset =
        offset(random) * std::sqrt(plane.normal[0] * plane.normal[0] + plane.normal[1] * plane.normal[1] +
                                   plane.normal[2] * plane.normal[2]);
    object.planes.push_back(plane);
  }
  return object;
}

/// The same somewhere near the origin.
inline scene::Object random_object(std::mt19937& random) {
  std::normal_distribution<double> gauss;
  const scene::Vector3 at = {gauss(random) / 4, gauss(random) / 4, gauss(random) / 4};
  scene::Object object = random_object(random, HullShape{});
  object.at = at;
  return object;
}

/// The third register of every pixel.
inline std::vector<std::uint8_t> nearest_of(const FixedPointPicture& picture) {
  std::vector<std::uint8_t> nearest;
  for (const std::uint32_t word : picture.pixels)
    nearest.push_back(static_cast<std::uint8_t>(word >> kNearestLow & kHullField));
  return nearest;
}

/// What the look-up table makes of it.
inline std::vector<std::uint8_t> shown(const std::vector<std::uint8_t>& nearest,
                                       const std::vector<Rgb>& shades) {
  std::vector<std::uint8_t> rgb;
  for (const std::uint8_t depth : nearest) rgb.insert(rgb.end(), shades[depth].begin(), shades[depth].end());
  return rgb;
}

inline scene::Scene random_hulls(std::mt19937& random, int side, int count) {
  scene::Scene scene = empty_scene(side);
  for (int i = 0; i < count; ++i) scene.objects.push_back(random_object(random));
  return scene;
}

inline scene::Scene tree(int generations, int side = 256) {
  scene::Scene scene = empty_scene(side);
  scene::Object object;
  object.tree = "round";
  object.source_where = {"test.toml", 10};
  object.tree_parameters["generations"] = {std::int64_t{generations}, {"test.toml", 11}};
  scene.objects = {object};
  scene.camera.height = 4;
  return scene;
}

/// Start normals that leave a crown open to below, to the left and to the back.
inline scene::OptionValue open_start() {
  using Array = scene::OptionValue::Array;
  const auto vector = [](double x, double y, double z) {
    return scene::OptionValue{Array{{x, {}}, {y, {}}, {z, {}}}, {"test.toml", 15}};
  };
  return {Array{vector(0.4, 0, 0), vector(0, 0.4, 0), vector(0, 0, 0.4)}, {"test.toml", 15}};
}

inline scene::Scene grove(int count, int side = 256) {
  scene::Scene scene = tree(1, side);
  scene.camera.position = {0, 3, 5};
  auto& parameters = scene.objects[0].tree_parameters;
  parameters["copies"] = {std::int64_t{count}, {"test.toml", 12}};
  parameters["radius"] = {0.4, {"test.toml", 13}};
  parameters["copies_area"] = {scene::OptionValue::Array{{3.0, {}}, {3.0, {}}}, {"test.toml", 14}};
  return scene;
}

}  // namespace dendro::half_space::testing_scenes
