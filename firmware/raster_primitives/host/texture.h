#pragma once

#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <vector>

#include "firmware/lib/pixel_planes/igc_driver.h"
#include "sim/scene/options.h"

namespace dendro::raster_primitives {

/// A square picture of 2^bits texels a side that repeats, ASSUMED DEV-106.
struct Texture {
  unsigned bits = 0;                ///< 0: none
  std::vector<std::uint32_t> rgb;   ///< rows of v; red in bits 0 to 7, then green, blue

  int side() const { return 1 << bits; }
  std::uint32_t at(std::int64_t u, std::int64_t v) const;  ///< whole texels, any number
};

/// "checker": 8 x 8 squares of two woods, or "wood": grain along v. The same for a seed; its ends meet.
Texture make_texture(const std::string& kind, unsigned bits, std::uint64_t seed);

/// How a texture lies on an object: u = (point - origin) . along_u / |along_u|^2 in repeats, v likewise; world space, metres.
struct Mapping {
  glm::dvec3 origin{}, along_u{}, along_v{};

  glm::dvec2 operator()(const glm::dvec3& point) const {
    const glm::dvec3 from = point - origin;
    return {glm::dot(from, along_u) / glm::dot(along_u, along_u), glm::dot(from, along_v) / glm::dot(along_v, along_v)};
  }
};

/// Bits of `texture_size`; 0 when no object has a texture.
unsigned read_texture_bits(scene::Options& options);

/// The rows of `textured` by the number of their object, from 0. Throws UserError for wrong ones.
std::map<std::size_t, Mapping> read_mappings(scene::Options& options, std::size_t objects);

/// Sends texel `number` of the texture to the pixels that keep its coordinates.
void send_texel(lib::IgcDriver& driver, const Texture& texture, std::size_t number);

}  // namespace dendro::raster_primitives
