#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "firmware/half_space/host/object_planes.h"
#include "firmware/half_space/host/plane_program.h"
#include "firmware/half_space/host/screen_setup.h"
#include "firmware/half_space/host/trunk.h"
#include "models/parts/host/host_port.h"
#include "sim/scene/scene.h"

namespace dendro::half_space {

/// One convex object of a picture in three registers.
struct Hull {
  std::vector<ScreenPlane> screen;
  PlaneProgram program;  ///< its first box and records; maxdepth, boxing and steep are those of the picture
  bool visible = true;   ///< false: outside the picture, nothing is sent
  bool bounded = true;
  double depth_extent = 255;  ///< from its nearest to its farthest corner, units of the registers, 0..255
};

/// The trunk of one crown: a hull, or a painter's trapezium and no hull.
struct Trunk {
  Hull hull;
  bool painter = false;
  Trapezium trapezium;
  double depth = 0;  ///< of the crown's centre, metres along the view

  bool visible() const { return hull.visible; }
};

/// A scene of one or more hulls made ready for the host program.
struct PreparedHulls {
  int width = 0, height = 0;
  int maxdepth = 255;  ///< 2^bits - 1; of a pixel that no hull covers
  std::vector<Hull> hulls;
  std::vector<Trunk> trunks;  ///< the nearest first
  std::vector<Rgb> shades;  ///< entry d the colour of depth d; entry maxdepth and those above the background
  Work growth;
  std::uint64_t setup_flops = 0;
  std::uint64_t splits = 0;
  std::vector<std::string> files;
  scene::Affine view;  ///< world to screen, z in metres along the view
  DepthMap depth;      ///< that z to units of the registers
  double pixels_per_metre = 1;

  std::size_t planes() const;  ///< of all hulls, without trunks
};

/// True when the picture takes the program with three registers: more than one hull, or `registers = 3`.
bool needs_three_registers(const scene::Scene& scene);

/// True when the picture has what only complete trees have: a texture, roughness or a trunk. Throws UserError
/// when it is asked for in two registers.
bool is_complete_tree(const scene::Scene& scene);

/// Steps S1, S2 and S4 for all objects of the scene. Throws UserError for everything that the algorithm or
/// the frame buffer cannot do.
PreparedHulls prepare_hulls(const scene::Scene& scene);

/// The same for crowns and trunks of a complete tree: no crown comes nearer than depth 1. Options that have
/// to do with neither hulls nor trunks, and the shades, are left to the caller.
PreparedHulls prepare_crowns(const scene::Scene& scene, scene::Options& options);

/// Reads what the look-up table makes of depth. All 24 bits are depth, so depth is what colour can come from.
/// ASSUMED DEV-046
std::vector<Rgb> read_depth_shades(scene::Options& options, int maxdepth);

}  // namespace dendro::half_space
