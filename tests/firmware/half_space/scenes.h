#pragma once

#include <string>

#include "firmware/half_space/host/prepare.h"
#include "firmware/half_space/reference/fixed_point.h"
#include "firmware/half_space/reference/reference.h"
#include "sim/scene/scene.h"

namespace dendro::half_space::testing_scenes {

inline scene::Scene empty_scene(int side = 512) {
  scene::Scene scene;
  scene.name = "test";
  scene.file = "test.toml";
  scene.algorithm = "half_space";
  scene.image.width = scene.image.height = side;
  scene.image.where = {"test.toml", 3};
  scene.camera.height = 2.6;
  scene.camera.position = {0, 0, 5};
  scene.camera.where = {"test.toml", 6};
  scene.options = scene::Options("half_space", {"test.toml", 20});
  return scene;
}

/// Figure 4: on a two-fold axis.
inline scene::Scene icosahedron(int side = 512) {
  scene::Scene scene = empty_scene(side);
  scene::Object object;
  object.solid = "icosahedron";
  object.source_where = {"test.toml", 10};
  scene.objects = {object};
  return scene;
}

inline scene::Scene pine(int planes, int side = 512) {
  scene::Scene scene = empty_scene(side);
  scene::Object object;
  object.mesh = std::string(MESHES) + "/tree_pine_orange_large.obj";
  object.source_where = {"test.toml", 10};
  object.rotate = {0, 25, 0};
  scene.objects = {object};
  scene.camera.height = 8.4;
  scene.camera.position = {3, 6, 20};
  scene.camera.target = {0, 3.18, 0};
  scene.options.set("planes", {std::int64_t{planes}, {"test.toml", 21}});
  return scene;
}

inline scene::Scene with(
    scene::Scene scene, const std::string& key,
    const std::variant<bool, std::int64_t, double, std::string, scene::OptionValue::Array>& value) {
  scene.options.set(key, {value, {"test.toml", 22}});
  return scene;
}

inline ReferencePicture reference_of(const Prepared& prepared) {
  const PlaneProgram& program = prepared.program;
  return render_reference(prepared.screen, program.shades, program.width, program.height, program.maxdepth);
}

inline SimulatedPicture as_simulated(const FixedPointPicture& picture) {
  SimulatedPicture result;
  for (const std::uint32_t word : picture.pixels) {
    result.face.push_back(static_cast<std::uint8_t>(word >> kFaceLow & kFaceMask));
    result.front.push_back(static_cast<std::uint16_t>(word & kFieldMask));
  }
  return result;
}

inline std::vector<std::uint8_t> shown(const FixedPointPicture& picture, const std::vector<Rgb>& shades) {
  std::vector<std::uint8_t> rgb;
  for (const std::uint8_t face : as_simulated(picture).face)
    rgb.insert(rgb.end(), shades[face].begin(), shades[face].end());
  return rgb;
}

/// The error of the fixed-point picture of a scene against its reference.
inline ErrorReport error_of(const Prepared& prepared) {
  const FixedPointPicture picture = run_fixed_point(prepared.program);
  return compare(reference_of(prepared), as_simulated(picture),
                 shown(picture, prepared.program.shades).data());
}

inline double extra(const ErrorReport& report, const std::string& name) {
  for (const auto& entry : report.extra)
    if (entry.first == name) return entry.second;
  return -1;
}

}  // namespace dendro::half_space::testing_scenes
