#include "tests/cli/cli.h"

namespace dendro::cli {
namespace {

using Compare = CommandTest;
using json = nlohmann::json;

TEST_F(Compare, BothMachinesAreHeldToOneReferenceAndThePictureShowsWhereTheyDiffer) {
  ASSERT_EQ(0, dendro("run figure5 --out a --quiet").status);
  ASSERT_EQ(0, dendro("run figure5 --machine pixel-planes --out b --quiet").status);
  const Result result = dendro("compare a b --out d.png --json d.json");
  ASSERT_EQ(0, result.status) << result.err;
  EXPECT_NE(std::string::npos, result.out.find("figure5: "));
  const json d = json::parse(read("d.json"));
  EXPECT_EQ("compare", d["command"]);
  EXPECT_EQ(0, d["references_differ"]);
  EXPECT_LT(d["reference_distance"].get<double>(), 1e-6);
  // 16 bits of depth against 8.
  EXPECT_LT(d["runs"][1]["wrong_pixels"].get<int>() * 10, d["runs"][0]["wrong_pixels"].get<int>());
  EXPECT_EQ(json::parse(read("a/stats.json"))["error"]["wrong_pixels"],
            d["runs"][0]["lost"].get<int>() + d["runs"][0]["gained"].get<int>());
  EXPECT_EQ(0u, read("d.png").find("\x89PNG"));
}

TEST_F(Compare, ARunBesideItselfDiffersNowhere) {
  ASSERT_EQ(0, dendro("run icosahedron --set image.width=64 --set image.height=64 --out a --quiet").status);
  ASSERT_EQ(0, dendro("compare a a --json d.json --quiet").status);
  const json d = json::parse(read("d.json"));
  EXPECT_EQ(0, d["depth_distance"]);
  EXPECT_EQ(d["runs"][0]["wrong_pixels"], d["wrong_on_both"]);
}

TEST_F(Compare, BadInputIsOneLineAndLeavesNothing) {
  ASSERT_EQ(0, dendro("run icosahedron --set image.width=64 --set image.height=64 --out a --quiet").status);
  ASSERT_EQ(0, dendro("run icosahedron --set image.width=32 --set image.height=64 --out b --quiet").status);
  expect_user_error("compare a gone", "gone/stats.json: there is no such file");
  expect_user_error("compare a b --out d.png", "is 32x64 pixels, the first 64x64");
  expect_user_error("compare a", "second is required");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "d.png"));
}

}  // namespace
}  // namespace dendro::cli
