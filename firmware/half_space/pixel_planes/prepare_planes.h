#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "firmware/half_space/host/plane_program.h"
#include "firmware/lib/pixel_planes/array_job.h"
#include "firmware/lib/pixel_planes/igc_driver.h"
#include "firmware/lib/pixel_planes/tiles.h"
#include "models/parts/host/host_port.h"
#include "sim/scene/scene.h"

namespace dendro::half_space {

using lib::ArraySite;

enum class StreamVariant { kTwoStream, kScratch };  ///< how a plane gets into its register
enum class Colouring { kRecolour, kIndex };         ///< how a front plane's colour gets into the picture

/// Bits of a pixel and how they are used.  ASSUMED DEV-083
struct PixelLayout {
  unsigned depth_bits = 16;
  unsigned front = 0, back = 16, nearest = 32, colour = 48, scratch = 72, index = 72;
  unsigned used = 72;
  StreamVariant variant = StreamVariant::kTwoStream;
  Colouring colouring = Colouring::kRecolour;

  /// Values of the controller's registers by their names in half_space.igc.
  std::map<std::string, unsigned> registers() const;
};

/// A plane as it is streamed. Front and back planes: its depth. Edge-on planes: negative outside.
struct StreamPlane {
  PlaneKind kind = PlaneKind::kFront;
  lib::Expression expression;
  unsigned fraction = 0, guard = 0;
  int face = 0;  ///< front planes: index into `faces`
  std::size_t screen = 0;  ///< index into the hull's `screen`
};

struct StreamHull {
  std::vector<ScreenPlane> screen;
  std::vector<StreamPlane> planes;  ///< back, edge-on, front; as sent
  Box box;                          ///< pixels outside it cannot be covered
  bool visible = true, bounded = true;
  bool before_screen = false;       ///< reaches in front of depth 0, where front planes cannot be told apart
  Rgb first_shade{};                ///< then: the colour of what is cut off
};

/// What is drawn in a tile: numbers of hulls in their order, each with its planes as they are streamed there.
struct TilePlanes {
  lib::Tile tile;
  std::vector<std::pair<std::size_t, std::vector<StreamPlane>>> hulls;
};

/// A scene made ready for Pixel-Planes.
struct PreparedPlanes {
  int width = 0, height = 0;
  PixelLayout layout;
  std::int64_t maxdepth = 65535;
  std::vector<StreamHull> hulls;
  std::vector<TilePlanes> tiles;
  std::vector<Rgb> faces;  ///< shade of every front plane, by its number in StreamPlane::face
  Rgb background{};
  Work growth;
  std::vector<std::string> files;

  std::size_t planes(PlaneKind kind) const;
};

/// Floating-point operations of one plane on the host: transform, slopes, guard from the depths at four corners, shade.
extern const std::uint64_t kFlopsStreamPlane;

/// Of these the ones that come anew in every tile: the constant at its corner, the guard.
constexpr std::uint64_t kFlopsTilePlane = 4 + 4 * 4;

/// The pixel's layout for the options of a scene. Throws UserError when the memory does not hold it.
PixelLayout choose_layout(const scene::Scene& scene, const ArraySite& site);

/// Steps S1, S2 and S4 for all objects of the scene. Throws UserError for everything that the algorithm or the array
/// cannot do.
PreparedPlanes prepare_planes(const scene::Scene& scene, const ArraySite& site);

/// The plane as it is streamed to an array of `site`; one too steep for any number of guard bits becomes edge-on at the
/// middle of the depths. Throws UserError with `where` for a plane that is not finite in single precision.
StreamPlane make_stream_plane(const ScreenPlane& plane, const ArraySite& site, const PixelLayout& layout,
                              unsigned fraction, unsigned least_guard, unsigned edge_fraction, const scene::Where& where);

/// A plane of the whole picture as it is streamed to the array of `site` that draws `tile`.
StreamPlane plane_in_tile(const StreamPlane& whole, const ScreenPlane& screen, const lib::Tile& tile, const ArraySite& site,
                          const PixelLayout& layout, unsigned least_guard);

}  // namespace dendro::half_space
