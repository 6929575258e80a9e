#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "firmware/half_space/host/hulls_layout.h"
#include "firmware/half_space/host/seeds.h"
#include "firmware/half_space/reference/colour_model.h"
#include "sim/base/error.h"
#include "tests/firmware/half_space/program_on_machine.h"

namespace dendro::half_space {
namespace {

using namespace testing_programs;

constexpr unsigned kSeed = 54;
constexpr const char* kProgram = "firmware/half_space/rds3000/colour.gia";

Frame coloured(const Frame& before, const Colouring& colouring, unsigned cards, const std::string& pack) {
  const lib::ProgramImage image = assembled(kProgram, pack);
  return frame_after(before, image, with_cards(cards),
                     [&](lib::RdsDriver& driver) { run_colour(driver, image, colouring); });
}

/// Random words everywhere, so a random cube as well; nearest depths with background and trunk among them.
Frame random_frame(std::mt19937& random, unsigned cards, unsigned trunk_share) {
  Frame frame(kFrame * kFrame);
  for (std::uint32_t& word : frame) {
    const unsigned kind = random() % 100;
    const std::uint32_t nearest = kind < trunk_share ? 0 : kind < 40 ? 255 : random() % 256;
    word = (random() & (cards == 4 ? 0xFF00FFFF : 0xFFFF)) | nearest << kNearestLow;
  }
  return frame;
}

/// Both signs, more than one period, and more than 16.16 holds, which comes to the same texel.
scene::Affine random_map(std::mt19937& random) {
  std::uniform_real_distribution<double> step(-1.5, 1.5), shift(-1e5, 1e5);
  scene::Affine map;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) map.linear[column][row] = step(random);
  for (int row = 0; row < 3; ++row) map.shift[row] = shift(random);
  return map;
}

Rgb random_rgb(std::mt19937& random, unsigned below) {
  return {static_cast<std::uint8_t>(random() % below), static_cast<std::uint8_t>(random() % below),
          static_cast<std::uint8_t>(random() % below)};
}

void expect_exact(const Frame& before, const Colouring& colouring, unsigned cards, const std::string& what) {
  Frame wanted = before;
  colour_model(colouring, wanted);
  for (const char* pack : {"none", "full"}) {
    const Frame got = coloured(before, colouring, cards, pack);
    for (int p = 0; p < kFrame * kFrame; ++p)
      ASSERT_EQ(got[p], wanted[p]) << what << " " << pack << " at " << p % kFrame << "," << p / kFrame;
  }
}

class ColourOf : public ::testing::TestWithParam<std::tuple<bool, unsigned>> {};

TEST_P(ColourOf, EveryWordOfTheFrameIsThatOfTheIntegerModelAtEveryLevel) {
  const auto [wide, bits] = GetParam();
  const unsigned cards = wide ? 4 : 3;
  std::mt19937 random(kSeed + bits + 10 * wide);
  for (unsigned level = 0; level <= bits; ++level) {
    const int width = 64 + static_cast<int>(random() % 120);
    const int height = 40 + static_cast<int>(random() % 100);
    ColourSettings settings;
    settings.level = level;
    settings.background = random_rgb(random, 256);
    settings.trunk_base = random_rgb(random, 128), settings.trunk_range = random_rgb(random, 128);
    const Frame before = random_frame(random, cards, 10 * (level % 3));
    const Colouring colouring =
        make_colouring(settings, random_map(random), cube_layout(bits, wide), width, height,
                       static_cast<std::size_t>(width) * height, kSeed, level);
    expect_exact(before, colouring, cards, "level " + std::to_string(level));
  }
}

INSTANTIATE_TEST_SUITE_P(Layouts, ColourOf, ::testing::Combine(::testing::Bool(), ::testing::Values(4u, 5u)));

TEST(ColourMicrocode, WholeFramesAreExactAlsoWhenEveryPixelIsTrunk) {
  std::mt19937 random(kSeed);
  ColourSettings settings;
  settings.trunk_base = {60, 30, 10}, settings.trunk_range = {195, 20, 0};
  const Colouring wide =
      make_colouring(settings, random_map(random), cube_layout(5, true), 512, 512, 512 * 512, kSeed, 1);
  expect_exact(Frame(kFrame * kFrame, 0x00001234), wide, 4, "trunk");
  settings.level = 1;
  const Colouring half =
      make_colouring(settings, random_map(random), cube_layout(5, false), 512, 256, 512 * 256, kSeed, 2);
  expect_exact(random_frame(random, 3, 20), half, 3, "half");
}

TEST(ColourMicrocode, IsTheSameWithASlowerMultiplier) {
  std::mt19937 random(kSeed + 1);
  ColourSettings settings;
  settings.level = 1, settings.trunk_base = {60, 30, 10}, settings.trunk_range = {40, 20, 10};
  const Colouring colouring =
      make_colouring(settings, random_map(random), cube_layout(5, false), 200, 100, 20'000, kSeed, 1);
  const Frame before = random_frame(random, 3, 20);
  Frame wanted = before;
  colour_model(colouring, wanted);
  for (const char* pack : {"none", "full"}) {
    const lib::ProgramImage image = assembled(kProgram, pack, 4);
    EXPECT_EQ(wanted, frame_after(before, image, with_multiplier(4),
                                  [&](lib::RdsDriver& driver) { run_colour(driver, image, colouring); }))
        << pack;
  }
}

TEST(ColourMicrocode, BarkIsUniformOverBaseToBasePlusRange) {
  ColourSettings settings;
  settings.trunk_base = {60, 30, 10}, settings.trunk_range = {40, 20, 10};
  const Colouring colouring =
      make_colouring(settings, scene::Affine{}, cube_layout(5, false), 300, 200, 60'000, kSeed, 3);
  const Frame after = coloured(Frame(kFrame * kFrame, 0), colouring, 3, "full");
  int counts[3][256] = {};
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 300; ++x)
      for (int channel = 0; channel < 3; ++channel)
        ++counts[channel][after[y * kFrame + x] >> 8 * channel & 0xFF];
  for (int channel = 0; channel < 3; ++channel) {
    const int base = settings.trunk_base[channel], range = settings.trunk_range[channel];
    for (int value = 0; value < 256; ++value) {
      const bool inside = value >= base && value <= base + range;
      const double share = counts[channel][value] / 60'000.0;
      if (inside)
        EXPECT_NEAR(share * (range + 1), 1, 0.15) << channel << " " << value;
      else
        EXPECT_EQ(counts[channel][value], 0) << channel << " " << value;
    }
  }
}

TEST(TexelMap, OnePointHasOneTexelFromEveryView) {
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> place(-3, 3);
  scene::Image image;
  image.width = 300, image.height = 200;
  for (int i = 0; i < 200; ++i) {
    scene::Camera camera;
    camera.position = {place(random), place(random), 5 + place(random)};
    camera.target = {place(random) / 4, place(random) / 4, place(random) / 4};
    camera.height = 3;
    const scene::Affine view = scene::parallel_view(camera, image);
    const DepthMap depth = map_depth(-4, 17 + place(random), 0.05, 255);
    const glm::dvec3 world(place(random), place(random), place(random));
    const glm::dvec3 screen = view(world);
    for (const unsigned level : {0u, 2u}) {
      const glm::dvec3 texel =
          texel_map(view, depth, 10, level)({screen.x, screen.y, screen.z * depth.scale + depth.shift - 0.5});
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(texel[axis], world[axis] * (level == 0 ? 10 : 2.5), 1e-9);
    }
  }
}

TEST(TexelMap, WordsAreCoordinatesModuloTheRange) {
  EXPECT_EQ(to_texel_word(1.5), 0x18000u);
  EXPECT_EQ(to_texel_word(-1.0 / 65536), 0xFFFFFFFFu);
  EXPECT_EQ(to_texel_word(65536.0 * 7 + 3), 0x30000u);
  EXPECT_EQ(to_texel_word(-65536.0 * 7 - 3), 0xFFFD0000u);
}

scene::Options with(const std::string& key, scene::OptionValue::Array array) {
  scene::Options options("half_space", {"a.toml", 3});
  options.set(key, {std::move(array), {"a.toml", 7}});
  return options;
}

TEST(ColourHost, TheLevelIsTheNearestPowerOfTheTexelsInAPixel) {
  const auto level = [](double texels_per_metre, int mip) {
    scene::Options options("half_space", {"a.toml", 3});
    options.set("texels_per_metre", {texels_per_metre, {"a.toml", 7}});
    if (mip >= -1) options.set("mip", {std::int64_t{mip}, {"a.toml", 8}});
    return read_colour(options, 5, 2, 200).level;  // 100 pixels a metre
  };
  EXPECT_EQ(level(10, -2), 0u);
  EXPECT_EQ(level(140, -2), 0u);
  EXPECT_EQ(level(150, -2), 1u);
  EXPECT_EQ(level(400, -1), 2u);
  EXPECT_EQ(level(1e5, -2), 5u);
  EXPECT_EQ(level(1e5, 3), 3u);
  scene::Options none("half_space", {"a.toml", 3});
  EXPECT_EQ(read_colour(none, 5, 2, 200).texels_per_metre, 32);
}

TEST(ColourHost, WrongKeysAreErrorsThatNameThem) {
  const auto refusal = [](scene::Options options) {
    try {
      read_colour(options, 5, 2, 200);
      return std::string("accepted");
    } catch (const UserError& e) {
      return std::string(e.what());
    }
  };
  EXPECT_EQ(refusal(with("trunk_range", {{40.0, {}}, {20.0, {}}, {10.0, {}}})), "accepted");
  EXPECT_NE(refusal(with("trunk_range", {{196.0, {}}, {20.0, {}}, {10.0, {}}})).find("trunk_range"),
            std::string::npos);
  EXPECT_NE(refusal(with("trunk_base", {{256.0, {}}, {20.0, {}}, {10.0, {}}})).find("trunk_base"),
            std::string::npos);
  scene::Options mip("half_space", {"a.toml", 3});
  mip.set("mip", {std::int64_t{6}, {"a.toml", 9}});
  EXPECT_NE(refusal(mip).find("a.toml:9"), std::string::npos);
}

}  // namespace
}  // namespace dendro::half_space
