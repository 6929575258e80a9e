#include <algorithm>
#include <cctype>
#include <map>

#include "tests/cli/cli.h"

namespace dendro::cli {
namespace {

using json = nlohmann::json;

/// On small pictures of small trees the times mean nothing, but the rows, the counts and the relations are
/// the same.
class TableMo95 : public CommandTest {
 protected:
  std::map<std::string, json> table(const std::string& rows = "") {
    const Result result = dendro(
        "table MO95 --json o.json --set image.width=60 --set image.height=60 --set object.0.age=5 "
        "--set zbuffer_views.view_width=80 --set zbuffer_views.view_height=120" +
        rows);
    EXPECT_EQ(0, result.status) << result.err;
    std::map<std::string, json> by_id;
    if (result.status != 0) return by_id;
    const json list = json::parse(read("o.json"))["rows"];
    for (const json& row : list) {
      EXPECT_TRUE(by_id.emplace(row["id"], row).second) << row["id"];
      expect_sound(row);
    }
    return by_id;
  }

  static void expect_sound(const json& row) {
    SCOPED_TRACE(row["id"].get<std::string>() + ": " + row["note"].get<std::string>());
    if (row["simulated"].is_null()) {
      EXPECT_EQ(0u, row["note"].get<std::string>().find("no figure: "));
      return;
    }
    EXPECT_LE(row["low"], row["simulated"]);
    EXPECT_GE(row["high"], row["simulated"]);
    if (row["published"].is_null()) return;
    EXPECT_EQ(row["inside"].get<bool>(), row["low"] <= row["published"] && row["high"] >= row["published"]);
  }

