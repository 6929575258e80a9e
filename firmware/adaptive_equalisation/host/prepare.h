#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "firmware/lib/pixel_planes/array_job.h"
#include "sim/scene/scene.h"

namespace dendro::adaptive_equalisation {

/// How the pixels of a contextual region are told from others.  ASSUMED DEV-100
enum class Method {
  kPolygon,  ///< four edges a grey value
  kRows      ///< two edges a row of the picture, two a grey value
};

/// Where the fields of a pixel lie in its memory.
struct Layout {
  unsigned grey_bits = 12, rank_bits = 12;

  unsigned grey() const { return 0; }
  unsigned rank() const { return grey_bits; }
  unsigned flag() const { return grey_bits + rank_bits; }
  unsigned row() const { return flag() + 1; }
  unsigned colour() const { return row() + 1; }  ///< 24 bits
  unsigned used() const { return colour() + 24; }

  /// Values of the controller's registers by their names in equalise.igc.
  std::map<std::string, unsigned> registers() const;
};

/// Coordinates of pixels, first and last.
struct Span {
  int first = 0, last = 0;
};

/// A picture ready to be equalised.
struct Prepared {
  int width = 0, height = 0;
  int region = 64;  ///< side of the contextual region, pixels
  Layout layout;
  Method method = Method::kPolygon;
  std::vector<std::uint16_t> grey;
};

/// First pixel of the contextual region of pixel `at` along an axis of `side` pixels: the region has the pixel in its middle, but
/// does not leave the picture.
int region_start(int at, int region, int side);

/// The pixels along an axis whose contextual region holds pixel `at`.
Span pixels_that_see(int at, int region, int side);

/// Throws UserError when the memory has too few bits, and for a region that does not fit the picture.
Layout choose_layout(const scene::Scene& scene, const lib::ArraySite& site);

/// Throws UserError for what the array cannot hold.
Prepared prepare(const scene::Scene& scene, const lib::ArraySite& site);

}  // namespace dendro::adaptive_equalisation
