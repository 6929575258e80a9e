#pragma once

#include <cstdint>
#include <vector>

#include "firmware/zbuffer_views/host/prepared.h"
#include "firmware/zbuffer_views/reference/layers.h"

namespace dendro::zbuffer_views {

/// A picture, row-major, the highest row first.
struct ReferencePicture {
  int width = 0, height = 0;
  std::vector<double> depth;         ///< metres along the view from the eye; infinite where nothing is
  std::vector<std::uint8_t> colour;  ///< index into the table, of the side that is seen; kNoColour where nothing is
  std::vector<std::uint8_t> shadow;  ///< 1: only ambient light
  std::vector<double> rgb;           ///< 0..255, three a pixel

  std::int64_t covered() const;
};

/// The views that a frame is made from, the light's included, at their numbers; the others are left empty.
std::vector<StoredView> needed_views(const Prepared& prepared, const Frame& frame);

/// V5 to V8: one frame of the scene from stored views.
ReferencePicture reconstruct(const Prepared& prepared, const std::vector<StoredView>& views, const Frame& frame);

/// V9: the same frame from the triangles, nearest surface at every pixel, a normal a triangle, no shadows. Perspective leaves out
/// triangles that reach before `near`.
ReferencePicture draw_polygons(const Prepared& prepared, const Frame& frame);

}  // namespace dendro::zbuffer_views
