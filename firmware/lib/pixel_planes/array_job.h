#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "firmware/job.h"
#include "firmware/lib/pixel_planes/igc_driver.h"
#include "sim/scene/scene.h"

namespace dendro::lib {

/// What a host program must know of the pixel array it drives.
struct ArraySite {
  int width = 512, height = 512;  ///< pixels
  int memory_bits = 72;
  int ports = 1;
  int renderers = 1;
  int frame_width = 0, frame_height = 0;  ///< pixels of the frame buffer; 0: the array itself is shown

  bool draws_tiles() const { return frame_width > 0; }
};

/// Throws UserError for a picture that is larger than the array, or the frame buffer of a machine that draws in tiles.
void check_picture_fits(const scene::Image& image, const ArraySite& site);

/// Bits, sign included, that hold a·x + b·y + c at every pixel of an array.
unsigned signed_bits(std::int64_t a, std::int64_t b, std::int64_t c, int width, int height);

/// The microprograms as a job reports them: each one's entry is the symbol phase_PHASE.NAME.
FirmwareImage firmware_image(const IgcPrograms& programs);

/// `bits` (1..31) bits from `low` up of every pixel of the picture that the machine shows, rows top down.
std::vector<std::uint32_t> pixel_field(const MachineView& machine, const ArraySite& site, unsigned low, unsigned bits);

/// Channels R, G, B (0..1) as shown and Z, then empty ones of `more` names.
std::vector<Layer> picture_layers(const MachineView& machine, const std::vector<std::uint32_t>& depth,
                                  const std::vector<std::string>& more);

}  // namespace dendro::lib
