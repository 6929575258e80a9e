#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "firmware/half_space/host/cube_layout.h"
#include "firmware/half_space/host/plane_program.h"
#include "firmware/half_space/host/screen_setup.h"
#include "firmware/lib/rds3000/rds_driver.h"
#include "sim/scene/options.h"
#include "sim/scene/view.h"

// S10 and S11, the host's side of colour.gia.

namespace dendro::half_space {

constexpr int kFarthest = 255;  ///< nearest depth of a pixel without hull; 0 is a trunk's
constexpr int kDepths = 256;
constexpr std::uint64_t kFlopsTexelMap = 9 + 9 + 18 + 2 * 12;  ///< inverse, scales, shift, rounding

/// The scene's keys `texels_per_metre`, `mip`, `trunk_base`, `trunk_range` and `background`.
struct ColourSettings {
  double texels_per_metre = 1;  ///< of the finest level
  unsigned level = 0;           ///< of the cube, 0 the finest
  Rgb background{}, trunk_base{}, trunk_range{};
};

/// `bits` of the finest level. Without `texels_per_metre` the cube fills half the picture's height; without
/// `mip` (or -1) the level is round(log2(texels per pixel)) within 0..bits [FG86 3].  ASSUMED DEV-054
ColourSettings read_colour(scene::Options& options, unsigned bits, double camera_height, int image_height);

/// From pixel x, y and stored depth to texels of the level: the middle of the depth's step, back through view
/// and depth map, world metres times texels per metre, the world's origin on a texel's corner.
scene::Affine texel_map(const scene::Affine& view, const DepthMap& depth, double texels_per_metre,
                        unsigned level);

/// 16.16 modulo 2^32, to nearest. A coordinate counts modulo the cube's side, which divides 2^16, so nothing
/// is lost.
std::uint32_t to_texel_word(double value);

/// Everything that one run of colour.gia is told.
struct Colouring {
  using Vector = std::array<std::uint32_t, 3>;   ///< 16.16 texels of the level
  int width = 0, height = 0;                     ///< pixels of the picture
  Vector start{}, step_x{}, step_y{}, step_z{};  ///< M at pixel (0, 0) and depth 0, and its columns
  CubeLevel level;
  Rgb background{}, bark_base{}, bark_range{};  ///< base + range below 256  ASSUMED DEV-055
  std::vector<std::uint32_t> seeds;             ///< three random numbers for each pixel of a trunk
};

/// `trunk_pixels`: at most so many have nearest depth 0.
Colouring make_colouring(const ColourSettings& settings, const scene::Affine& map, const CubeLayout& layout,
                         int width, int height, std::size_t trunk_pixels, std::uint64_t seed,
                         std::uint64_t stream);

/// Colours the picture: scratch words, start, wait. Program and cube must be in place.
void run_colour(lib::RdsDriver& driver, const lib::ProgramImage& image, const Colouring& colouring);

}  // namespace dendro::half_space
