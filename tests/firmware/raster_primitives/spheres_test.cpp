#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "firmware/raster_primitives/host/shade.h"
#include "tests/firmware/raster_primitives/rig.h"

namespace dendro::raster_primitives {
namespace {

constexpr double kFarthest = 50000;

Layout layout_with_spheres() {
  Layout layout(16);
  layout.square_bits = square_bits_for(kSide, kSide);
  return layout;
}

/// Anywhere that is allowed, shaded as prepare() does it.
ScreenSphere random_sphere(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  ScreenSphere sphere;
  sphere.radius = std::exp(unit(random) * std::log(kSide)) * 0.999;
  sphere.x = (-0.5 + 2 * unit(random)) * kSide, sphere.y = (-0.5 + 2 * unit(random)) * kSide;
  sphere.depth_radius = 100 + unit(random) * 11000;
  sphere.depth = 1.25 * sphere.depth_radius + 10 + unit(random) * (kFarthest - 20 - 1.25 * sphere.depth_radius);
  double length = 0;
  for (double& part : sphere.light) part = unit(random) - 0.5, length += part * part;
  for (double& part : sphere.light) part /= std::sqrt(length);
  const double ambient = unit(random) * 0.5;
  for (std::size_t c = 0; c < 3; ++c) {
    const double range = (255 - 2 * Shader::kColourMargin) * unit(random);
    sphere.level[c] = Shader::kColourMargin + range * (1 + ambient) / 2, sphere.swing[c] = range * (1 - ambient) / 2;
  }
  return sphere;
}

const TriangleRules kRules = {kSide, kSide, 16, 10, 2};

struct Drawing {
  Drawing() : layout(layout_with_spheres()), programs(assemble({"triangles.igc", "spheres.igc"}, layout)),
              port(small_spec()), driver(port, programs), sender(driver, layout) {
    driver.load();
    for (const auto& [name, value] : register_values(layout)) driver.set_register(name, value);
    driver.run("clear_picture", static_cast<std::uint64_t>(kFarthest) << 24);
    sender.load_squares(kSide, kSide);
  }

  /// The field that holds S, its sign extended.
  std::int64_t square(int x, int y) {
    const auto bits = port.field(x, y, layout.square, layout.square_bits);
    return static_cast<std::int64_t>(std::uint64_t{bits} << (64 - layout.square_bits)) >> (64 - layout.square_bits);
  }

  Layout layout;
  lib::IgcPrograms programs;
  ArrayPort port;
  lib::IgcDriver driver;
  SphereSender sender;
};

TEST(Spheres, SquaresAreLoadedByLinearExpressions) {
  Drawing drawing;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) ASSERT_EQ(drawing.square(x, y), -(x * x + y * y)) << x << " " << y;
}

TEST(Spheres, EveryPixelIsTheIntegerModels) {
  for (const int digits : {1, 2, 3, 5}) {
    std::mt19937_64 random(static_cast<unsigned>(digits));
    Drawing drawing;
    IntegerPixels wanted(drawing.layout, static_cast<std::uint32_t>(kFarthest));
    for (int n = 0; n < 60; ++n) {
      const SphereSetup sphere = set_up(random_sphere(random), digits, kRules);
      drawing.sender.send(sphere);
      wanted.sphere(sphere);
      if (n % 10 == 0) expect_same(drawing.port, wanted);
      if (HasFatalFailure()) return;
      const std::int64_t square = sphere.a * 5 + sphere.b * 60 + sphere.c - 5 * 5 - 60 * 60;
      ASSERT_EQ(drawing.square(5, 60), square);
    }
    expect_same(drawing.port, wanted);
  }
}

TEST(Spheres, AndTrianglesHideEachOther) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  Drawing drawing;
  IntegerPixels wanted(drawing.layout, static_cast<std::uint32_t>(kFarthest));
  for (int n = 0; n < 30; ++n) {
    std::array<ScreenVertex, 3> corners;
    for (ScreenVertex& v : corners)
      v = {unit(random) * kSide, unit(random) * kSide, 10 + unit(random) * (kFarthest - 20), {20, 40.0 + n, 60}};
    if (const auto triangle = set_up(corners, kRules)) {
      send(drawing.driver, *triangle);
      wanted.triangle(*triangle);
    }
    const SphereSetup sphere = set_up(random_sphere(random), 2, kRules);
    drawing.sender.send(sphere);
    wanted.sphere(sphere);
  }
  expect_same(drawing.port, wanted);
}

