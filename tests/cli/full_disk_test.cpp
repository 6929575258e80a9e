#include "tests/cli/cli.h"

namespace dendro::cli {
namespace {

class FullDisk : public CommandTest {
 protected:
  FullDisk() { write("s.toml", scene_with("solid = \"icosahedron\"\n")); }

  /// Status 2, one line that begins with the place, and nothing new in the folder.
  void expect_one_line(int blocks, const std::string& arguments, const std::string& place) const {
    const auto before = names();
    const Result result = dendro_within(blocks, arguments);
    EXPECT_EQ(2, result.status) << arguments << "\n" << result.err;
    EXPECT_EQ(0u, result.err.find("dendro: " + place + ": cannot write here: ")) << arguments << "\n" << result.err;
    EXPECT_EQ(1, std::count(result.err.begin(), result.err.end(), '\n')) << result.err;
    EXPECT_EQ(before, names()) << arguments;
  }
};

TEST_F(FullDisk, IsFoundBeforeARunBegins) {
  for (const char* file : {"--json", "--timeline"})
    expect_user_error(std::string("run s.toml --out r ") + file + " /dev/full", "/dev/full: cannot write here: ");
  expect_user_error("levels s.toml --out l --json /dev/full", "/dev/full: cannot write here: ");
  expect_user_error("record s.toml --boundary rds3000.host --out /dev/full", "/dev/full: cannot write here: ");
  expect_one_line(1, "run s.toml --quiet --out r", "r");
  expect_one_line(1, "run s.toml --quiet --json o.json --out r", "r");
  expect_one_line(1, "stability N-A10 --json o.json", "o.json");
  EXPECT_EQ(0, dendro("run s.toml --quiet --out r --json /dev/null").status);
}

// Pictures are the largest files; those of these sizes do not fit, all else does.
TEST_F(FullDisk, APictureThatDoesNotFitLeavesNothing) {
  expect_one_line(8, "levels s.toml --budget 0.001 --out l", "l/levels.png");
  expect_one_line(8, "stability N-A4 --out n", "n/N-A4.png");
  expect_one_line(8, "run s.toml --quiet --out r", "r/image.exr");
  expect_one_line(9, "run s.toml --quiet --out r", "r/image.exr");
}

TEST_F(FullDisk, KeepsTheRunOfBefore) {
  ASSERT_EQ(0, dendro("run s.toml --quiet --out r").status);
  const std::string before = read("r/stats.json");
  expect_one_line(8, "run s.toml --quiet --out r --seed 2", "r/image.exr");
  EXPECT_EQ(before, read("r/stats.json"));
}

TEST_F(FullDisk, ATraceThatDoesNotFitLeavesNothing) {
  expect_one_line(8, "record s.toml --boundary rds3000.host --text --out t.txt", "t.txt");
}

TEST_F(FullDisk, ASweepWithoutAnyResultLeavesNoFolder) {
  write("a.toml", "scene = \"s.toml\"\n[[axis]]\nkey = \"seed\"\nvalues = [1, 2]\n");
  expect_one_line(8, "sweep a.toml --quiet --out w", "w/results.sqlite");
}

}  // namespace
}  // namespace dendro::cli
