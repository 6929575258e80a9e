#include "tests/firmware/raster_primitives/rig.h"

#include <gtest/gtest.h>

#include "models/parts/igc/igc.h"

namespace dendro::raster_primitives {

lib::IgcPrograms assemble(const std::vector<std::string>& names, const Layout& layout) {
  std::vector<std::string> paths;
  for (const std::string& name : names) paths.push_back(std::string(IGC_SOURCES) + "/" + name);
  return test::assemble_files(paths, register_values(layout));
}

std::int64_t value_at(const Stream& stream, int x, int y) {
  return (igc::translate(stream.at.a, stream.fraction) * x + igc::translate(stream.at.b, stream.fraction) * y +
          igc::translate(stream.at.c, stream.fraction)) >> stream.fraction;
}

IntegerPixels::IntegerPixels(const Layout& l, std::uint32_t farthest, int s) : layout(l), side(s) {
  const auto pixels = static_cast<std::size_t>(side * side);
  depth.assign(pixels, farthest);
  colour.assign(pixels, {});
  texel.resize(pixels);
  flag.assign(pixels, false);
  shadow = flag;
}

void IntegerPixels::triangle(const TriangleSetup& triangle) {
  const std::uint32_t mask = static_cast<std::uint32_t>((std::uint64_t{1} << layout.depth_bits) - 1);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const auto at = static_cast<std::size_t>(y * side + x);
      flag[at] = true;
      for (const Stream& edge : triangle.edge) flag[at] = flag[at] && value_at(edge, x, y) >= 0;
      const auto z = static_cast<std::uint32_t>(value_at(triangle.depth, x, y)) & mask;
      flag[at] = flag[at] && z < depth[at];
      if (!flag[at]) continue;
      depth[at] = z;
      texel[at].reset();
      if (triangle.texel) {
        texel[at] = {value_at((*triangle.texel)[0], x, y), value_at((*triangle.texel)[1], x, y)};
        continue;
      }
      for (std::size_t c = 0; c < 3; ++c) colour[at][c] = static_cast<std::uint8_t>(value_at(triangle.colour[c], x, y));
    }
}

namespace {

/// Sum of the digits' multiples of S, each cut off on its own.
std::int64_t multiple(const std::vector<Digit>& digits, std::int64_t square) {
  std::int64_t sum = 0;
  for (const Digit& digit : digits)
    sum += digit.sign * (digit.shift >= 0 ? square << digit.shift : square >> -digit.shift);
  return sum;
}

}  // namespace

void IntegerPixels::sphere(const SphereSetup& sphere) {
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const auto at = static_cast<std::size_t>(y * side + x);
      const std::int64_t square = sphere.a * x + sphere.b * y + sphere.c - x * x - y * y;
      const std::int64_t bulge = multiple(sphere.bulge, square);
      flag[at] = square >= 0 && sphere.depth < depth[at] + bulge;
      if (!flag[at]) continue;
      depth[at] = static_cast<std::uint32_t>(sphere.depth - bulge);
      for (std::size_t c = 0; c < 3; ++c)
        colour[at][c] = static_cast<std::uint8_t>(value_at(sphere.colour[c], x, y) + multiple(sphere.shine[c], square));
    }
}

bool is_on_side(const ShadowPlane& plane, int x, int y, std::int64_t depth) {
  const std::int64_t value = value_at(plane.stream, x, y);
  switch (plane.side) {
    case ShadowPlane::Side::kBehind: return value < depth;
    case ShadowPlane::Side::kBefore: return value >= depth;
    case ShadowPlane::Side::kBeside: return value >= 0;
    default: return value < 0;
  }
}

void IntegerPixels::cast(const ShadowSetup& caster) {
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const auto at = static_cast<std::size_t>(y * side + x);
      flag[at] = true;
      for (const ShadowPlane& plane : caster.planes) flag[at] = flag[at] && is_on_side(plane, x, y, depth[at]);
      shadow[at] = shadow[at] || flag[at];
    }
}

void IntegerPixels::texels(const Texture& texture) {
  for (std::size_t at = 0; at < texel.size(); ++at) {
    if (!texel[at]) continue;
    const std::uint32_t rgb = texture.at((*texel[at])[0], (*texel[at])[1]);
    for (unsigned c = 0; c < 3; ++c) colour[at][c] = static_cast<std::uint8_t>(rgb >> (8 * c));
  }
}

void IntegerPixels::darken(std::uint32_t farthest) {
  for (std::size_t at = 0; at < depth.size(); ++at)
    if (shadow[at] && depth[at] != farthest)
      for (std::uint8_t& part : colour[at]) part = static_cast<std::uint8_t>(part / 2);
}

void expect_same(ArrayPort& port, const IntegerPixels& wanted) {
  for (int y = 0; y < wanted.side; ++y)
    for (int x = 0; x < wanted.side; ++x) {
      const auto at = static_cast<std::size_t>(y * wanted.side + x);
      const auto& rgb = wanted.colour[at];
      ASSERT_EQ(port.field(x, y, wanted.layout.depth, wanted.layout.depth_bits), wanted.depth[at]) << x << " " << y;
      ASSERT_EQ(port.field(x, y, wanted.layout.flag, 1), wanted.flag[at]) << x << " " << y;
      ASSERT_EQ(port.field(x, y, wanted.layout.colour, 24), rgb[0] | rgb[1] << 8 | rgb[2] << 16) << x << " " << y;
    }
}

}  // namespace dendro::raster_primitives
