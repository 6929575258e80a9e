#include "firmware/half_space/host/texture_settings.h"

#include <fmt/format.h>

#include <cmath>

#include "firmware/half_space/host/seeds.h"
#include "sim/base/error.h"

namespace dendro::half_space {
namespace {

constexpr std::uint64_t kStream = 9, kOriginStream = 10;  // of the scene's seed, for the cube
constexpr std::int64_t kMostChunks = 20'000;
constexpr std::size_t kMostColours = 16;
constexpr std::uint32_t kFrameBufferPixels = 512 * 512;
constexpr std::uint32_t kAllDraws = 0x10000;
constexpr double kLargestDisplacement = 128;  // from the middle to the ends of the values  ASSUMED DEV-050

// Leaves as chunks and as a ramp, when the scene does not say.  ASSUMED DEV-051
const std::vector<std::vector<double>> kLeafChunks = {
    {58, 104, 34, 0.35}, {84, 132, 44, 0.25}, {40, 78, 26, 0.25}, {122, 156, 66, 0.15}};
const std::vector<double> kLeafBase = {26, 54, 18};
const std::vector<std::vector<double>> kLeafRamp = {
    {14, 34, 10}, {46, 88, 28}, {88, 136, 48}, {158, 180, 92}};

bool is_level(double value) { return value >= 0 && value <= 255; }

Rgb rounded(const std::vector<double>& colour) {
  Rgb rgb;
  for (std::size_t c = 0; c < rgb.size(); ++c) rgb[c] = static_cast<std::uint8_t>(std::lround(colour[c]));
  return rgb;
}

std::vector<std::vector<double>> colours_of(scene::Options& options, const char* key, std::size_t size,
                                            std::size_t most,
                                            const std::vector<std::vector<double>>& otherwise) {
  std::vector<std::vector<double>> rows = options.vectors(key, size);
  if (!options.has(key)) rows = otherwise;
  if (rows.empty() || rows.size() > most)
    options.fail(key, fmt::format("must be a list of 1 to {} colours", most));
  for (const std::vector<double>& row : rows)
    for (int c = 0; c < 3; ++c)
      if (!is_level(row[c])) options.fail(key, "red, green and blue must be in 0..255");
  return rows;
}

std::vector<ChunkColour> read_chunk_colours(scene::Options& options, const Rgb& base) {
  constexpr double kRounding = 1e-6;
  std::vector<ChunkColour> colours;
  double sum = 0;
  for (const std::vector<double>& row : colours_of(options, "chunk_colours", 4, kMostColours, kLeafChunks)) {
    if (!(row[3] > 0)) options.fail("chunk_colours", "every share must be above 0");
    sum += row[3];
    if (sum > 1 + kRounding) options.fail("chunk_colours", "the shares add up to more than 1");
    colours.push_back(
        {rounded(row), static_cast<std::uint32_t>(std::lround(std::min(sum, 1.0) * kAllDraws))});
  }
  colours.push_back({base, kAllDraws});
  return colours;
}

std::vector<Rgb> read_ramp(scene::Options& options) {
  const std::vector<std::vector<double>> stops = colours_of(options, "texture_colours", 3, 256, kLeafRamp);
  std::vector<Rgb> ramp;
  for (int value = 0; value < 256; ++value) {
    const double at = value * static_cast<double>(stops.size() - 1) / 255;
    const auto first = std::min(static_cast<std::size_t>(at), stops.size() - 1);
    const std::size_t second = std::min(first + 1, stops.size() - 1);
    std::vector<double> colour(3);
    for (int c = 0; c < 3; ++c)
      colour[c] = stops[first][c] + (stops[second][c] - stops[first][c]) * (at - static_cast<double>(first));
    ramp.push_back(rounded(colour));
  }
  return ramp;
}

void check_place(const TextureSettings& settings, scene::Options& options, const scene::Image& image) {
  const std::uint64_t pixels = std::uint64_t{4} << 3 * settings.bits;
  const std::uint32_t room = settings.wide ? kFrameBufferPixels : kFrameBufferPixels / 2;
  if (pixels > room)
    options.fail("cube_bits",
                 fmt::format("{0} x {0} x {0} texels take {1} pixels and do not fit the {2} that "
                             "the frame buffer has for them; must be 4 or 5",
                             1 << settings.bits, pixels, room));
  if (!settings.wide && image.height > kHalfPictureLines)
    throw UserError(
        image.where.file, image.where.line, "image.height",
        fmt::format("{} lines do not fit the frame buffer beside the texture cube, which takes lines {} to "
                    "511 of 24-bit pixels; at most {}, or a machine with 32-bit pixels",
                    image.height, kHalfPictureLines, kHalfPictureLines));
}

}  // namespace

TextureSettings read_texture(scene::Options& options, const scene::Image& image, unsigned pixel_bits,
                             std::uint64_t scene_seed) {
  TextureSettings settings;
  const std::string kind = options.choice("texture", "none", {"none", "chunks", "fbm"});
  settings.kind = kind == "chunks" ? TextureKind::kChunks
                  : kind == "fbm"  ? TextureKind::kFbm
                                   : TextureKind::kNone;
  settings.from_host = options.choice("texture_from", "machine", {"machine", "host"}) == "host";
  settings.bits = static_cast<unsigned>(options.integer("cube_bits", 5, 4, 8));
  const std::string layout = options.choice("layout", "auto", {"auto", "wide", "half"});
  const bool fourth_byte = pixel_bits == 32;  // 48 bits are two words of 24 (DEV-034)
  settings.wide = layout == "auto" ? fourth_byte : layout == "wide";
  settings.seed = static_cast<std::uint64_t>(
      options.integer("texture_seed", static_cast<std::int64_t>(scene_seed), 0, INT64_MAX));
  settings.chunks = static_cast<int>(options.integer("chunks", 1000, 0, kMostChunks));
  settings.chunk_edge = static_cast<int>(options.integer("chunk_edge", 2, 1, 4));
  settings.base = rounded(options.vector("texture_base", kLeafBase, 0, 255));
  settings.chunk_colours = read_chunk_colours(options, settings.base);
  settings.hurst = options.real("texture_hurst", 0.5, 0, 1);
  settings.colours = read_ramp(options);
  if (settings.kind == TextureKind::kNone) return settings;
  if (settings.wide && !fourth_byte)
    options.fail("layout",
                 fmt::format("\"wide\" keeps the texture cube in the fourth byte of 32-bit pixels; this machine's "
                             "have {} bits",
                             pixel_bits));
  check_place(settings, options, image);
  return settings;
}

std::vector<Amplitudes> amplitudes(unsigned bits, double hurst) {
  std::vector<Amplitudes> result;
  for (unsigned halving = 0; halving < bits; ++halving) {
    const auto of = [&](double squared_distance) {
      const double share = std::pow(squared_distance / 3, hurst / 2) * std::pow(0.5, halving * hurst);
      return static_cast<std::uint32_t>(std::lround(16 * kLargestDisplacement * share));
    };
    result.push_back({of(3), of(2), of(1)});  // in half cells: to corners, across a face, along an edge
  }
  return result;
}

std::size_t texture_draws(const TextureSettings& settings) {
  constexpr std::size_t kDrawsPerChunk = 4;  // three coordinates and a colour
  switch (settings.kind) {
    case TextureKind::kNone:
      return 0;
    case TextureKind::kChunks:
      return kDrawsPerChunk * static_cast<std::size_t>(settings.chunks);
    case TextureKind::kFbm:
      return (std::size_t{1} << 3 * settings.bits) - 1;
  }
  return 0;
}

std::vector<std::uint32_t> texture_seeds(const TextureSettings& settings) {
  return seed_table(settings.seed, kStream, seeds_for(texture_draws(settings)));
}

std::vector<std::array<std::uint32_t, 3>> chunk_origins(const TextureSettings& settings) {
  std::vector<std::array<std::uint32_t, 3>> origins;
  const std::uint32_t last = (1u << settings.bits) - 1;
  for (const std::uint32_t word :
       seed_table(settings.seed, kOriginStream, seeds_for(texture_draws(settings))))
    origins.push_back({word >> 11 & last, word >> 6 & last, word >> 1 & last});
  return origins;
}

}  // namespace dendro::half_space
