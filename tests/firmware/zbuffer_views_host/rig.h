#pragma once

#include <utility>

#include "firmware/zbuffer_views/host/prepare.h"
#include "firmware/zbuffer_views/host/tree_object.h"

namespace dendro::zbuffer_views {

inline void set(scene::Scene& scene, const std::string& key,
                std::variant<bool, std::int64_t, double, std::string, scene::OptionValue::Array> value) {
  scene.options.set(key, {std::move(value), {"test.toml", 7}});
}

/// A scene of one young magnolia of some thousand triangles in a picture of 100x160.
inline scene::Scene small_scene() {
  scene::Scene scene;
  scene.file = "test.toml";
  scene.image = {100, 160, {}};
  scene.camera.height = 4;
  scene.camera.position = {0, 3, 12};
  scene.camera.target = {0, 1.2, 0};
  scene::Object object;
  object.tree = "magnolia";
  object.tree_parameters["age"].value = std::int64_t{9};
  object.tree_parameters["leaf_rows"].value = std::int64_t{5};
  scene.objects.push_back(object);
  scene.options = scene::Options("zbuffer_views");
  set(scene, "view_width", std::int64_t{152});
  set(scene, "view_height", std::int64_t{304});
  return scene;
}

inline Prepared prepared_of(const scene::Scene& scene) {
  RunSettings settings;
  return prepare(scene, settings);
}

/// A tree of the given triangles, all of one part, that is seen by every option's default.
inline Prepared prepared_of(TreeModel model, const scene::Scene& scene = small_scene()) {
  Prepared p = prepared_of(scene);
  p.tree = tree_of(std::move(model), {Rgb{200, 100, 50}, Rgb{150, 120, 80}, Rgb{60, 180, 40}, Rgb{220, 230, 200}});
  p.placements = {{p.tree.centre, 0}};
  return p;
}

}  // namespace dendro::zbuffer_views
