#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "firmware/half_space/host/prepare.h"
#include "firmware/job.h"

namespace dendro::half_space {

/// The picture in double precision, straight from the planes: per pixel the nearest back plane, the farthest
/// front plane, and every edge-on plane. Knows nothing of records, boxes or fixed point.
struct ReferencePicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> face;  ///< per pixel: 0 background, else the face number
  std::vector<double> depth;       ///< per pixel: real depth in register units where covered, else 0
  std::vector<std::uint8_t> rgb;   ///< through the shades

  std::size_t at(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }
};

/// `maxdepth` bounds the depth as the register does: in front of 0 is 0, and a back plane there or beyond is
/// none.
ReferencePicture render_reference(const std::vector<ScreenPlane>& planes, const std::vector<Rgb>& shades,
                                  int width, int height, int maxdepth);

/// What a run left in the image memory, from the words of its pixels after pass 4.
struct SimulatedPicture {
  std::vector<std::uint8_t> face;
  std::vector<std::uint16_t> front;
};

SimulatedPicture read_back(const MachineView& machine, int width, int height);

/// Figures: psnr over the shown RGB (the machine's `rgb`, same size); max_depth_error = largest |front + 1/2
/// - z| over pixels whose face agrees; wrong_pixels = coverage or face differs; extra: wrong_pixels_far =
/// those among them whose 8 neighbours all show the same face in the reference, worst_x, worst_y = the pixel
/// of the largest depth error.
ErrorReport compare(const ReferencePicture& reference, const SimulatedPicture& simulated,
                    const std::uint8_t* rgb);

}  // namespace dendro::half_space
