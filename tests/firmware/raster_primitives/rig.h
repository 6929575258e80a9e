#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware/lib/pixel_planes/igc_driver.h"
#include "firmware/raster_primitives/host/host_program.h"
#include "tests/support/array_port.h"

/// The shipped micro-programs on a small array, and the pixels in plain integers beside them.
namespace dendro::raster_primitives {

constexpr int kSide = 64;

inline pixel_planes::Spec small_spec(int side = kSide) { return test::square_array(side); }

/// The sources in firmware/raster_primitives/pixel_planes with these names.
lib::IgcPrograms assemble(const std::vector<std::string>& names, const Layout& layout);

using test::ArrayPort;

/// floor(T) at a pixel, from the coefficients as the translator rounds them.
std::int64_t value_at(const Stream& stream, int x, int y);

/// The pixel's depth lies on the plane's side of shadow.
bool is_on_side(const ShadowPlane& plane, int x, int y, std::int64_t depth);

/// What the micro-programs do to pixels, in integers.
struct IntegerPixels {
  IntegerPixels(const Layout& layout, std::uint32_t farthest, int side = kSide);

  void triangle(const TriangleSetup& triangle);
  void sphere(const SphereSetup& sphere);
  /// Of one triangle, into `shadow`.
  void cast(const ShadowSetup& caster);
  void texels(const Texture& texture);
  void darken(std::uint32_t farthest);

  Layout layout;
  int side;
  std::vector<std::uint32_t> depth;
  std::vector<std::array<std::uint8_t, 3>> colour;
  std::vector<std::optional<std::array<std::int64_t, 2>>> texel;  ///< u, v of pixels that show a texture
  std::vector<bool> flag, shadow;
};

/// Fails for the first pixel whose fields are others.
void expect_same(ArrayPort& port, const IntegerPixels& wanted);

}  // namespace dendro::raster_primitives
