#include <gtest/gtest.h>

#include <random>

#include "firmware/raster_primitives/host/shadow_setup.h"
#include "tests/firmware/raster_primitives/rig.h"

namespace dendro::raster_primitives {
namespace {

/// A program on two arrays: one looks at all pixels, one where a flag can be set.
struct Both {
  explicit Both(const Layout& layout)
      : programs(assemble({"triangles.igc", "spheres.igc", "shadows.igc", "textures.igc"}, layout)),
        full_port(small_spec(kWide)), lazy_port(small_spec(kWide), true), full(full_port, programs), lazy(lazy_port, programs) {
    for (lib::IgcDriver* driver : {&full, &lazy}) {
      driver->load();
      for (const auto& [name, value] : register_values(layout)) driver->set_register(name, value);
      driver->run("clear_picture", std::uint64_t{0xFFFF} << 24);
    }
  }
  template <class Do>
  void both(const Do& what) {
    what(full), what(lazy);
  }

  static constexpr int kWide = 128;
  lib::IgcPrograms programs;
  ArrayPort full_port, lazy_port;
  lib::IgcDriver full, lazy;
};

Layout layout_of_all() {
  Layout layout(12);
  layout.square_bits = 20;
  layout.shadows = true;
  layout.place_texture(3);
  return layout;
}

std::array<ScreenVertex, 3> corners_of(std::mt19937_64& random, const TriangleRules& rules) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double size = 1 + 300 * std::pow(unit(random), 4);
  const double x = -20 + unit(random) * 170, y = -20 + unit(random) * 170, margin = depth_margin(rules);
  std::array<ScreenVertex, 3> corners;
  for (ScreenVertex& v : corners) {
    v.x = std::round(4 * (x + (unit(random) - 0.5) * size)) / 4, v.y = std::round(y + (unit(random) - 0.5) * size);
    v.depth = margin + unit(random) * (4095 - 2 * margin);
    for (double& c : v.colour) c = 4 + unit(random) * 247;
  }
  return corners;
}

Stream random_edge(std::mt19937_64& random) {
  const auto slope = [&] { return static_cast<float>(static_cast<int>(random() % 9) - 4); };
  Stream edge;
  edge.at.a = slope(), edge.at.b = slope(), edge.at.c = static_cast<float>(static_cast<int>(random() % 800) - 300);
  edge.guard = 8 + static_cast<unsigned>(random() % 6);  // some are too short for the array
  return edge;
}

TEST(FlagRegions, LazyEqualsFullInEveryBitWhateverTheOrderOfCommands) {
  const Layout layout = layout_of_all();
  const TriangleRules rules{Both::kWide, Both::kWide, 12, 10, 2};
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    Both arrays(layout);
    for (int n = 0; n < 400; ++n) {
      std::array<ScreenVertex, 3> corners = corners_of(random, rules);
      for (ScreenVertex& v : corners) v.u = v.x / 3, v.v = v.y / 5 - v.x;
      auto triangle = set_up(corners, rules);
      if (triangle && n % 2 == 0) triangle->texel = set_up_texture(corners, rules);
      const Stream edge = random_edge(random), other = random_edge(random);
      const std::uint64_t choice = random() % 15, number = static_cast<std::uint64_t>(n), texel = random() % 64;
      arrays.both([&](lib::IgcDriver& driver) {
        if (choice < 5 && triangle) send(driver, *triangle);
        if (choice == 5) send(driver, "edge_first", edge);
        if (choice == 6) send(driver, "edge", edge);
        if (choice == 7) send(driver, "edge_first", edge), send(driver, "edge_first", other), send(driver, "edge", edge);
        if (choice == 8) driver.run("keep_seen");
        if (choice == 9) driver.run("add_shadow");
        if (choice == 10) send(driver, "behind", edge);
        if (choice == 12) driver.run("plain");
        if (choice >= 13) driver.run("send_texel", texel / 8 << 32 | texel % 8 << 24 | number);
        if (choice == 11 && n % 40 == 0) driver.run("clear_picture", std::uint64_t{0xABC} << 24 | 0x123456);
      });
      const auto at = static_cast<std::uint32_t>(random() % (Both::kWide * Both::kWide));
      if (n % 7 == 0) {
        ASSERT_EQ(arrays.full_port.peek(at, 0), arrays.lazy_port.peek(at, 0)) << "command " << n;
      }
      if (n % 40 != 0) continue;
      for (std::size_t bit = 0; bit < arrays.full_port.memory().size(); ++bit)
        ASSERT_EQ(arrays.full_port.memory()[bit], arrays.lazy_port.memory()[bit]) << "bit " << bit << " after " << n;
    }
  }
}

TEST(FlagRegions, ASmallTriangleIsLookedAtInFewPixels) {
  const TriangleRules rules{Both::kWide, Both::kWide, 12, 10, 2};
  Both arrays(layout_of_all());
  std::array<ScreenVertex, 3> corners;
  corners[0].x = 70, corners[0].y = 70, corners[1].x = 75, corners[1].y = 71, corners[2].x = 72, corners[2].y = 77;
  for (ScreenVertex& v : corners) v.depth = 1000;
  arrays.lazy_port.memory();  // the clearing is done
  const std::uint64_t before = arrays.lazy_port.counters().evaluated;
  send(arrays.lazy, *set_up(corners, rules));
  EXPECT_LE(arrays.lazy_port.counters().evaluated - before, 4u * 8 * 64);
  EXPECT_GT(arrays.lazy_port.counters().evaluated, before);
}

}  // namespace
}  // namespace dendro::raster_primitives
