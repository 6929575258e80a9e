#pragma once

#include <vector>

#include "firmware/half_space/host/colour_program.h"
#include "firmware/half_space/host/prepare_hulls.h"
#include "firmware/half_space/host/roughen_program.h"
#include "firmware/half_space/host/texture_settings.h"

namespace dendro::half_space {

/// A complete tree, or several, made ready for the host program.
struct PreparedTree {
  PreparedHulls hulls;  ///< without a texture the shades are those of depth; entry 0 is the bark's
  RoughenSettings roughen;
  std::vector<Roughening> roughenings;  ///< by hull, if roughness > 0; the box is that of the hull's program
  TextureSettings texture;
  CubeLayout layout;  ///< with a texture
  ColourSettings colour;
  scene::Affine texels;  ///< with a texture: pixel and stored depth to texels of colour.level
  Colouring colouring;   ///< with a texture

  bool textured() const { return texture.kind != TextureKind::kNone; }
  bool rough() const { return roughen.roughness > 0; }
};

/// Steps S1, S2, S4 and what S8 to S11 need. `pixel_bits`: of the machine's frame buffer. Throws UserError
/// for everything that the algorithm or the frame buffer cannot do.
PreparedTree prepare_tree(const scene::Scene& scene, unsigned pixel_bits);

}  // namespace dendro::half_space
