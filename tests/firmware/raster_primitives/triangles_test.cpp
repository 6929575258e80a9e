#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "firmware/raster_primitives/job.h"
#include "tests/firmware/raster_primitives/rig.h"

namespace dendro::raster_primitives {
namespace {

TriangleRules rules_of(unsigned depth_bits, unsigned fraction = 10) { return {kSide, kSide, depth_bits, fraction, 2}; }

/// Small, large, thin, partly and wholly outside.
std::array<ScreenVertex, 3> random_corners(std::mt19937_64& random, const TriangleRules& rules) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double size = std::exp(std::log(0.3) + unit(random) * std::log(400 / 0.3));
  const double x = -10 + unit(random) * (kSide + 20), y = -10 + unit(random) * (kSide + 20);
  const double margin = depth_margin(rules), top = std::ldexp(1.0, static_cast<int>(rules.depth_bits)) - 1;
  std::array<ScreenVertex, 3> corners;
  for (ScreenVertex& v : corners) {
    v.x = x + (unit(random) - 0.5) * size, v.y = y + (unit(random) - 0.5) * size;
    v.depth = margin + unit(random) * (top - 2 * margin);
    for (double& c : v.colour) c = 4 + unit(random) * 247;
  }
  return corners;
}

struct Drawing {
  explicit Drawing(unsigned depth_bits)
      : layout(depth_bits), programs(assemble({"triangles.igc"}, layout)), port(small_spec()), driver(port, programs) {
    driver.load();
    for (const auto& [name, value] : register_values(layout))
      if (programs.registers.count(name) != 0) driver.set_register(name, value);
    driver.run("clear_picture", std::uint64_t{farthest()} << 24);
  }
  std::uint32_t farthest() const { return static_cast<std::uint32_t>((std::uint64_t{1} << layout.depth_bits) - 1); }

  Layout layout;
  lib::IgcPrograms programs;
  ArrayPort port;
  lib::IgcDriver driver;
};

class TrianglesOfWidth : public ::testing::TestWithParam<unsigned> {};

TEST_P(TrianglesOfWidth, EveryPixelIsTheIntegerModels) {
  std::mt19937_64 random(GetParam());
  const TriangleRules rules = rules_of(GetParam());
  Drawing drawing(GetParam());
  IntegerPixels wanted(drawing.layout, drawing.farthest());
  int drawn = 0;
  for (int n = 0; n < 150; ++n) {
    const auto triangle = set_up(random_corners(random, rules), rules);
    if (!triangle) continue;
    ++drawn;
    send(drawing.driver, *triangle);
    wanted.triangle(*triangle);
    if (n % 10 == 0) expect_same(drawing.port, wanted);
    if (HasFatalFailure()) return;
  }
  expect_same(drawing.port, wanted);
  EXPECT_GT(drawn, 100);
}

TEST_P(TrianglesOfWidth, DepthsAndColoursInsideLieInTheirRanges) {
  std::mt19937_64 random(100 + GetParam());
  const TriangleRules rules = rules_of(GetParam());
  const std::int64_t top = (std::int64_t{1} << GetParam()) - 1;
  int pixels = 0, flat = 0;
  for (int n = 0; n < 3000; ++n) {
    const auto triangle = set_up(random_corners(random, rules), rules);
    if (!triangle) continue;
    flat += triangle->flat;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        bool inside = true;
        for (const Stream& edge : triangle->edge) inside = inside && value_at(edge, x, y) >= 0;
        if (!inside) continue;
        ++pixels;
        const std::int64_t depth = value_at(triangle->depth, x, y);
        ASSERT_TRUE(depth >= 0 && depth < top) << depth << " in triangle " << n;
        for (const Stream& colour : triangle->colour) {
          const std::int64_t value = value_at(colour, x, y);
          ASSERT_TRUE(value >= 0 && value <= 255) << value << " in triangle " << n;
        }
      }
  }
  EXPECT_GT(pixels, 100000);
  EXPECT_GT(flat, 0);
}

INSTANTIATE_TEST_SUITE_P(Widths, TrianglesOfWidth, ::testing::Values(12u, 16u, 20u, 24u));