  static void expect_interval(const json& row) {
    EXPECT_LT(row["low"], row["simulated"]) << row["id"];
    EXPECT_GT(row["high"], row["simulated"]) << row["id"];
    EXPECT_FALSE(row["assumptions"].empty()) << row["id"];
  }
};

TEST_F(TableMo95, RowsHaveFiguresWithIntervalsOrAReason) {
  auto rows = table(" --row MO95-B3 --row MO95-B9b --row MO95-P3 --row MO95-P8");
  EXPECT_EQ(4u, rows.size());
  EXPECT_EQ(80 * 120 * 2 * 7, rows["MO95-B3"]["simulated"]);
  expect_interval(rows["MO95-B9b"]);
  expect_interval(rows["MO95-P8"]);
  EXPECT_NE(std::string::npos, rows["MO95-P8"]["note"].get<std::string>().find(" % wait for "));
  for (const char* reading : {"-O1 ", "rounding by FCR31 ", "unmapped "})
    EXPECT_NE(std::string::npos, rows["MO95-B9b"]["note"].get<std::string>().find(reading)) << reading;
  EXPECT_TRUE(rows["MO95-P3"]["simulated"].is_null());
}

TEST_F(TableMo95, LongEveryClaimHasARowAndWhatIsCountedIsExact) {
  auto rows = table();
  const auto expect_claims = [&](const std::string& kind, int count) {
    for (int claim = 1; claim <= count; ++claim) {
      const std::string id = "MO95-" + kind + std::to_string(claim);
      EXPECT_TRUE(std::any_of(rows.begin(), rows.end(), [&](const auto& row) {
        return row.first == id ||
               (row.first.compare(0, id.size(), id) == 0 && std::isalpha(row.first[id.size()]));
      })) << id;
    }
  };
  expect_claims("B", 18);
  expect_claims("P", 10);
  EXPECT_EQ(14, rows["MO95-B1a"]["simulated"]);
  EXPECT_EQ(23, rows["MO95-B1b"]["simulated"]);
  EXPECT_EQ(80 * 120 * 2 * 7, rows["MO95-B3"]["simulated"]);
  for (const char* id : {"MO95-B6a", "MO95-B6b", "MO95-B7a", "MO95-B7b", "MO95-B7c", "MO95-B8", "MO95-B9b",
                         "MO95-B10a", "MO95-B11a", "MO95-P6", "MO95-P7a", "MO95-P9b", "MO95-P10"})
    expect_interval(rows[id]);
  EXPECT_GT(rows["MO95-B6b"]["simulated"], rows["MO95-B6a"]["simulated"]);
  EXPECT_GT(rows["MO95-B7b"]["simulated"], rows["MO95-B7a"]["simulated"]);
  // A disk only adds.
  for (const auto& [without, with] : {std::pair("MO95-B7a", "MO95-B7d"), std::pair("MO95-B7b", "MO95-B7e"),
                                      std::pair("MO95-B7c", "MO95-B7f")})
    for (const char* figure : {"simulated", "low", "high"})
      EXPECT_GT(rows[with][figure], rows[without][figure]) << with;
  // One of the grove's seven trees would be younger than the others.
  EXPECT_TRUE(rows["MO95-B9a"]["simulated"].is_null());
  EXPECT_NE(std::string::npos, rows["MO95-B9a"]["note"].get<std::string>().find("must be the same tree"));
}

TEST_F(TableMo95, ARowAloneIsMadeWithoutTheOthers) {
  const Result alone = dendro("table all --row MO95-B3 --row MO95-P5 --row MO95-B18 --json -");
  ASSERT_EQ(0, alone.status) << alone.err;
  std::vector<std::string> ids;
  const json rows = json::parse(alone.out)["rows"];
  for (const json& row : rows) ids.push_back(row["id"]);
  EXPECT_EQ((std::vector<std::string>{"MO95-B3", "MO95-B18", "MO95-P5a", "MO95-P5b"}), ids);
  EXPECT_EQ(2520000, rows[0]["simulated"]);
  expect_user_error("table MO95 --row MO95-B99", "no such row");
  expect_user_error("table MO95 --row MO95-B3a", "no such row");
  expect_user_error("table MO95 --row FG86-A7", "no such row");
}

TEST_F(TableMo95, TheListNamesEveryTable) {
  const Result list = dendro("table list");
  EXPECT_EQ(0, list.status);
  for (const char* key : {"FG86 ", "FGHS85 ", "MO95 "})
    EXPECT_NE(std::string::npos, list.out.find(key)) << list.out;
}

/// The whole table: minutes.
TEST_F(TableMo95, LongRelationsThatMO95StatesHold) {
  const Result result = dendro("table MO95 --json o.json");
  ASSERT_EQ(0, result.status) << result.err;
  std::map<std::string, json> rows;
  const json list = json::parse(read("o.json"))["rows"];
  for (const json& row : list) rows[row["id"]] = row;
  const auto figure = [&](const char* id) { return rows[id]["simulated"].get<double>(); };
  EXPECT_EQ(2520000, figure("MO95-B3"));
  EXPECT_EQ(14, figure("MO95-B1a"));
  EXPECT_EQ(23, figure("MO95-B1b"));
  EXPECT_NEAR(figure("MO95-B6c"), figure("MO95-B6b") / figure("MO95-B6a"), 1e-12);
  EXPECT_GT(figure("MO95-B6c"), 2);
  EXPECT_LT(figure("MO95-B6c"), 3);
  // Three layers in one pass over the triangles, not in three (MO95-K10).
  EXPECT_LT(figure("MO95-B7b"), 2 * figure("MO95-B7a"));
  // The same picture, from views that cost more.
  EXPECT_GT(figure("MO95-B10d"), figure("MO95-B10c"));
  EXPECT_EQ(1, figure("MO95-B12"));
  // A tree of the grove costs about what it costs alone.
  EXPECT_NEAR(1, figure("MO95-B9a") / 7 / figure("MO95-B9b"), 0.2);
  for (const char* id : {"MO95-B7c", "MO95-B7e", "MO95-B10a", "MO95-P10"})
    EXPECT_TRUE(rows[id]["inside"].get<bool>()) << id;
}

TEST_F(TableMo95, WhatNoSceneTakesIsOneLine) {
  expect_user_error("table MO95 --level function", "level with time");
  expect_user_error("table MO95 --set zbuffer_views.layer=1", "did you mean `layers`?");
}

}  // namespace
}  // namespace dendro::cli
