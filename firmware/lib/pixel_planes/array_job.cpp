#include "firmware/lib/pixel_planes/array_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "sim/base/error.h"

namespace dendro::lib {
namespace {

constexpr std::uint32_t kFramePixels = 1u << 31;  // where the machine shows its frame store to a debugger

}  // namespace

void check_picture_fits(const scene::Image& image, const ArraySite& site) {
  const bool tiles = site.draws_tiles();
  for (const auto& [key, side, most] : {std::tuple("image.width", image.width, tiles ? site.frame_width : site.width),
                                        {"image.height", image.height, tiles ? site.frame_height : site.height}})
    if (side > most)
      throw UserError(image.where.file, image.where.line, key,
                      fmt::format("{} is more than the {} pixels of the {}", side, most, tiles ? "frame buffer" : "array"));
}

unsigned signed_bits(std::int64_t a, std::int64_t b, std::int64_t c, int width, int height) {
  std::int64_t low = c, high = c;
  for (const auto& [slope, side] : {std::pair(a, width), std::pair(b, height)}) {
    const std::int64_t reach = slope * (side - 1);
    low += std::min<std::int64_t>(0, reach), high += std::max<std::int64_t>(0, reach);
  }
  unsigned bits = 1;
  while (low < -(std::int64_t{1} << (bits - 1)) || high >= std::int64_t{1} << (bits - 1)) ++bits;
  return bits;
}

FirmwareImage firmware_image(const IgcPrograms& programs) {
  FirmwareImage image{programs.name, programs.sha256, {}};
  for (const auto& [name, entry] : programs.entries) image.symbols["phase_" + entry.phase + "." + name] = entry.at;
  return image;
}

std::vector<std::uint32_t> pixel_field(const MachineView& machine, const ArraySite& site, unsigned low, unsigned bits) {
  const std::uint32_t mask = (1u << bits) - 1, first = site.draws_tiles() ? kFramePixels : 0;
  const int width = site.draws_tiles() ? site.frame_width : site.width;
  std::vector<std::uint32_t> values;
  for (int y = 0; y < machine.height; ++y)
    for (int x = 0; x < machine.width; ++x)
      values.push_back(machine.peek(first + static_cast<std::uint32_t>(y * width + x), low) & mask);
  return values;
}

std::vector<Layer> picture_layers(const MachineView& machine, const std::vector<std::uint32_t>& depth,
                                  const std::vector<std::string>& more) {
  std::vector<Layer> layers;
  for (const char* name : {"R", "G", "B", "Z"}) layers.push_back({name, std::vector<float>(depth.size())});
  for (const std::string& name : more) layers.push_back({name, std::vector<float>(depth.size())});
  for (std::size_t i = 0; i < depth.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) layers[c].values[i] = static_cast<float>(machine.rgb[3 * i + c]) / 255.0f;
    layers[3].values[i] = static_cast<float>(depth[i]);
  }
  return layers;
}

}  // namespace dendro::lib
