#include <cmath>

#include "tests/cli/cli.h"

namespace dendro::cli {
namespace {

using nlohmann::json;
using Stability = CommandTest;

TEST_F(Stability, EveryCaseHoldsAndItsRowsHaveTheContractsKeys) {
  const Result result = dendro("stability --json s.json --out s");
  ASSERT_EQ(0, result.status) << result.out << result.err;
  EXPECT_EQ("", result.err);
  const json s = json::parse(read("s.json"));
  EXPECT_EQ("stability", s["command"]);
  for (const char* id : {"N-A1", "N-A2", "N-A3", "N-A4", "N-A5", "N-A6", "N-A7", "N-A8", "N-A9", "N-A10", "X1", "X2",
                         "X3", "X4", "X6", "N-P1", "N-P2", "N-P3", "N-P4", "N-B1", "N-B2", "N-B3", "N-B4", "N-B5", "N-B6", "N-B7", "N-B8"})
    EXPECT_TRUE(std::any_of(s["rows"].begin(), s["rows"].end(), [&](const json& row) {
      return row["case"] == id;
    })) << id;
  for (const json& row : s["rows"]) {
    EXPECT_TRUE(row["measured"].is_number() && row["bound"].is_number()) << row;
    EXPECT_EQ(true, row["pass"]) << row;
  }
  // Wrapping and saturating adders have to be seen to fail, on single planes and on solids.
  int must_fail = 0;
  for (const json& row : s["rows"]) {
    if (row["case"] != "N-A1" || row["relation"] != "more than") continue;
    ++must_fail;
    EXPECT_GT(row["measured"], 100) << row;
    EXPECT_NE(std::string::npos, row["where"].get<std::string>().find("step ")) << row;
  }
  EXPECT_EQ(4, must_fail);
  for (const char* name :
       {"s/stability.json", "s/stability.csv", "s/summary.txt", "s/N-A4.csv", "s/N-A4.png", "s/N-A1.csv"})
    EXPECT_GT(read(name).size(), 100u) << name;
  EXPECT_EQ(0u, read("s/N-A4.png").find("\x89PNG"));
}

TEST_F(Stability, TheSeedDecidesEverythingRandomAndChosenCasesComeAlone) {
  const Result a = dendro("stability X3 N-A10 --seed 7 --json -"),
               b = dendro("stability N-A10 X3 --seed 7 --jobs 1 --json -");
  const Result other = dendro("stability X3 N-A10 --seed 8 --json -");
  ASSERT_EQ(0, a.status) << a.err;
  EXPECT_EQ(a.out, b.out);
  EXPECT_NE(a.out, other.out);
  const json rows = json::parse(a.out)["rows"];
  for (const json& row : rows) EXPECT_TRUE(row["case"] == "X3" || row["case"] == "N-A10") << row;
}

TEST_F(Stability, ListNamesEveryCaseWithItsMachineAndRunsNone) {
  const Result result = dendro("stability list");
  ASSERT_EQ(0, result.status) << result.err;
  for (const char* part : {"N-A1 ", "N-P4 ", "N-B8 ", "sgi-4d35", "pixel-planes:pxpl4", "rds3000:fg86"})
    EXPECT_NE(std::string::npos, result.out.find(part)) << part;
  EXPECT_EQ(result.out.npos, result.out.find("bounds hold"));
}

TEST_F(Stability, BadInputIsOneLineAndLeavesNothing) {
  expect_user_error("stability N-A99", "N-A10");
  expect_user_error("stability N-A10 --jobs 0", "--jobs");
  expect_user_error("stability N-A10 --json /nowhere/s.json", "/nowhere");
  expect_user_error("stability N-A99 --out s", "N-A99");
}

}  // namespace
}  // namespace dendro::cli