TEST(TriangleSetup, TrianglesAroundAPointCoverEveryPixelOnce) {
  std::mt19937_64 random(7);
  std::uniform_int_distribution<int> grid(0, 4 * kSide);
  const TriangleRules rules = rules_of(16);
  const std::array<std::array<double, 2>, 4> frame = {{{-20, -20}, {90, -20}, {90, 90}, {-20, 90}}};
  for (int n = 0; n < 200; ++n) {
    // On the grid, so often through pixel centres.
    ScreenVertex middle;
    middle.x = grid(random) / 4.0, middle.y = grid(random) / 4.0, middle.depth = 100;
    std::vector<int> covered(kSide * kSide);
    for (std::size_t k = 0; k < 4; ++k) {
      ScreenVertex p = middle, q = middle;
      p.x = frame[k][0], p.y = frame[k][1], q.x = frame[(k + 1) % 4][0], q.y = frame[(k + 1) % 4][1];
      const auto triangle = set_up({middle, n % 2 == 0 ? p : q, n % 2 == 0 ? q : p}, rules);
      ASSERT_TRUE(triangle);
      for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
          bool inside = true;
          for (const Stream& edge : triangle->edge) inside = inside && value_at(edge, x, y) >= 0;
          covered[static_cast<std::size_t>(y * kSide + x)] += inside;
        }
    }
    for (const int times : covered) ASSERT_EQ(times, 1) << n;
  }
}

TEST(TriangleSetup, GuardBitsHoldAnEdgeAtEveryPixelAndOneFewerDoNot) {
  std::mt19937_64 random(8);
  const TriangleRules rules = rules_of(16);
  for (int n = 0; n < 500; ++n) {
    const auto triangle = set_up(random_corners(random, rules), rules);
    if (!triangle) continue;
    for (const Stream& edge : triangle->edge) {
      std::int64_t most = 0;
      for (const int x : {0, kSide - 1})
        for (const int y : {0, kSide - 1}) {
          const std::int64_t value = value_at(edge, x, y);
          most = std::max(most, value < 0 ? -value - 1 : value);
        }
      ASSERT_LT(most, std::int64_t{1} << (edge.guard - 1));
      if (edge.guard > 1) {
        ASSERT_GE(most, std::int64_t{1} << (edge.guard - 2));
      }
    }
  }
}

TEST(Triangles, ClocksAreThoseOfTheStreamsAndAFewMoreACommand) {
  std::mt19937_64 random(9);
  for (const unsigned bits : {12u, 16u, 24u}) {
    const TriangleRules rules = rules_of(bits, 11);
    Drawing drawing(bits);
    for (int n = 0; n < 20; ++n) {
      const auto triangle = set_up(random_corners(random, rules), rules);
      if (!triangle) continue;
      std::uint64_t wanted = 0;
      for (const Stream& edge : triangle->edge) wanted += edge.guard + 2;
      wanted += 2 * (11 + bits) + 6;
      wanted += 3 * (11 + 8 + 3);
      const std::uint64_t before = drawing.port.clocks;
      send(drawing.driver, *triangle);
      EXPECT_EQ(drawing.port.clocks - before, wanted);
    }
  }
}

scene::Scene teapot_scene(int side) {
  scene::Scene scene;
  scene.image.width = scene.image.height = side;
  scene.camera.height = 6.6;
  scene.camera.position = {3, 5, 10};
  scene.camera.target = {0.2, 1.5, 0};
  scene.options = scene::Options("raster_primitives");
  scene.objects.emplace_back();
  scene.objects[0].mesh = std::string(MESHES) + "/newell_teapot.patches";
  scene.objects[0].up_axis = "z";
  scene.options.set("patch_steps", {std::int64_t{3}, {}});
  return scene;
}

TEST(Triangles, AMeshAgreesWithTheReferenceAndItsDepthsToAQuarterPixel) {
  const scene::Scene scene = teapot_scene(128);
  const pixel_planes::Spec spec = small_spec(128);
  const ArraySite site{128, 128, 72};
  const auto job = make_job(scene, assemble({"triangles.igc"}, choose_layout(scene, site)), site);
  ArrayPort port(spec);
  job->run(port);
  const Picture picture = port.picture();
  MachineView view;
  view.peek = [&](std::uint32_t address, unsigned function) { return port.peek(address, function); };
  view.width = picture.width, view.height = picture.height, view.rgb = picture.rgb.data();
  const ErrorReport report = job->compare(view);
  std::map<std::string, double> extra(report.extra.begin(), report.extra.end());
  EXPECT_GT(report.covered_pixels, 3000);
  EXPECT_LT(report.wrong_pixels, 40);  // silhouettes: corners move by up to an eighth of a pixel
  EXPECT_GT(extra.at("inner_pixels"), 30);
  EXPECT_LT(extra.at("inner_depth_error_pixels"), 0.25);
EXPECT_LT(extra.at("inner_colour_error"), 12);
  ASSERT_TRUE(report.psnr_db);
  EXPECT_GT(*report.psnr_db, 30);
}

}  // namespace
}  // namespace dendro::raster_primitives
