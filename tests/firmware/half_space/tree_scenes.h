#pragma once

#include <map>

#include "firmware/half_space/host/prepare_tree.h"
#include "tests/firmware/half_space/random_hulls.h"

namespace dendro::half_space::testing_scenes {

using Value = std::variant<bool, std::int64_t, double, std::string, scene::OptionValue::Array>;

inline scene::Object with_trunk(scene::Object object, const std::map<std::string, Value>& keys) {
  for (const auto& [key, value] : keys) object.trunk_parameters[key] = {value, {"test.toml", 12}};
  return object;
}

/// A random crown above a trunk of the kind, random hulls beside it, seen from a little above.
inline scene::Scene random_tree(std::mt19937& random, const std::string& trunk, int side, int others) {
  scene::Scene scene = random_hulls(random, side, 1 + others);
  scene.image.height = std::min(side, 256);
  scene.camera.height = 3.4;
  scene.camera.position = {1, 2, 5};
  scene.camera.target = {0, -0.4, 0};
  scene.objects[0] =
      with_trunk(scene.objects[0], {{"trunk", trunk}, {"trunk_height", 1.2}, {"trunk_width", 0.2}});
  scene.seed = random();
  return scene;
}

}  // namespace dendro::half_space::testing_scenes
