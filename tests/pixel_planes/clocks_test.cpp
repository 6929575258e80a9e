#include <gtest/gtest.h>

#include "tests/support/pixel_planes_rig.h"

namespace dendro::pixel_planes {
namespace {

std::uint64_t clocks(int ports, const std::string& program, unsigned n, unsigned f, unsigned g, unsigned gap) {
  const Programs programs(ports);
  const igc::ControllerState controller = programs.controller({n, ports == 2});
  igc::Header header;
  header.entry = programs.entry(program), header.fraction = f, header.guard = g;
  return igc::count_words(igc::program_at(controller, header.entry), header, controller, gap);
}

struct Size {
  unsigned n, f, g;
  unsigned k() const { return n + f + g; }
};

/// The rows of the hardware sheet's table of 3.3.
constexpr Size kSizes[] = {{12, 10, 2}, {12, 10, 11}, {16, 9, 2}, {16, 10, 2}, {16, 10, 4}, {16, 10, 11},
                           {20, 10, 2}, {20, 10, 4},  {20, 10, 11}, {24, 10, 2}, {24, 10, 11}};

TEST(Clocks, APlaneOfTwoStreamsTakesTwiceTheWordAndThree) {
  for (const Size& s : kSizes)
    for (const char* program : {"front_plane", "back_plane"}) {
      EXPECT_EQ(clocks(1, program, s.n, s.f, s.g, 0), 2 * s.k() + 3) << program << s.n;
      EXPECT_EQ(clocks(1, program, s.n, s.f, s.g, 8), 2 * s.k() + 3 + 16) << program << s.n;
    }
  EXPECT_EQ(clocks(1, "front_plane", 16, 10, 2, 0), 59u);
}

TEST(Clocks, APlaneCopiedThroughTheScratchFieldTakesTheWordAndItsDepthAndThree) {
  for (const Size& s : kSizes)
    for (const char* program : {"front_plane_scratch", "back_plane_scratch"}) {
      EXPECT_EQ(clocks(2, program, s.n, s.f, s.g, 0), s.k() + s.n + 3) << program << s.n;
      EXPECT_EQ(clocks(2, program, s.n, s.f, s.g, 18), s.k() + s.n + 3 + 18) << program << s.n;
    }
}

TEST(Clocks, AnEdgeTakesItsStreamAndTwoAndTheKill) {
  EXPECT_EQ(clocks(1, "edge_on_plane", 16, 16, 12, 0), 16 + 12 + 2 + 16u);
}

TEST(Clocks, WhatAHullTakesBesidesItsPlanes) {
  for (const unsigned n : {12u, 16u, 24u}) {
    EXPECT_EQ(clocks(1, "clear_hull", n, 0, 0, 0), 2 * n + 1);
    EXPECT_EQ(clocks(1, "finish", n, 0, 0, 0), 6 * n + 7);
    EXPECT_EQ(clocks(2, "finish", n, 0, 0, 0), 3 * n + 7);
    EXPECT_EQ(clocks(1, "close_open", n, 0, 0, 0), 2 * n + 3);
    EXPECT_EQ(clocks(1, "recolour", n, 10, 2, 0), n + 12 + 3 + 24);
    EXPECT_EQ(clocks(1, "clear_picture", n, 0, 0, 0), n + 24 + 1);
  }
}

}  // namespace
}  // namespace dendro::pixel_planes
