#include <algorithm>
#include <cctype>
#include <map>

#include "tests/cli/cli.h"

namespace dendro::cli {
namespace {

using json = nlohmann::json;

/// On small pictures of small trees the times mean nothing, but the rows, the counts and the relations are the same.
class TableMo95 : public CommandTest {
 protected:
  std::map<std::string, json> table(const std::string& settings) {
    const Result result = dendro("table MO95 --json o.json --set image.width=60 --set image.height=60 " + settings);
    EXPECT_EQ(0, result.status) << result.err;
    std::map<std::string, json> by_id;
    if (result.status != 0) return by_id;
    const json rows = json::parse(read("o.json"))["rows"];
    for (const json& row : rows) EXPECT_TRUE(by_id.emplace(row["id"], row).second) << row["id"];
    return by_id;
  }
};

TEST_F(TableMo95, EveryClaimHasARowAndWhatIsCountedIsExact) {
  auto rows = table("--set object.0.age=5 --set zbuffer_views.view_width=80 --set zbuffer_views.view_height=120");
  for (int claim = 1; claim <= 18; ++claim) {
    const std::string id = "MO95-B" + std::to_string(claim);
    EXPECT_TRUE(std::any_of(rows.begin(), rows.end(), [&](const auto& row) {
      return row.first == id || (row.first.compare(0, id.size(), id) == 0 && std::isalpha(row.first[id.size()]));
    })) << id;
  }
  for (const auto& [id, row] : rows) {
    SCOPED_TRACE(id + ": " + row["note"].get<std::string>());
    if (row["simulated"].is_null()) {
      EXPECT_EQ(0u, row["note"].get<std::string>().find("no figure: "));
      continue;
    }
    EXPECT_LE(row["low"], row["simulated"]);
    EXPECT_GE(row["high"], row["simulated"]);
    if (!row["published"].is_null())
      EXPECT_EQ(row["inside"].get<bool>(), row["low"] <= row["published"] && row["high"] >= row["published"]);
  }
  EXPECT_EQ(14, rows["MO95-B1a"]["simulated"]);
  EXPECT_EQ(23, rows["MO95-B1b"]["simulated"]);
  EXPECT_EQ(80 * 120 * 2 * 7, rows["MO95-B3"]["simulated"]);
  for (const char* id : {"MO95-B6a", "MO95-B6b", "MO95-B7a", "MO95-B7b", "MO95-B7c", "MO95-B8", "MO95-B10a"}) {
    EXPECT_LT(rows[id]["low"], rows[id]["simulated"]) << id;
    EXPECT_GT(rows[id]["high"], rows[id]["simulated"]) << id;
    EXPECT_FALSE(rows[id]["assumptions"].empty()) << id;
  }
  EXPECT_GT(rows["MO95-B6b"]["simulated"], rows["MO95-B6a"]["simulated"]);
  EXPECT_GT(rows["MO95-B7b"]["simulated"], rows["MO95-B7a"]["simulated"]);
  // One of the grove's seven trees would be younger than the others.
  EXPECT_TRUE(rows["MO95-B9"]["simulated"].is_null());
  EXPECT_NE(std::string::npos, rows["MO95-B9"]["note"].get<std::string>().find("must be the same tree"));
}

TEST_F(TableMo95, WhatNoSceneTakesIsOneLine) {
  expect_user_error("table MO95 --level function", "level with time");
  expect_user_error("table MO95 --set zbuffer_views.layer=1", "did you mean `layers`?");
}

}  // namespace
}  // namespace dendro::cli
