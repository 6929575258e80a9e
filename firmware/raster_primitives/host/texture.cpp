#include "firmware/raster_primitives/host/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "sim/base/random.h"

namespace dendro::raster_primitives {
namespace {

using Colour = std::array<double, 3>;

constexpr Colour kDark = {92, 52, 28}, kLight = {214, 164, 104};

/// Waves of whole numbers of periods along both sides, so that the ends meet; about -1 to 1.
class Waves {
 public:
  Waves(std::mt19937_64& random, int most_u, int most_v) {
    for (int k = 0; k < 6; ++k)
      waves_.push_back({1 + static_cast<int>(random() % static_cast<unsigned>(most_u)),
                        static_cast<int>(random() % static_cast<unsigned>(2 * most_v + 1)) - most_v,
                        base::uniform(random, 0, 1)});
  }
  double operator()(double u, double v) const {
    double sum = 0;
    for (const Wave& wave : waves_) sum += std::sin(2 * M_PI * (wave.u * u + wave.v * v + wave.phase));
    return sum / 3;
  }

 private:
  struct Wave {
    int u, v;
    double phase;
  };
  std::vector<Wave> waves_;
};

std::uint32_t mix(double part) {
  std::uint32_t rgb = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double value = kDark[c] + (kLight[c] - kDark[c]) * std::clamp(part, 0.0, 1.0);
    rgb |= static_cast<std::uint32_t>(std::lround(value)) << (8 * c);
  }
  return rgb;
}

}  // namespace

std::uint32_t Texture::at(std::int64_t u, std::int64_t v) const {
  const std::int64_t mask = side() - 1;
  return rgb[static_cast<std::size_t>((v & mask) * side() + (u & mask))];
}

Texture make_texture(const std::string& kind, unsigned bits, std::uint64_t seed) {
  Texture texture;
  texture.bits = bits;
  std::mt19937_64 random(seed);
  const Waves bend(random, 2, 1), fibre(random, 15, 2);
  const int side = texture.side();
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double u = (x + 0.5) / side, v = (y + 0.5) / side;
      const double ring = 0.5 + 0.5 * std::sin(2 * M_PI * (4 * u + 0.5 * bend(u, v)));
      const double wood = 0.2 + 0.6 * ring + 0.15 * fibre(u, v);
      const bool odd = (8 * x / side + 8 * y / side) % 2 == 1;
      texture.rgb.push_back(mix(kind == "wood" ? wood : (odd ? 0.7 : 0.0) + 0.3 * wood));
    }
  return texture;
}

unsigned read_texture_bits(scene::Options& options) {
  const std::int64_t side = options.integer("texture_size", 64, 8, 128);
  unsigned bits = 3;
  while (std::int64_t{1} << bits < side) ++bits;
  if (std::int64_t{1} << bits != side) options.fail("texture_size", fmt::format("{} is not a power of two", side));
  return options.vectors("textured", 10).empty() ? 0 : bits;
}

std::map<std::size_t, Mapping> read_mappings(scene::Options& options, std::size_t objects) {
  std::map<std::size_t, Mapping> mappings;
  for (const std::vector<double>& row : options.vectors("textured", 10)) {
    if (!(row[0] >= 1 && row[0] <= static_cast<double>(objects) && row[0] == std::floor(row[0])))
      options.fail("textured", fmt::format("there is no object {:g}; the first is 1, the last {}", row[0], objects));
    const Mapping mapping = {{row[1], row[2], row[3]}, {row[4], row[5], row[6]}, {row[7], row[8], row[9]}};
    for (const glm::dvec3& along : {mapping.along_u, mapping.along_v})
      if (!(glm::length(along) > 1e-6)) options.fail("textured", "a repeat of the texture is shorter than a micrometre");
    if (!mappings.emplace(static_cast<std::size_t>(row[0]) - 1, mapping).second)
      options.fail("textured", fmt::format("object {:g} has two textures", row[0]));
  }
  return mappings;
}

void send_texel(lib::IgcDriver& driver, const Texture& texture, std::size_t number) {
  const std::uint64_t u = number & ((std::size_t{1} << texture.bits) - 1), v = number >> texture.bits;
  driver.run("send_texel", v << 32 | u << 24 | texture.rgb[number]);
}

}  // namespace dendro::raster_primitives
