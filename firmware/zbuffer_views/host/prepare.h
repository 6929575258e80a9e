#pragma once

#include "firmware/zbuffer_views/host/prepared.h"
#include "sim/scene/scene.h"

namespace dendro::zbuffer_views {

/// What a scene's own table says beside what every picture needs.
struct RunSettings {
  bool polygons = false;        ///< draw the triangles, not the views
  bool time_precompute = false; ///< make the views at the level of the run, not at `function`
  std::string views_file;       ///< saved views to load; empty: make them
  bool save_views = false;
  bool animate = false;  ///< more than one frame
};

/// The frame as seen after the camera, and with `light_too` the light, went `degrees` about the vertical through `axis`, from z
/// towards x; in single precision.
Frame turned(const Frame& frame, const glm::dvec3& axis, double degrees, bool light_too);

/// Everything that a scene asks for. Throws UserError.
Prepared prepare(const scene::Scene& scene, RunSettings& settings);

}  // namespace dendro::zbuffer_views
