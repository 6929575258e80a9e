#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "firmware/adaptive_equalisation/host/host_program.h"
#include "firmware/adaptive_equalisation/host/radiograph.h"
#include "firmware/adaptive_equalisation/job.h"
#include "firmware/adaptive_equalisation/reference/reference.h"
#include "sim/base/error.h"
#include "tests/support/array_port.h"

namespace dendro::adaptive_equalisation {
namespace {

/// Few values, so that many are equal.
std::vector<std::uint16_t> random_picture(std::uint64_t seed, int width, int height, unsigned values) {
  std::mt19937_64 random(seed);
  std::vector<std::uint16_t> grey;
  for (int i = 0; i < width * height; ++i) grey.push_back(static_cast<std::uint16_t>(random() % values));
  return grey;
}

TEST(Regions, APixelIsSeenFromThePixelsWhoseRegionHoldsIt) {
  for (const int region : {16, 32, 64})
    for (const int side : {64, 65, 100, 128})
      for (int at = 0; at < side; ++at) {
        const Span seen_from = pixels_that_see(at, region, side);
        for (int p = 0; p < side; ++p) {
          const int start = region_start(p, region, side);
          ASSERT_EQ(start <= at && at < start + region, seen_from.first <= p && p <= seen_from.last)
              << at << " from " << p << ", region " << region << " of " << side;
        }
      }
}

TEST(Regions, StayInThePictureAndHaveTheirPixelNearTheMiddle) {
  for (int p = 0; p < 100; ++p) {
    const int start = region_start(p, 32, 100);
    EXPECT_TRUE(start >= 0 && start + 32 <= 100 && start <= p && p < start + 32);
    if (p >= 16 && p <= 84) {
      EXPECT_EQ(start, p - 16);
    }
  }
}

TEST(Reference, CountsTheDarkerPixelsOfTheRegion) {
  const int width = 50, height = 37, region = 16;
  const std::vector<std::uint16_t> grey = random_picture(3, width, height, 900);
  const std::vector<std::uint32_t> found = ranks(grey, width, height, region);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int left = region_start(x, region, width), top = region_start(y, region, height);
      std::uint32_t darker = 0;
      for (int v = top; v < top + region; ++v)
        for (int u = left; u < left + region; ++u)
          darker += grey[static_cast<std::size_t>(v * width + u)] < grey[static_cast<std::size_t>(y * width + x)];
      ASSERT_EQ(found[static_cast<std::size_t>(y * width + x)], darker) << x << " " << y;
    }
}

Prepared prepared_of(int width, int height, unsigned values, Method method, unsigned grey_bits) {
  Prepared prepared;
  prepared.width = width, prepared.height = height, prepared.region = 16;
  prepared.layout.grey_bits = grey_bits, prepared.layout.rank_bits = 8;
  prepared.method = method;
  prepared.grey = random_picture(7, width, height, values);
  return prepared;
}

struct Machine {
  Machine(const Prepared& prepared, int side, bool lazy) : port(test::square_array(side), lazy) {
    const lib::IgcPrograms programs = test::assemble_files({IGC_SOURCE}, prepared.layout.registers());
    run(port, prepared, programs, {side, side, 72, 1});
  }
  test::ArrayPort port;
};

TEST(Equalisation, EveryPixelIsTheReferencesWhicheverWayRegionsAreSent) {
  for (const Method method : {Method::kPolygon, Method::kRows})
    for (const bool lazy : {false, true}) {
      SCOPED_TRACE(testing::Message() << "method " << static_cast<int>(method) << (lazy ? " lazy" : " full"));
      const Prepared prepared = prepared_of(40, 33, 700, method, 10);
      Machine machine(prepared, 64, lazy);
      const std::vector<std::uint32_t> wanted = ranks(prepared.grey, 40, 33, 16);
      const Picture shown = machine.port.picture();
      ASSERT_EQ(shown.width, 40);
      for (int y = 0; y < 33; ++y)
        for (int x = 0; x < 40; ++x) {
          const auto at = static_cast<std::size_t>(y * 40 + x);
          ASSERT_EQ(machine.port.field(x, y, prepared.layout.rank(), 8), wanted[at]) << x << " " << y;
          ASSERT_EQ(shown.rgb[3 * at + 2], wanted[at]) << x << " " << y;
        }
    }
}

TEST(Equalisation, LazyEqualsFullInEveryBit) {
  for (const Method method : {Method::kPolygon, Method::kRows}) {
    const Prepared prepared = prepared_of(64, 64, 3000, method, 12);
    Machine lazy(prepared, 64, true), full(prepared, 64, false);
    for (std::size_t bit = 0; bit < full.port.memory().size(); ++bit)
      ASSERT_EQ(full.port.memory()[bit], lazy.port.memory()[bit]) << "bit " << bit;
    EXPECT_EQ(lazy.port.clocks, full.port.clocks);
    EXPECT_LT(lazy.port.counters().evaluated * 3, full.port.counters().evaluated);
  }
}

/// Clocks of the two edges of a span on an array of 64 pixels: two more than the bits that hold both ends of the distance.
std::uint64_t edges(const Span& span) {
  std::uint64_t clocks = 0;
  for (const auto& [low, high] : {std::pair(-span.first, 63 - span.first), std::pair(span.last - 63, span.last)})
    clocks += 2 + (low >= -32 && high < 32 ? 6 : low >= -64 && high < 64 ? 7 : 8);
  return clocks;
}

TEST(Equalisation, ClocksAreThoseOfTheStreamsAndAFewMoreACommand) {
  const int width = 40, height = 33;
  const auto load = [](int x) { return 5 + (x == 32 ? 6u : 7u) + 9; };
  for (const Method method : {Method::kPolygon, Method::kRows}) {
    const Prepared prepared = prepared_of(width, height, 200, method, 9);
    const bool rows = method == Method::kRows;
    std::uint64_t wanted = prepared.layout.registers().size() + 1 + 8 + 24 + 1 + 8 * 4;  // registers, clear, show_ranks
    for (int y = 0; y < height; ++y) {
      const std::uint64_t along_y = edges(pixels_that_see(y, 16, height));
      wanted += edges({y, y}) + (rows ? along_y : 0);
      for (int x = 0; x < width; ++x)
        wanted += load(x) + edges(pixels_that_see(x, 16, width)) + (rows ? 2 : along_y) + 4 + 9 + 8;
    }
    EXPECT_EQ(Machine(prepared, 64, true).port.clocks, wanted) << static_cast<int>(method);
  }
}

TEST(Radiograph, IsTheSameForASeedAndUsesItsRange) {
  const auto picture = radiograph(96, 80, 12, 5);
  EXPECT_EQ(picture, radiograph(96, 80, 12, 5));
  EXPECT_NE(picture, radiograph(96, 80, 12, 6));
  EXPECT_EQ(picture.size(), 96u * 80u);
  EXPECT_LT(*std::min_element(picture.begin(), picture.end()), 400);
  EXPECT_GT(*std::max_element(picture.begin(), picture.end()), 3600);
  EXPECT_LE(*std::max_element(picture.begin(), picture.end()), 4095);
  EXPECT_GT(std::set<std::uint16_t>(picture.begin(), picture.end()).size(), 800u);
}

std::string error_of(const std::vector<std::pair<std::string, scene::OptionValue>>& options, int width = 128) {
  scene::Scene scene;
  scene.image.width = width, scene.image.height = 128;
  scene.options = scene::Options("adaptive_equalisation");
  for (const auto& [key, value] : options) scene.options.set(key, value);
  try {
    prepare(scene, {128, 128, 72, 1});
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

TEST(Equalisation, WhatCannotBeDoneIsSaid) {
  const auto integer = [](std::int64_t v) { return scene::OptionValue{v, {}}; };
  EXPECT_EQ(error_of({}), "");
  EXPECT_NE(error_of({{"region", integer(48)}}).find("must be a power of two"), std::string::npos);
  EXPECT_NE(error_of({{"region", integer(256)}}).find("256 pixels do not fit a picture of 128 x 128"), std::string::npos);
  EXPECT_NE(error_of({}, 256).find("256 is more than the 128 pixels of the array"), std::string::npos);
}

}  // namespace
}  // namespace dendro::adaptive_equalisation
