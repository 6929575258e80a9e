#pragma once

#include <cstdint>
#include <vector>

#include "firmware/half_space/host/plane_program.h"
#include "firmware/lib/rds3000/rds_driver.h"
#include "sim/scene/options.h"

// S8, the host's side of roughen.gia. Tile, amplitudes and their units are ours.  ASSUMED DEV-053

namespace dendro::half_space {

constexpr int kTileSide = 64;              ///< the stochastic field repeats after so many pixels
constexpr int kTileStages = 12;            ///< middles of squares and of sides, six halvings
constexpr int kAmplitudeFractionBits = 7;  ///< of an amplitude; a random number has 15
constexpr std::size_t kTileDraws = kTileSide * kTileSide - 1;

/// The scene's keys `roughness` (0..1, default 0: no roughening) and `roughness_hurst` (0.05..1, default
/// 0.5).
struct RoughenSettings {
  double roughness = 0;  ///< largest displacement of the first stage, share of the crown's depth extent
  double hurst = 0.5;    ///< the displacement falls by 2^(-hurst/2) a stage
};
RoughenSettings read_roughen(scene::Options& options);

/// Everything that one run of roughen.gia is told.
struct Roughening {
  Box box;                                ///< pixels whose front is moved
  int maxdepth = 255;                     ///< back of a pixel that no back plane bounds
  std::vector<std::uint32_t> amplitudes;  ///< kTileStages, of 2^-7 depths, below 2^15
  std::vector<std::uint32_t> seeds;       ///< kTileDraws of random numbers
};

constexpr std::uint64_t kFlopsRoughening =
    2 + 2 * kTileStages;  ///< on the host: a product and a rounding each

/// `extent`: of the crown, in depths, 0..255; `seed` and `stream` as for seed_table: a crown's own field.
Roughening make_roughening(const RoughenSettings& settings, double extent, const Box& box, int maxdepth,
                           std::uint64_t seed, std::uint64_t stream);

/// Moves the fronts: scratch words, start, wait. The program must be in the control store.
void run_roughen(lib::RdsDriver& driver, const lib::ProgramImage& image, const Roughening& roughening);

}  // namespace dendro::half_space
