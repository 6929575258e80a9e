#include <gtest/gtest.h>

#include <random>

#include "tests/firmware/raster_primitives/rig.h"

namespace dendro::raster_primitives {
namespace {

constexpr std::uint32_t kFarthest = 65535;
const TriangleRules kRules = {kSide, kSide, 16, 10, 2};

glm::dvec3 random_point(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  return {-10 + unit(random) * (kSide + 20), -10 + unit(random) * (kSide + 20), 100 + unit(random) * 65000};
}

glm::dvec3 random_light(std::mt19937_64& random) {
  std::normal_distribution<double> part;
  return {part(random), part(random), part(random) * 1000};
}

TEST(Shadows, EveryPixelIsTheIntegerModels) {
  std::mt19937_64 random(1);
  Layout layout(16);
  layout.shadows = true;
  const lib::IgcPrograms programs = assemble({"triangles.igc", "shadows.igc"}, layout);
  ArrayPort port(small_spec());
  lib::IgcDriver driver(port, programs);
  driver.load();
  for (const auto& [name, value] : register_values(layout)) driver.set_register(name, value);
  driver.run("clear_picture", std::uint64_t{kFarthest} << 24);
  IntegerPixels wanted(layout, kFarthest);
  for (int n = 0; n < 20; ++n) {
    std::array<ScreenVertex, 3> corners;
    for (ScreenVertex& v : corners) {
      const glm::dvec3 p = random_point(random);
      v = {p.x, p.y, p.z, {50.0 + n, 100, 201}};
    }
    const auto triangle = set_up(corners, kRules);
    if (!triangle) continue;
    send(driver, *triangle);
    wanted.triangle(*triangle);
  }
  driver.run("clear_shadow");
  const glm::dvec3 light = random_light(random);
  std::size_t shadowed = 0;
  for (int n = 0; n < 60; ++n) {
    const auto shadow = set_up_shadow({random_point(random), random_point(random), random_point(random)},
                                      n % 3 == 0 ? random_light(random) : light, kRules);
    if (!shadow) continue;
    send(driver, *shadow);
    wanted.cast(*shadow);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
        ASSERT_EQ(port.field(x, y, layout.seen, 1), wanted.shadow[static_cast<std::size_t>(y * kSide + x)]) << n;
    if (n == 20) shadowed = static_cast<std::size_t>(std::count(wanted.shadow.begin(), wanted.shadow.end(), true));
  }
  EXPECT_GT(shadowed, 0u);
  EXPECT_LT(shadowed, wanted.shadow.size());
  driver.run("darken", std::uint64_t{kFarthest});
  wanted.darken(kFarthest);
  expect_same(port, wanted);
}

/// With the light along the line of sight, too, where all sides hold that line.
TEST(Shadows, OfTrianglesAroundAPointLeaveNoGapAndDoNotOverlap) {
  std::mt19937_64 random(2);
  for (int n = 0; n < 100; ++n) {
    const glm::dvec3 light = n % 4 == 0 ? glm::dvec3(0, 0, 1) : glm::dvec3(0.3 * (n % 3 - 1), 0.2, 800.0);
    glm::dvec3 middle = random_point(random);
    middle.x = std::round(middle.x), middle.z = 20000;
    const std::array<glm::dvec3, 4> frame = {{{-300, -300, 20000}, {400, -300, 20000}, {400, 400, 20000}, {-300, 400, 20000}}};
    std::vector<int> times(kSide * kSide);
    for (std::size_t k = 0; k < 4; ++k) {
      std::array<glm::dvec3, 3> corners = {middle, frame[k], frame[(k + 1) % 4]};
      if (n % 2 == 1) std::swap(corners[0], corners[2]);
      const auto shadow = set_up_shadow(corners, light, kRules);
      ASSERT_TRUE(shadow);
      ASSERT_EQ(shadow->planes[0].side, ShadowPlane::Side::kBehind);
      for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
          const std::int64_t depth = 30000 + 100 * x;
          bool inside = true;
          for (const ShadowPlane& plane : shadow->planes) inside = inside && is_on_side(plane, x, y, depth);
          times[static_cast<std::size_t>(y * kSide + x)] += inside;
        }
    }
    for (const int count : times) ASSERT_EQ(count, 1) << n;
  }
}

TEST(Shadows, GuardBitsHoldEveryPlaneAtEveryPixel) {
  std::mt19937_64 random(3);
  int steep = 0;
  for (int n = 0; n < 2000; ++n) {
    const auto shadow =
        set_up_shadow({random_point(random), random_point(random), random_point(random)}, random_light(random), kRules);
    if (!shadow) continue;
    for (const ShadowPlane& plane : shadow->planes) {
      const bool sign_test = plane.side == ShadowPlane::Side::kBeside || plane.side == ShadowPlane::Side::kBesideOther;
      const unsigned bits = plane.stream.guard + (sign_test ? 0 : 16);
      steep += !sign_test && bits > 24;
      for (const int x : {0, kSide - 1})
        for (const int y : {0, kSide - 1}) {
          const std::int64_t value = value_at(plane.stream, x, y);
          ASSERT_LT(value, std::int64_t{1} << (bits - 1));
          ASSERT_GE(value, -(std::int64_t{1} << (bits - 1)));
        }
    }
  }
  EXPECT_GT(steep, 10);
}

}  // namespace
}  // namespace dendro::raster_primitives
