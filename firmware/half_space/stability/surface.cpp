#include "firmware/half_space/stability/surface.h"

#include <fmt/format.h>

#include "firmware/half_space/host/hulls_layout.h"

namespace dendro::half_space {
namespace {

constexpr const char* kProgram = "firmware/half_space/rds3000/colour.gia";
constexpr unsigned kLoresPixel = 2;  // bus function code

Words frame_of(const Colouring& colouring, const std::vector<int>& nearest) {
  Words frame(kFrameSide * kFrameSide, 0);
  const CubeLevel& level = colouring.level;
  std::uint32_t at = level.base;
  const std::uint32_t side = 1u << level.bits;
  for (std::uint32_t z = 0; z < side; ++z)
    for (std::uint32_t y = 0; y < side; ++y)
      for (std::uint32_t x = 0; x < side; ++x)
        for (const std::uint32_t byte : {x, y, z, 0u}) frame[at++] = byte << 8 * level.byte;
  for (int y = 0; y < colouring.height; ++y)
    for (int x = 0; x < colouring.width; ++x)
      frame[static_cast<std::size_t>(y * kFrameSide + x)] =
          static_cast<std::uint32_t>(nearest[static_cast<std::size_t>(y * colouring.width + x)])
          << kNearestLow;
  return frame;
}

}  // namespace

std::string name_of(const Texel& texel) { return fmt::format("({}, {}, {})", texel[0], texel[1], texel[2]); }

IndexPicture draw_indices(const stability::Rig& rig, const Colouring& colouring,
                          const std::vector<int>& nearest) {
  const lib::ProgramImage image = rig.program(kProgram);
  const Words frame = frame_of(colouring, nearest);
  IndexPicture picture;
  rig.run(
      [&](HostPort& host) {
        for (std::uint32_t y = 0; y < kFrameSide; ++y)
          host.dma_to(y << 11, &frame[y * kFrameSide], kFrameSide, kLoresPixel, 2);
        lib::RdsDriver driver(host);
        driver.load_program(image);
        run_colour(driver, image, colouring);
        picture.line_q = driver.read_scratch(image.scratch.at("line_q").address, 3);
        picture.depths = driver.read_scratch(image.scratch.at("depths").address, 3 * kDepths);
      },
      [&](const MachineView& machine) {
        for (std::uint32_t y = 0; y < static_cast<std::uint32_t>(colouring.height); ++y)
          for (std::uint32_t x = 0; x < static_cast<std::uint32_t>(colouring.width); ++x)
            picture.words.push_back(machine.peek(x << 1 | y << 11, kLoresPixel));
      });
  return picture;
}

}  // namespace dendro::half_space
