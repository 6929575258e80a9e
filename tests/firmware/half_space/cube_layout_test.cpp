#include "firmware/half_space/host/cube_layout.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "firmware/half_space/host/seeds.h"

namespace dendro::half_space {
namespace {

TEST(CubeLayout, LevelsDoNotOverlapAndStayInTheFrameBuffer) {
  for (const bool wide : {false, true}) {
    for (unsigned bits = 1; bits <= 5; ++bits) {
      const CubeLayout layout = cube_layout(bits, wide);
      ASSERT_EQ(layout.levels.size(), bits + 1);
      std::map<unsigned, std::set<std::uint32_t>> used;
      for (const CubeLevel& level : layout.levels)
        for (std::uint32_t i = 0; i < level.pixels(); ++i) {
          const std::uint32_t at = level.base + i;
          ASSERT_TRUE(used[level.byte].insert(at).second) << bits << " " << wide;
          ASSERT_LT(at, 512u * 512u);
          if (!wide) {
            ASSERT_GE(at >> 9, static_cast<std::uint32_t>(kHalfPictureLines));
          }
        }
    }
  }
}

TEST(CubeLayout, WideLevelsStandAtTheOffsetsOfThePapersCube) {
  const CubeLayout layout = cube_layout(5, true);
  std::vector<std::uint32_t> bases;
  for (const CubeLevel& level : layout.levels) bases.push_back(level.base);
  EXPECT_EQ(bases, (std::vector<std::uint32_t>{0, 131072, 147456, 149504, 149760, 149792}));
  EXPECT_EQ(bases.back() + layout.levels.back().pixels(), 149796u);
}

TEST(SeedTable, HoldsOddNumbersThatDifferBySeedAndStream) {
  const auto table = seed_table(1, 2, 100);
  for (const std::uint32_t seed : table) EXPECT_TRUE((seed & 1) == 1 && seed < 0x10000);
  EXPECT_NE(table, seed_table(2, 2, 100));
  EXPECT_NE(table, seed_table(1, 3, 100));
  EXPECT_EQ(table, seed_table(1, 2, 100));
  EXPECT_EQ(seeds_for(512), 1u);
  EXPECT_EQ(seeds_for(513), 2u);
}

}  // namespace
}  // namespace dendro::half_space
