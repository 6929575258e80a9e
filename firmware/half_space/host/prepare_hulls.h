#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "firmware/half_space/host/object_planes.h"
#include "firmware/half_space/host/plane_program.h"
#include "models/parts/host/host_port.h"
#include "sim/scene/scene.h"

namespace dendro::half_space {

/// One convex object of a picture in three registers.
struct Hull {
  std::vector<ScreenPlane> screen;
  PlaneProgram program;  ///< its first box and records; maxdepth, boxing and steep are those of the picture
  bool visible = true;   ///< false: outside the picture, nothing is sent
  bool bounded = true;
};

/// A scene of one or more hulls made ready for the host program.
struct PreparedHulls {
  int width = 0, height = 0;
  int maxdepth = 255;  ///< 2^bits - 1; of a pixel that no hull covers
  std::vector<Hull> hulls;
  std::vector<Rgb> shades;  ///< entry d the colour of depth d; entry maxdepth and those above the background
  Work growth;
  std::uint64_t setup_flops = 0;
  std::uint64_t splits = 0;
  std::vector<std::string> files;

  std::size_t planes() const;
};

/// True when the picture takes the program with three registers: more than one hull, or `registers = 3`.
bool needs_three_registers(const scene::Scene& scene);

/// Steps S1, S2 and S4 for all objects of the scene. Throws UserError for everything that the algorithm or
/// the frame buffer cannot do.
PreparedHulls prepare_hulls(const scene::Scene& scene);

}  // namespace dendro::half_space
