#include "firmware/half_space/reference/texture_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "firmware/half_space/host/seeds.h"
#include "sim/base/error.h"

namespace dendro::half_space {
namespace {

using Value = decltype(scene::OptionValue::value);
using Array = scene::OptionValue::Array;

constexpr int kSide = 32;

TextureSettings read(const std::map<std::string, Value>& keys, int height = 256, unsigned pixel_bits = 24) {
  scene::Options options("half_space", {"test.toml", 20});
  for (const auto& [key, value] : keys) options.set(key, {value, {"test.toml", 22}});
  scene::Image image;
  image.height = height;
  image.where = {"test.toml", 3};
  const TextureSettings settings = read_texture(options, image, pixel_bits, 1);
  options.finish();
  return settings;
}

std::string refusal(const std::map<std::string, Value>& keys, int height = 256, unsigned pixel_bits = 24) {
  try {
    read(keys, height, pixel_bits);
    return "accepted";
  } catch (const UserError& error) {
    return error.what();
  }
}

Array numbers(const std::vector<double>& values) {
  Array array;
  array.reserve(values.size());
  for (const double value : values) array.emplace_back().value = value;
  return array;
}

Array rows(const std::vector<std::vector<double>>& values) {
  Array array;
  for (const std::vector<double>& row : values) array.emplace_back().value = numbers(row);
  return array;
}

TextureSettings fbm(double hurst, std::int64_t seed) {
  return read({{"texture", std::string("fbm")}, {"texture_hurst", hurst}, {"texture_seed", seed}});
}

/// Byte c of the finest level's texel, `x` counted along `axis` and the others following cyclically.
int byte_of(const CubeBytes& cube, int axis, int x, int y, int z, int c) {
  int p[3];
  p[axis] = x % kSide, p[(axis + 1) % 3] = y, p[(axis + 2) % 3] = z;
  return cube[0][static_cast<std::size_t>(((p[2] * kSide + p[1]) * kSide + p[0]) * 4 + c)];
}

/// Mean squared difference of the values on the planes x and x + lag of texels whose coordinates are
/// multiples of `grid`, over seeds and axes; 0 where x is not.
std::vector<double> squared_differences(double hurst, int lag, int grid = 1) {
  constexpr int kSeeds = 12;
  std::vector<double> sums(kSide);
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const CubeBytes cube = make_texture(fbm(hurst, seed));
    for (int axis = 0; axis < 3; ++axis)
      for (int x = 0; x < kSide; x += grid)
        for (int y = 0; y < kSide; y += grid)
          for (int z = 0; z < kSide; z += grid) {
            const double d = byte_of(cube, axis, x, y, z, 3) - byte_of(cube, axis, x + lag, y, z, 3);
            sums[x] += d * d * grid * grid / (kSide * kSide * 3 * kSeeds);
          }
  }
  return sums;
}

double mean(const std::vector<double>& values, std::size_t count) {
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += values[i];
  return sum / static_cast<double>(count);
}

TEST(TextureModel, FractionalBrownianMotionHasNoSeamWhereTheCubeRepeats) {
  for (const double hurst : {0.2, 0.5, 0.9}) {
    const std::vector<double> steps = squared_differences(hurst, 1);
    const double inside = mean(steps, kSide - 1);
    EXPECT_NEAR(steps[kSide - 1] / inside, 1, 0.12) << hurst;
    // What a seam would look like: the same cube cut and joined half a side further.
    EXPECT_GT(squared_differences(hurst, kSide / 2)[0] / inside, 2) << hurst;
  }
}

TEST(TextureModel, DifferencesFromOneGridToTheNextCoarserGrowAsTheHurstExponentSays) {
  for (const double hurst : {0.0, 0.2, 0.5, 0.8})
    for (const int grid : {1, 2}) {
      const double near = mean(squared_differences(hurst, grid, grid), kSide) * grid;
      const double far = mean(squared_differences(hurst, 2 * grid, 2 * grid), kSide) * 2 * grid;
      EXPECT_NEAR(std::log2(far / near) / 2, hurst, 0.1) << grid;
    }
}

TEST(TextureModel, FbmColoursAreThoseOfTheTableForTheValue) {
  const TextureSettings settings = fbm(0.5, 4);
  const CubeBytes cube = make_texture(settings);
  for (std::size_t i = 0; i < cube[0].size(); i += 4)
    for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(cube[0][i + c], settings.colours[cube[0][i + 3]][c]);
}

TextureSettings marked_chunks(std::int64_t count, std::int64_t edge, std::int64_t seed) {
  // Red tells the colours apart: 0 the base, 10 to 40 the chunks'.
  const Array colours = rows({{10, 1, 1, 0.4}, {20, 1, 1, 0.3}, {30, 1, 1, 0.2}, {40, 1, 1, 0.1}});
  return read({{"texture", std::string("chunks")},
               {"chunks", count},
               {"chunk_edge", edge},
               {"texture_seed", seed},
               {"texture_base", numbers({0, 0, 0})},
               {"chunk_colours", colours}});
}

TEST(TextureModel, ChunksTakeTheirColoursInTheWantedSharesAndLieEvenly) {
  constexpr double kTexels = kSide * kSide * kSide, kChunks = 20'000;
  const CubeBytes cube = make_texture(marked_chunks(20'000, 1, 3));
  std::map<int, double> seen;
  std::vector<std::vector<double>> planes(3, std::vector<double>(kSide));
  for (int axis = 0; axis < 3; ++axis)
    for (int x = 0; x < kSide; ++x)
      for (int y = 0; y < kSide; ++y)
        for (int z = 0; z < kSide; ++z) {
          const int red = byte_of(cube, axis, x, y, z, 0);
          seen[red] += axis == 0;
          planes[axis][x] += red != 0;
        }
  const double covered = kTexels - seen[0];
  EXPECT_NEAR(covered / kTexels, 1 - std::pow(1 - 1 / kTexels, kChunks), 0.01);
  for (const auto& [red, share] : std::map<int, double>{{10, 0.4}, {20, 0.3}, {30, 0.2}, {40, 0.1}})
    EXPECT_NEAR(seen[red] / covered, share, 0.02) << red;
  for (int axis = 0; axis < 3; ++axis)
    for (const double count : planes[axis])
      EXPECT_NEAR(count, covered / kSide, 5 * std::sqrt(covered / kSide));
}

TEST(TextureModel, AChunkIsABlockThatGoesOnAtTheOtherSide) {
  int wrapped = 0;
  for (std::int64_t seed = 1; seed <= 40; ++seed)
    for (const int edge : {1, 2, 3, 4}) {
      const CubeBytes cube = make_texture(marked_chunks(1, edge, seed));
      int texels = 0;
      for (int axis = 0; axis < 3; ++axis) {
        std::vector<bool> used(kSide);
        for (int x = 0; x < kSide; ++x)
          for (int y = 0; y < kSide; ++y)
            for (int z = 0; z < kSide; ++z)
              if (byte_of(cube, axis, x, y, z, 0) != 0) used[x] = true, ++texels;
        EXPECT_EQ(std::count(used.begin(), used.end(), true), edge);
        int starts = 0;
        for (int x = 0; x < kSide; ++x) starts += used[x] && !used[(x + kSide - 1) % kSide];
        EXPECT_EQ(starts, 1);
        wrapped += edge > 1 && used[0] && used[kSide - 1];
      }
      EXPECT_EQ(texels, 3 * edge * edge * edge);
    }
  EXPECT_GT(wrapped, 0) << "some chunk should cross the cube's side";
}

TEST(TextureModel, NoStepFromAChunkLeadsToAnotherMoreOftenThanByChance) {
  // Numbers in a row of the generator alone would lie on a lattice, whose short steps stand out.
  const CubeBytes cube = make_texture(marked_chunks(4000, 1, 2));
  const auto covered = [&](int x, int y, int z) { return byte_of(cube, 0, x, y & 31, z & 31, 0) != 0; };
  double all = 0;
  std::map<std::array<int, 3>, int> pairs;
  for (int z = 0; z < kSide; ++z)
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        if (!covered(x, y, z)) continue;
        all += 1;
        for (int c = 0; c <= 4; ++c)
          for (int b = -4; b <= 4; ++b)
            for (int a = -4; a <= 4; ++a) pairs[{a, b, c}] += covered((x + a) & 31, y + b, z + c);
      }
  const double by_chance = all * all / (kSide * kSide * kSide);
  for (const auto& [step, count] : pairs) {
    if (step == std::array<int, 3>{0, 0, 0}) continue;
    EXPECT_NEAR(count, by_chance, 7 * std::sqrt(by_chance)) << step[0] << " " << step[1] << " " << step[2];
  }
}

TEST(TextureModel, ACoarserTexelIsTheFlooredMeanOfEightAndLevelsKeepTheCubesMean) {
  const CubeBytes cube = make_texture(fbm(0.5, 2));
  ASSERT_EQ(cube.size(), 6u);
  std::vector<double> means;
  for (std::size_t k = 0; k < cube.size(); ++k) {
    const std::size_t side = kSide >> k;
    ASSERT_EQ(cube[k].size(), 4 * side * side * side);
    double sum = 0;
    for (const std::uint8_t byte : cube[k]) sum += byte;
    means.push_back(sum / static_cast<double>(cube[k].size()));
    if (k == 0) continue;
    const std::size_t row = 4 * 2 * side, plane = row * 2 * side;  // of the finer level
    for (std::size_t i = 0; i < cube[k].size(); ++i) {
      const std::size_t texel = i / 4, x = texel % side, y = texel / side % side, z = texel / side / side;
      const std::size_t at = z * 2 * plane + y * 2 * row + x * 8 + i % 4;
      int total = 0;
      for (const std::size_t step : {std::size_t{0}, row, plane, row + plane})
        total += cube[k - 1][at + step] + cube[k - 1][at + step + 4];
      ASSERT_EQ(cube[k][i], total / 8) << k << " " << i;
    }
    EXPECT_LE(means[k], means[k - 1]);
    EXPECT_GE(means[k], means[k - 1] - 1);
  }
}

TEST(TextureSettings, SeedsAreEnoughForEveryDrawOfTheLargestCubes) {
  for (const TextureSettings& settings : {fbm(0.5, 1), marked_chunks(20'000, 4, 1), marked_chunks(0, 1, 1)}) {
    EXPECT_GE(texture_seeds(settings).size() * kDrawsPerSeed, texture_draws(settings));
    EXPECT_LT(texture_seeds(settings).size() * kDrawsPerSeed, texture_draws(settings) + kDrawsPerSeed);
    EXPECT_LE(texture_seeds(settings).size(), 160u);
  }
}

TEST(TextureSettings, DisplacementsBeginWithAllValuesAndFallWithDistanceToThePowerOfTheExponent) {
  for (const double hurst : {0.0, 0.3, 1.0}) {
    const std::vector<Amplitudes> all = amplitudes(5, hurst);
    ASSERT_EQ(all.size(), 5u);
    EXPECT_EQ(all[0].body, 16u * 128);
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_NEAR(all[i].face, all[i].body * std::pow(2.0 / 3, hurst / 2), 1);
      EXPECT_NEAR(all[i].edge, all[i].body * std::pow(1.0 / 3, hurst / 2), 1);
      if (i == 0) continue;
      EXPECT_NEAR(all[i].body, all[i - 1].body * std::pow(0.5, hurst), 1);
    }
  }
}

TEST(TextureSettings, AutoPutsTheCubeIntoAFourthByteWhereThereIsOne) {
  const Value chunks = std::string("chunks");
  EXPECT_FALSE(read({{"texture", chunks}}, 256, 24).wide);
  EXPECT_TRUE(read({{"texture", chunks}}, 512, 32).wide);
  EXPECT_FALSE(read({{"texture", chunks}, {"layout", std::string("half")}}, 200, 32).wide);
  EXPECT_EQ(read({}, 512, 24).kind, TextureKind::kNone);
}

TEST(TextureSettings, WhatCannotBeIsOneLineThatNamesTheKey) {
  const Value chunks = std::string("chunks");
  const auto begins = [](const std::string& text, const std::string& start) {
    return text.rfind(start, 0) == 0;
  };
  const std::map<std::string, std::map<std::string, Value>> cases = {
      {"test.toml:22: half_space.cube_bits: 64 x 64 x 64 texels take 1048576 pixels and do not fit",
       {{"texture", chunks}, {"cube_bits", std::int64_t{6}}}},
      {"test.toml:22: half_space.cube_bits: 3 is outside",
       {{"texture", chunks}, {"cube_bits", std::int64_t{3}}}},
      {"test.toml:22: half_space.layout: \"wide\" keeps",
       {{"texture", chunks}, {"layout", std::string("wide")}}},
      {"test.toml:22: half_space.texture: \"bricks\" is not known", {{"texture", std::string("bricks")}}},
      {"test.toml:22: half_space.texture_from: ", {{"texture_from", std::string("disk")}}},
      {"test.toml:22: half_space.chunks: 20001 is outside", {{"chunks", std::int64_t{20'001}}}},
      {"test.toml:22: half_space.chunk_edge: 5 is outside", {{"chunk_edge", std::int64_t{5}}}},
      {"test.toml:22: half_space.texture_hurst: 1.5 is outside", {{"texture_hurst", 1.5}}},
      {"test.toml:22: half_space.texture_base: ", {{"texture_base", numbers({1, 2, 256})}}},
      {"test.toml:22: half_space.texture_colours: must be a list", {{"texture_colours", Array{}}}},
      {"test.toml:22: half_space.texture_colours: red, green", {{"texture_colours", rows({{1, -2, 3}})}}},
      {"test.toml:22: half_space.chunk_colours: the shares",
       {{"chunk_colours", rows({{1, 2, 3, 0.7}, {1, 2, 3, 0.4}})}}},
      {"test.toml:22: half_space.chunk_colours: every share", {{"chunk_colours", rows({{1, 2, 3, 0}})}}}};
  for (const auto& [start, keys] : cases) {
    EXPECT_TRUE(begins(refusal(keys), start)) << refusal(keys);
    EXPECT_EQ(refusal(keys).find('\n'), std::string::npos);
  }
  EXPECT_TRUE(begins(refusal({{"texture", chunks}}, 257), "test.toml:3: image.height: 257 lines do not fit"))
      << refusal({{"texture", chunks}}, 257);
  EXPECT_EQ(refusal({{"texture", chunks}}, 512, 32), "accepted");
}

}  // namespace
}  // namespace dendro::half_space
