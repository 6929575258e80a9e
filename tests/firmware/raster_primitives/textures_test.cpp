#include <gtest/gtest.h>

#include <random>

#include "sim/base/random.h"
#include "tests/firmware/raster_primitives/rig.h"

namespace dendro::raster_primitives {
namespace {

constexpr std::uint32_t kFarthest = 65535;
const TriangleRules kRules = {kSide, kSide, 16, 10, 2};

Layout layout_with_texture(unsigned bits) {
  Layout layout(16);
  layout.place_texture(bits);
  return layout;
}

std::array<ScreenVertex, 3> random_corners(std::mt19937_64& random) {
  std::array<ScreenVertex, 3> corners;
  for (ScreenVertex& v : corners) {
    v.x = base::uniform(random, -10, kSide + 10), v.y = base::uniform(random, -10, kSide + 10);
    v.depth = base::uniform(random, 100, 65000);
    for (double& part : v.colour) part = base::uniform(random, 4, 251);
    v.u = base::uniform(random, -300, 300), v.v = base::uniform(random, -300, 300);
  }
  return corners;
}

struct Drawing {
  explicit Drawing(unsigned bits)
      : layout(layout_with_texture(bits)), programs(assemble({"triangles.igc", "textures.igc"}, layout)), port(small_spec()),
        driver(port, programs) {
    driver.load();
    for (const auto& [name, value] : register_values(layout)) driver.set_register(name, value);
    driver.run("clear_picture", std::uint64_t{kFarthest} << 24);
    driver.run("clear_texture");
  }

  Layout layout;
  lib::IgcPrograms programs;
  ArrayPort port;
  lib::IgcDriver driver;
};

class TexturesOfBits : public ::testing::TestWithParam<unsigned> {};

TEST_P(TexturesOfBits, EveryPixelIsTheIntegerModels) {
  std::mt19937_64 random(GetParam());
  Drawing drawing(GetParam());
  IntegerPixels wanted(drawing.layout, kFarthest);
  for (int n = 0; n < 40; ++n) {
    const auto corners = random_corners(random);
    auto triangle = set_up(corners, kRules);
    if (!triangle) continue;
    if (n % 2 == 0) triangle->texel = set_up_texture(corners, kRules);
    send(drawing.driver, *triangle);
    if (!triangle->texel) drawing.driver.run("plain");
    wanted.triangle(*triangle);
  }
  const auto shown = std::count_if(wanted.texel.begin(), wanted.texel.end(), [](const auto& t) { return t.has_value(); });
  EXPECT_GT(shown, 500);
  EXPECT_LT(shown, kSide * kSide - 500);
  const Texture texture = make_texture("wood", GetParam(), 5);
  for (std::size_t k = 0; k < texture.rgb.size(); ++k) send_texel(drawing.driver, texture, k);
  wanted.texels(texture);
  expect_same(drawing.port, wanted);
}

TEST_P(TexturesOfBits, ATexelTakes27ClocksAndTwoForEveryBitOfItsCoordinates) {
  Drawing drawing(GetParam());
  const Texture texture = make_texture("checker", GetParam(), 1);
  const std::uint64_t before = drawing.port.clocks;
  send_texel(drawing.driver, texture, 3);
  EXPECT_EQ(drawing.port.clocks - before, 27 + 2 * GetParam());
}

INSTANTIATE_TEST_SUITE_P(Bits, TexturesOfBits, ::testing::Values(3u, 5u, 7u));

TEST(TextureSetup, CoordinatesAreWithinTheRoundingOfALinearMapOfTheScreen) {
  std::mt19937_64 random(4);
  for (int n = 0; n < 300; ++n) {
    const double a = base::uniform(random, -3, 3), b = base::uniform(random, -3, 3), c = base::uniform(random, -500, 500);
    std::array<ScreenVertex, 3> corners = random_corners(random);
    const double area = (corners[1].x - corners[0].x) * (corners[2].y - corners[0].y) -
                        (corners[2].x - corners[0].x) * (corners[1].y - corners[0].y);
    if (std::abs(area) < 1) continue;
    for (ScreenVertex& v : corners) v.u = a * v.x + b * v.y + c, v.v = b * v.x - c;
    const auto streams = set_up_texture(corners, kRules);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const double u = a * x + b * y + c, v = b * x - c;
        const double u_off = texel_rounding(a, b, u, kRules), v_off = texel_rounding(b, 0, v, kRules);
        ASSERT_LT(u_off, 0.01);
        const std::int64_t got_u = value_at(streams[0], x, y), got_v = value_at(streams[1], x, y);
        ASSERT_TRUE(got_u >= std::floor(u - u_off) && got_u <= std::floor(u + u_off)) << u << " is " << got_u;
        ASSERT_TRUE(got_v >= std::floor(v - v_off) && got_v <= std::floor(v + v_off)) << v << " is " << got_v;
      }
  }
}

TEST(Texture, IsTheSameForASeedAndItsEndsMeet) {
  const Texture wood = make_texture("wood", 6, 1);
  EXPECT_EQ(wood.rgb, make_texture("wood", 6, 1).rgb);
  EXPECT_NE(wood.rgb, make_texture("wood", 6, 2).rgb);
  EXPECT_NE(wood.rgb, make_texture("checker", 6, 1).rgb);
  int inside = 0, across = 0;
  for (int v = 0; v < 64; ++v)
    for (int u = 0; u < 64; ++u) {
      const int step = std::abs(static_cast<int>(wood.at(u, v) & 255) - static_cast<int>(wood.at(u + 1, v) & 255));
      (u == 63 ? across : inside) = std::max(u == 63 ? across : inside, step);
      ASSERT_EQ(wood.at(u - 64, v + 128), wood.at(u, v));
    }
  EXPECT_GT(inside, 0);
  EXPECT_LE(across, inside);
}

}  // namespace
}  // namespace dendro::raster_primitives
