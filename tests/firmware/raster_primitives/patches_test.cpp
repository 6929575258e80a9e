#include "firmware/raster_primitives/host/patches.h"

#include <gtest/gtest.h>

#include <fstream>

#include "sim/base/error.h"

namespace dendro::raster_primitives {
namespace {

std::string file_with(const std::string& text) {
  const std::string path = ::testing::TempDir() + "/patches_test_" +
                           ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".patches";
  std::ofstream(path) << text;
  return path;
}

/// One patch over the square 0..3 whose points lie in their places.
std::string flat_patch() {
  std::string text = "1\n1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16\n16\n";
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) text += std::to_string(x) + "," + std::to_string(y) + ",2\n";
  return text;
}

std::string error_of(const std::string& text) {
  try {
    load_patches(file_with(text), 2, {"scene.toml", 7}, "object.mesh");
  } catch (const UserError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Patches, OfEvenlySpacedPointsAreAFlatGrid) {
  const scene::Mesh mesh = load_patches(file_with(flat_patch()), 3, {}, {});
  ASSERT_EQ(mesh.triangles.size(), 18u);
  for (std::size_t k = 0; k < 16; ++k) {
    EXPECT_NEAR(mesh.vertices[k].x, static_cast<double>(k % 4), 1e-12);
    EXPECT_NEAR(mesh.vertices[k].y, static_cast<double>(k / 4), 1e-12);
    EXPECT_NEAR(mesh.vertices[k].z, 2, 1e-12);
  }
}

TEST(Patches, OfTheTeapotLieInItsBoxAndTouchItsRim) {
  const scene::Mesh mesh = load_patches(std::string(MESHES) + "/newell_teapot.patches", 8, {}, {});
  double low = 10, high = -10;
  for (const auto& v : mesh.vertices) low = std::min(low, v.z), high = std::max(high, v.z);
  EXPECT_NEAR(low, 0, 1e-9);
  EXPECT_NEAR(high, 3.15, 1e-9);
  EXPECT_GT(mesh.triangles.size(), 3800u);  // 32 patches; some edges are points
}

TEST(Patches, WrongFilesAreOneLineWithTheLinesNumber) {
  std::string text = flat_patch();
  EXPECT_NE(error_of(text.substr(0, text.size() - 12)).find("patches:1"), std::string::npos);
  EXPECT_NE(error_of("1\n1,2,3\n").find(":2: 16 numbers make a patch, not 3"), std::string::npos) << error_of("1\n1,2,3\n");
  EXPECT_NE(error_of("many\n").find(":1: \"many\" is no finite number"), std::string::npos);
  EXPECT_NE(error_of("0\n").find(":1: the number of patches must be a whole number in 1..10000"), std::string::npos);
  text.replace(text.find("16\n16"), 2, "17");
  EXPECT_NE(error_of(text).find("a patch names point 17 of 16"), std::string::npos) << error_of(text);
  try {
    load_patches("/nowhere.patches", 2, {"scene.toml", 7}, "object.mesh");
    FAIL();
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find("scene.toml:7: object.mesh: cannot read"), std::string::npos);
  }
}

}  // namespace
}  // namespace dendro::raster_primitives
