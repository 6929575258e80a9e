#include "firmware/half_space/host/colour_program.h"

#include <algorithm>
#include <cmath>

#include "firmware/half_space/host/seeds.h"
#include "sim/base/check.h"

namespace dendro::half_space {
namespace {

std::uint32_t packed(const Rgb& rgb) {
  return rgb[0] | static_cast<std::uint32_t>(rgb[1]) << 8 | static_cast<std::uint32_t>(rgb[2]) << 16;
}

Rgb bytes_of(const std::vector<double>& values) {
  Rgb rgb{};
  for (std::size_t i = 0; i < 3; ++i) rgb[i] = static_cast<std::uint8_t>(std::lround(values[i]));
  return rgb;
}

std::vector<std::uint32_t> words(const Colouring::Vector& vector) { return {vector.begin(), vector.end()}; }

Colouring::Vector column(const glm::dvec3& v) {
  return {to_texel_word(v.x), to_texel_word(v.y), to_texel_word(v.z)};
}

}  // namespace

ColourSettings read_colour(scene::Options& options, unsigned bits, double camera_height, int image_height) {
  ColourSettings settings;
  settings.texels_per_metre = options.real("texels_per_metre", 2.0 * (1 << bits) / camera_height, 1e-6, 1e6);
  const auto mip = options.integer("mip", -1, -1, bits);
  const double per_pixel = settings.texels_per_metre * camera_height / image_height;
  settings.level = static_cast<unsigned>(
      mip >= 0 ? mip : std::clamp<std::int64_t>(std::lround(std::log2(per_pixel)), 0, bits));
  settings.background = to_rgb(options.vector("background", {0, 0, 0}, 0, 1), 1.0);
  settings.trunk_base = bytes_of(options.vector("trunk_base", {60, 30, 10}, 0, 255));
  settings.trunk_range = bytes_of(options.vector("trunk_range", {40, 20, 10}, 0, 255));
  for (std::size_t i = 0; i < 3; ++i)
    if (settings.trunk_base[i] + settings.trunk_range[i] > 255)
      options.fail("trunk_range", "trunk_base + trunk_range must be at most 255 in every channel");
  return settings;
}

scene::Affine texel_map(const scene::Affine& view, const DepthMap& depth, double texels_per_metre,
                        unsigned level) {
  const glm::dmat3 world = glm::inverse(view.linear);
  const double scale = std::ldexp(texels_per_metre, -static_cast<int>(level));
  scene::Affine map;
  map.linear = world * scale;
  map.linear[2] /= depth.scale;
  const glm::dvec3 first(-view.shift.x, -view.shift.y, (0.5 - depth.shift) / depth.scale - view.shift.z);
  map.shift = world * first * scale;
  return map;
}

std::uint32_t to_texel_word(double value) {
  DENDRO_CHECK(std::isfinite(value), "{}", value);
  const double reduced = std::remainder(value, 65536.0);
  return static_cast<std::uint32_t>(std::llround(std::ldexp(reduced, kFractionBits)));
}

Colouring make_colouring(const ColourSettings& settings, const scene::Affine& map, const CubeLayout& layout,
                         int width, int height, std::size_t trunk_pixels, std::uint64_t seed,
                         std::uint64_t stream) {
  Colouring colouring;
  colouring.width = width, colouring.height = height;
  colouring.start = column(map.shift);
  colouring.step_x = column(map.linear[0]);
  colouring.step_y = column(map.linear[1]);
  colouring.step_z = column(map.linear[2]);
  colouring.level = layout.levels.at(settings.level);
  colouring.background = settings.background;
  colouring.bark_base = settings.trunk_base;
  colouring.bark_range = settings.trunk_range;
  colouring.seeds = seed_table(seed, stream, seeds_for(3 * trunk_pixels));
  return colouring;
}

void run_colour(lib::RdsDriver& driver, const lib::ProgramImage& image, const Colouring& colouring) {
  const auto write = [&](const char* name, const std::vector<std::uint32_t>& values) {
    const lib::ScratchArea& area = image.scratch.at(name);
    DENDRO_CHECK(values.size() <= area.size, "{} {}", name, values.size());
    driver.write_scratch(area.address, values);
  };
  const CubeLevel& level = colouring.level;
  DENDRO_CHECK(level.byte != 2 && level.byte <= 3, "{}", level.byte);
  write("params",
        {static_cast<std::uint32_t>(colouring.width - 1), static_cast<std::uint32_t>(colouring.height - 1)});
  write("line_q", words(colouring.start));
  write("step_x", words(colouring.step_x));
  write("step_y", words(colouring.step_y));
  write("step_z", words(colouring.step_z));
  std::vector<std::uint32_t> scales, masks, ranges;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const unsigned low = 2 + axis * level.bits;
    scales.push_back(1u << low);
    masks.push_back(((1u << level.bits) - 1) << low);
    DENDRO_CHECK(colouring.bark_base[axis] + colouring.bark_range[axis] < 256, "{}", axis);
    ranges.push_back(colouring.bark_range[axis] + 1u);
  }
  write("scales", scales);
  write("masks", masks);
  write("base", {level.base});
  write("byte", {level.byte});
  write("background", {packed(colouring.background)});
  write("bark_base", {packed(colouring.bark_base)});
  write("bark_range", ranges);
  write("seeds", colouring.seeds);
  driver.start(image.entry);
  driver.wait();
}

}  // namespace dendro::half_space
