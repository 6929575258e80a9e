#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "firmware/half_space/host/cube_layout.h"
#include "firmware/half_space/host/plane_program.h"
#include "sim/scene/scene.h"

namespace dendro::half_space {

enum class TextureKind {
  kNone,
  kChunks,  ///< small blocks of colour at random places [FG86 4]
  kFbm,     ///< fractional Brownian motion: periodic midpoint displacement [FG86 4]
};

/// A chunk takes the first colour whose `below` is greater than a draw of 0..65535.
struct ChunkColour {
  Rgb rgb{};
  std::uint32_t below = 0;
};

/// What the texture cube is made of (S9), as the scene asks for it.
struct TextureSettings {
  TextureKind kind = TextureKind::kNone;
  bool from_host = false;  ///< made beforehand and sent, instead of made by the machine
  unsigned bits = 5;       ///< 2^bits texels a side
  bool wide = false;       ///< see CubeLayout
  std::uint64_t seed = 1;
  int chunks = 1000;                       ///< how many
  int chunk_edge = 2;                      ///< texels
  std::vector<ChunkColour> chunk_colours;  ///< the last is the base colour, below 65536
  Rgb base{};                              ///< between the chunks
  double hurst = 0.5;
  std::vector<Rgb> colours;  ///< of the values 0 to 255
};

/// Bytes of the cube by level, the finest first; a level's texels in the order of their addresses, red,
/// green, blue, displacement of each.
using CubeBytes = std::vector<std::vector<std::uint8_t>>;

/// The random number's share of a texel's value, in sixteenths of it either way, for the middles of cells,
/// faces and edges.
struct Amplitudes {
  std::uint32_t body = 0, face = 0, edge = 0;
};

/// Reads the keys texture, texture_from, cube_bits, layout, texture_seed, chunks, chunk_edge, chunk_colours,
/// texture_base, texture_hurst and texture_colours. `pixel_bits`: of the machine's frame buffer. Throws
/// UserError for wrong values, and when there is a texture and the cube does not fit the frame buffer beside
/// the picture.
TextureSettings read_texture(scene::Options& options, const scene::Image& image, unsigned pixel_bits,
                             std::uint64_t scene_seed);

/// Of every halving of the cells, the largest first: `bits` of them. They fall with the distance between the
/// texel and those that it is the mean of, to the power of the Hurst exponent; the first spans all values.
/// ASSUMED DEV-050
std::vector<Amplitudes> amplitudes(unsigned bits, double hurst);

/// Random numbers that the machine draws for the cube.
std::size_t texture_draws(const TextureSettings& settings);

/// Their seeds.
std::vector<std::uint32_t> texture_seeds(const TextureSettings& settings);

/// For every seed a texel from which the places of its chunks count. Three numbers in a row of the generator
/// lie on few planes; the planes of all seeds are the same, but not their origins.  ASSUMED DEV-051
std::vector<std::array<std::uint32_t, 3>> chunk_origins(const TextureSettings& settings);

}  // namespace dendro::half_space
