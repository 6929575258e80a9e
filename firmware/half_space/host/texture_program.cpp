#include "firmware/half_space/host/texture_program.h"

#include "firmware/half_space/host/seeds.h"
#include "sim/base/check.h"

namespace dendro::half_space {
namespace {

using Words = std::vector<std::uint32_t>;

// Function codes and addresses of image memory [NYU-H].
constexpr unsigned kWordFunction = 0;
constexpr unsigned kWordMask = 010;
constexpr unsigned kPixelsPerWord = 8;
constexpr unsigned kCoordinates = 32;          // places of one axis in the scratch area
constexpr unsigned kTableFlops = 256 * 3 * 2;  // a product and a sum for every channel of the ramp

/// The lores bus address of the frame buffer's pixel number `pixel`.
constexpr std::uint32_t bus_address(std::uint32_t pixel) { return (pixel & 511) << 1 | pixel >> 9 << 11; }

std::uint32_t in_every_byte(std::uint8_t byte) { return byte * 0x01010101u; }

void append_texel(Words& words, const Rgb& rgb, std::uint8_t displacement) {
  for (const std::uint8_t byte : rgb) words.push_back(in_every_byte(byte));
  words.push_back(in_every_byte(displacement));
}

/// The field of a coordinate on `axis` (0 x, 1 y, 2 z) in a cube of 2^bits.
std::uint32_t field(unsigned bits, unsigned axis, std::uint32_t value) {
  return bus_address(value << (2 + axis * bits));
}

Words level_words(const CubeLayout& layout) {
  Words words;
  for (const CubeLevel& level : layout.levels) {
    std::uint32_t masks[3], all = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
      masks[axis] = field(level.bits, axis, (1u << level.bits) - 1);
      all |= masks[axis];
    }
    words.insert(words.end(), {bus_address(level.base), all, masks[0], masks[1], masks[2]});
    for (unsigned axis = 0; axis < 3; ++axis) words.push_back(~masks[axis] + field(level.bits, axis, 1));
    words.push_back(level.byte);
  }
  return words;
}

Words step_words(const TextureSettings& settings) {
  Words words;
  std::uint32_t half = 1u << settings.bits;
  for (const Amplitudes& of : amplitudes(settings.bits, settings.hurst)) {
    half >>= 1;
    for (unsigned axis = 0; axis < 3; ++axis) words.push_back(field(settings.bits, axis, half));
    words.insert(words.end(), {of.body, of.face, of.edge});
  }
  return words;
}

Words place_words(unsigned bits) {
  Words words;
  for (unsigned axis = 0; axis < 3; ++axis)
    for (std::uint32_t i = 0; i < kCoordinates; ++i)
      words.push_back(i >> bits == 0 ? field(bits, axis, i) : 0);
  return words;
}

Words palette_words(const TextureSettings& settings) {
  Words words;
  for (const ChunkColour& colour : settings.chunk_colours) {
    words.push_back(colour.below);
    append_texel(words, colour.rgb, 0);
  }
  return words;
}

Words table_words(const TextureSettings& settings) {
  Words words;
  for (std::size_t value = 0; value < settings.colours.size(); ++value)
    append_texel(words, settings.colours[value], static_cast<std::uint8_t>(value));
  return words;
}

Words origin_words(const TextureSettings& settings) {
  Words words;
  for (const auto& origin : chunk_origins(settings)) {
    std::uint32_t place = 0;
    for (unsigned axis = 0; axis < 3; ++axis) place |= field(settings.bits, axis, origin[axis]);
    words.push_back(place);
  }
  return words;
}

Words param_words(const TextureSettings& settings) {
  Words params(kTextureParamsWords);
  params[kTextureFbm] = settings.kind == TextureKind::kFbm;
  params[kTextureMipLevels] = settings.bits;
  params[kTextureChunks] = static_cast<std::uint32_t>(settings.chunks);
  params[kTextureChunkEdge] = static_cast<std::uint32_t>(settings.chunk_edge);
  params[kTextureSide] = 1u << settings.bits;
  return params;
}

/// Bytes of levels that follow each other in one byte plane.
struct Run {
  std::uint32_t first;  ///< pixel
  unsigned byte;
  std::vector<std::uint8_t> bytes;
};

std::vector<Run> runs_of(const CubeBytes& cube, const CubeLayout& layout) {
  std::vector<Run> runs;
  for (std::size_t k = 0; k < layout.levels.size(); ++k) {
    const CubeLevel& level = layout.levels[k];
    DENDRO_CHECK(cube[k].size() == level.pixels(), "level {}: {} bytes", k, cube[k].size());
    const bool follows = !runs.empty() && runs.back().byte == level.byte &&
                         runs.back().first + runs.back().bytes.size() == level.base;
    if (!follows) runs.push_back({level.base, level.byte, {}});
    runs.back().bytes.insert(runs.back().bytes.end(), cube[k].begin(), cube[k].end());
  }
  return runs;
}

/// One nibble of eight pixels a word; the last may be of fewer.
Words nibbles(const Run& run, unsigned plane) {
  Words words((run.bytes.size() + kPixelsPerWord - 1) / kPixelsPerWord);
  for (std::size_t i = 0; i < run.bytes.size(); ++i)
    words[i / kPixelsPerWord] |= (run.bytes[i] >> 4 * plane & 0xFu) << 4 * (i % kPixelsPerWord);
  return words;
}

void send_run(HostPort& host, const Run& run) {
  DENDRO_CHECK(run.first % kPixelsPerWord == 0, "{}", run.first);
  const std::size_t whole = run.bytes.size() / kPixelsPerWord;
  const std::size_t rest = run.bytes.size() % kPixelsPerWord;
  for (unsigned plane = 0; plane < 2; ++plane) {
    const Words words = nibbles(run, plane);
    const std::uint32_t first = run.byte << 16 | plane << 15 | run.first / kPixelsPerWord;
    if (whole > 0) host.dma_to(first, words.data(), whole, kWordFunction);
    if (rest == 0) continue;
    host.write(0, (1u << 4 * rest) - 1, kWordMask);
    host.write(first + static_cast<std::uint32_t>(whole), words[whole], kWordFunction);
    host.write(0, ~0u, kWordMask);
  }
}

}  // namespace

