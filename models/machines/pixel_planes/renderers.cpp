#include "models/machines/pixel_planes/renderers.h"

#include <utility>

#include "models/machines/pixel_planes/pixel_planes_map.h"

namespace dendro::pixel_planes {

RendererGroup::RendererGroup(const Spec& spec, std::function<Device&(std::size_t)> device)
    : spec_(spec), count_(static_cast<std::size_t>(spec.renderers.count)), device_(std::move(device)), frame_(spec) {}

bool RendererGroup::write(std::uint32_t address, std::uint32_t value) {
  if (address == kSelect) {
    selection_.number = value;
    return true;
  }
  if (address != kVideoBase && address != kVideoSize) return false;
  for (std::size_t r = 0; r < count_; ++r) device_(r).write(address, value);
  return true;
}

std::uint32_t RendererGroup::read(std::uint32_t address) const {
  return address == kSelect ? selection_.number : device_(selection_.first(count_)).read(address);
}

void RendererGroup::done(std::size_t r, const igc::Command& command, std::int64_t clock) {
  if (command.header.copy && spec_.frame.exists())
    frame_.copy(command.tile_x, command.tile_y, device_(r).engine().bits().memory, clock, r);
}

Picture RendererGroup::picture() const {
  if (!spec_.frame.exists()) return device_(0).picture();
  const VideoState& video = device_(0).video();
  return shown(video, spec_.frame.width, spec_.frame.height, [&](int x, int y) {
    return frame_.peek(static_cast<std::uint32_t>(y * spec_.frame.width + x), video.base);
  });
}

std::uint32_t RendererGroup::peek(std::uint32_t address, unsigned low) const {
  if (address >= kFramePixels) return frame_.peek(address - kFramePixels, low);
  const auto pixels = static_cast<std::uint32_t>(spec_.pixels());
  return address / pixels < count_ ? device_(address / pixels).peek(address % pixels, low) : 0;
}

}  // namespace dendro::pixel_planes
