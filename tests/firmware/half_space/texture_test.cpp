#include <gtest/gtest.h>

#include <random>

#include "firmware/half_space/host/texture_program.h"
#include "firmware/half_space/reference/texture_model.h"
#include "tests/firmware/half_space/program_on_machine.h"

namespace dendro::half_space {
namespace {

constexpr std::uint32_t kPixels = 512 * 512;

lib::ProgramImage microcode(const std::string& pack) {
  return testing_programs::assembled("firmware/half_space/rds3000/texture.gia", pack);
}

TextureSettings settings_of(TextureKind kind, unsigned bits, bool wide, std::uint64_t seed) {
  scene::Options options("half_space", {"test.toml", 20});
  scene::Image image;
  image.height = 256;
  TextureSettings settings = read_texture(options, image, 32, seed);
  settings.kind = kind, settings.bits = bits, settings.wide = wide;
  return settings;
}

std::uint32_t address_of(std::uint32_t pixel) { return (pixel % 512) << 1 | (pixel / 512) << 11; }

/// A machine whose image memory holds noise.
class Noisy {
 public:
  explicit Noisy(bool wide) : machine_(spec_of(wide), options_of()), pixel_mask_(wide ? ~0u : 0xFFFFFFu) {
    std::mt19937 random(77);
    for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
      before_.push_back(random() & pixel_mask_);
      machine_.write(address_of(pixel), before_.back(), bps32::kFnLores);
    }
  }

  rds3000::FunctionEngine& machine() { return machine_; }

  /// Every pixel: the cube's bytes where it lies, what was there before everywhere else.
  void expect_cube(const CubeBytes& cube, const CubeLayout& layout, const std::string& what) {
    std::vector<std::uint32_t> wanted = before_;
    for (std::size_t k = 0; k < cube.size(); ++k) {
      const unsigned low = 8 * layout.levels[k].byte;
      ASSERT_EQ(cube[k].size(), layout.levels[k].pixels());
      for (std::size_t i = 0; i < cube[k].size(); ++i) {
        std::uint32_t& word = wanted[layout.levels[k].base + i];
        word = (word & ~(0xFFu << low)) | std::uint32_t{cube[k][i]} << low;
      }
    }
    for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel)
      ASSERT_EQ(machine_.read(address_of(pixel), bps32::kFnLores), wanted[pixel])
          << what << ", pixel " << pixel;
    machine_.write(0, ~0u, bps32::kFnLores);
    EXPECT_EQ(machine_.read(0, bps32::kFnLores), pixel_mask_) << what << ": the write mask is not restored";
  }

 private:
  static rds3000::Spec spec_of(bool wide) {
    rds3000::Spec spec;
    spec.memory.cards_per_bank = wide ? 4 : 3;
    return spec;
  }
  static MachineOptions options_of() {
    MachineOptions options;
    options.tick_limit = 200'000'000;
    return options;
  }

  rds3000::FunctionEngine machine_;
  std::uint32_t pixel_mask_;
  std::vector<std::uint32_t> before_;
};

void expect_exact(const TextureSettings& settings, const lib::ProgramImage& image, const std::string& what) {
  const CubeLayout layout = cube_layout(settings.bits, settings.wide);
  Noisy noisy(settings.wide);
  lib::RdsDriver driver(noisy.machine());
  driver.load_program(image);
  build(noisy.machine(), driver, image, settings, layout);
  noisy.expect_cube(make_texture(settings), layout, what);
}

class TextureMicrocode : public testing::TestWithParam<std::tuple<TextureKind, unsigned, bool, std::string>> {
};

TEST_P(TextureMicrocode, EveryByteOfEveryLevelIsThatOfTheIntegerModelAndOtherBitsStay) {
  const auto [kind, bits, wide, pack] = GetParam();
  const lib::ProgramImage image = microcode(pack);
  for (const std::uint64_t seed : {1u, 2u, 12345u}) {
    TextureSettings settings = settings_of(kind, bits, wide, seed);
    settings.chunk_edge = 1 + static_cast<int>(seed % 4);
    settings.chunks = static_cast<int>(seed == 1 ? 1 : 400 + seed % 500);
    settings.hurst = seed == 1 ? 0 : seed == 2 ? 0.5 : 1;
    expect_exact(settings, image, "seed " + std::to_string(seed));
  }
}

INSTANTIATE_TEST_SUITE_P(Cubes, TextureMicrocode,
                         testing::Combine(testing::Values(TextureKind::kChunks, TextureKind::kFbm),
                                          testing::Values(4u, 5u), testing::Bool(),
                                          testing::Values("none", "full")),
                         [](const auto& test) {
                           return std::string(std::get<0>(test.param) == TextureKind::kFbm ? "Fbm"
                                                                                           : "Chunks") +
                                  std::to_string(std::get<1>(test.param)) +
                                  (std::get<2>(test.param) ? "Wide" : "Half") + std::get<3>(test.param);
                         });

TEST(TextureMicrocodeLimits, NoChunksLeaveTheBaseColourAndTheMostChunksHaveSeeds) {
  const lib::ProgramImage image = microcode("none");
  TextureSettings settings = settings_of(TextureKind::kChunks, 4, false, 5);
  settings.chunks = 0;
  expect_exact(settings, image, "none");
  settings.chunks = 20'000;
  settings.chunk_edge = 4;
  expect_exact(settings, image, "most");
}

TEST(TextureMicrocodeLimits, TheLargestNoiseIsClampedTheSameWay) {
  TextureSettings settings = settings_of(TextureKind::kFbm, 4, false, 3);
  settings.hurst = 0;
  int ends = 0;
  const CubeBytes cube = make_texture(settings);
  for (std::size_t i = 3; i < cube[0].size(); i += 4) ends += cube[0][i] == 0 || cube[0][i] == 255;
  EXPECT_GT(ends, 10) << "the case should clamp";
  expect_exact(settings, microcode("none"), "clamped");
}

TEST(TextureMicrocodeLimits, ASecondRunOfTheLoadedProgramDependsOnNothingOfTheFirst) {
  const lib::ProgramImage image = microcode("none");
  const TextureSettings first = settings_of(TextureKind::kFbm, 5, false, 8);
  const TextureSettings second = settings_of(TextureKind::kChunks, 5, false, 9);
  Noisy noisy(false);
  lib::RdsDriver driver(noisy.machine());
  driver.load_program(image);
  const CubeLayout layout = cube_layout(5, false);
  build(noisy.machine(), driver, image, first, layout);
  build(noisy.machine(), driver, image, second, layout);
  noisy.expect_cube(make_texture(second), layout, "again");
}

TEST(TextureFromTheHost, LiesWhereTheMachineWouldMakeItAndOtherBitsStay) {
  for (const bool wide : {false, true})
    for (const unsigned bits : {4u, 5u}) {
      const CubeLayout layout = cube_layout(bits, wide);
      const CubeBytes cube = make_texture(settings_of(TextureKind::kFbm, bits, wide, 6));
      Noisy noisy(wide);
      send(noisy.machine(), cube, layout);
      noisy.expect_cube(cube, layout, wide ? "wide" : "half");
    }
}

}  // namespace
}  // namespace dendro::half_space