void build(HostPort& host, lib::RdsDriver& driver, const lib::ProgramImage& image,
           const TextureSettings& settings, const CubeLayout& layout) {
  DENDRO_CHECK(settings.kind != TextureKind::kNone && layout.bits() == settings.bits, "{} {}", layout.bits(),
               settings.bits);
  const auto write = [&](const char* name, const Words& words) {
    const lib::ScratchArea& area = image.scratch.at(name);
    DENDRO_CHECK(words.size() <= area.size, "{}: {} words for {}", name, words.size(), area.size);
    driver.write_scratch(area.address, words);
  };
  host.phase("load_texture");
  const bool fbm = settings.kind == TextureKind::kFbm;
  if (fbm) {
    Work work;
    work.flops = kTableFlops;
    host.compute(work);
  }
  write("params", param_words(settings));
  write("levels", level_words(layout));
  write("table", table_words(settings));
  const Words seeds = texture_seeds(settings);
  DENDRO_CHECK(seeds.size() * kDrawsPerSeed >= texture_draws(settings), "{} seeds", seeds.size());
  write("seeds", seeds);
  if (fbm) {
    write("steps", step_words(settings));
  } else {
    Words plain;
    append_texel(plain, settings.base, 0);
    write("plain", plain);
    write("palette", palette_words(settings));
    write("places", place_words(settings.bits));
    write("origins", origin_words(settings));
  }
  driver.start(image.entry);
  host.phase("finish");
  driver.wait();
}

void send(HostPort& host, const CubeBytes& cube, const CubeLayout& layout) {
  DENDRO_CHECK(cube.size() == layout.levels.size(), "{} levels for {}", cube.size(), layout.levels.size());
  host.phase("send_texture");
  for (const Run& run : runs_of(cube, layout)) send_run(host, run);
}

}  // namespace dendro::half_space