/// S, depth and colours of a sphere stay in the ranges of their fields, and near what they stand for.
TEST(Spheres, ValuesLieInTheirRangesAndNearTheParaboloid) {
  std::mt19937_64 random(5);
  for (int n = 0; n < 2000; ++n) {
    const int digits = 1 + n % 4;
    const ScreenSphere given = random_sphere(random);
    const SphereSetup sphere = set_up(given, digits, kRules);
    IntegerPixels pixels(layout_with_spheres(), static_cast<std::uint32_t>(kFarthest));
    pixels.sphere(sphere);
    const double most = digits == 1 ? 0.34 : digits == 2 ? 0.12 : 0.04;  // of what a digit sum may be off by
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const std::int64_t square = sphere.a * x + sphere.b * y + sphere.c - x * x - y * y;
        ASSERT_LT(std::abs(square), std::int64_t{1} << (layout_with_spheres().square_bits - 1));
        const auto at = static_cast<std::size_t>(y * kSide + x);
        if (!pixels.flag[at]) continue;
        ASSERT_LT(square, std::int64_t{1} << sphere.bits);
        const double share = static_cast<double>(square) / (given.radius * given.radius);
        const double depth = given.depth - share * given.depth_radius;
        ASSERT_NEAR(pixels.depth[at], depth, most * share * given.depth_radius + digits + 1) << n;
        for (std::size_t c = 0; c < 3; ++c) {
          const double u = (x - sphere.a / 2.0) / given.radius, v = (y - sphere.b / 2.0) / given.radius;
          const double shade =
              given.level[c] + given.swing[c] * (u * given.light[0] + v * given.light[1] + share * given.light[2]);
          // Towards zero a digit sum is off by at most half.
          const double off = digits == 1 ? 0.5 : digits == 2 ? 0.25 : 0.13;
          ASSERT_NEAR(pixels.colour[at][c], shade, off * share * given.swing[c] * std::abs(given.light[2]) + digits + 2)
              << n << " at " << x << " " << y;
        }
      }
  }
}

TEST(SphereSetup, DigitsComeNearAndNeverBeyondWhenTheyMustNot) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> exponent(-12, 6);
  double worst = 0;
  for (int n = 0; n < 20000; ++n) {
    const double value = (n % 2 == 0 ? 1 : -1) * std::exp2(exponent(random));
    const std::vector<Digit> near = digits_of(value, 2, -40, false), below = digits_of(value, 2, -40, true);
    ASSERT_LE(near.size(), 2u);
    ASSERT_LE(below.size(), 2u);
    worst = std::max(worst, std::abs(value_of(near) / value - 1));
    ASSERT_LE(std::abs(value_of(below)), std::abs(value));
    ASSERT_GE(value_of(below) / value, 0.79);
  }
  EXPECT_LT(worst, 0.12);
  EXPECT_TRUE(digits_of(0, 3, -10, false).empty());
  EXPECT_TRUE(digits_of(1e-9, 3, -10, false).empty());
}

TEST(Spheres, ClocksAreThoseOfTheStreamsAndCopies) {
  Drawing drawing;
  ScreenSphere given;
  given.x = given.y = 30, given.radius = 20, given.depth = 30000, given.depth_radius = 800;  // two units for one of S
  SphereSetup sphere = set_up(given, 2, kRules);
  ASSERT_EQ(sphere.bits, 9u);
  ASSERT_EQ(sphere.bulge.size(), 1u);
  for (auto& shine : sphere.shine) shine = {{1, -3}};
  const std::uint64_t before = drawing.port.clocks;
  drawing.sender.send(sphere);
  const std::uint64_t circle = 2 + drawing.layout.square_bits + 2, depth = 5 + 16 + 2 + 16, keep = 3;
  const std::uint64_t bulge = 5 + 4 + 2 * 9 + (16 - 1 - 9), colour = 3 + 10 + 8, shine = 5 + 4 + 2 * 6 + 2;
  EXPECT_EQ(drawing.port.clocks - before, circle + 2 * bulge + depth + keep + 3 * (colour + shine));
}

}  // namespace
}  // namespace dendro::raster_primitives
