#include "sim/study/table.h"

#include "sim/study/table_picture.h"
#include "sim/study/table_rows.h"
#include "tests/core/study/fake_machine.h"

namespace dendro::study {
namespace {

TableRow row(double published, double simulated, double low, double high) {
  TableRow r;
  r.published = published;
  r.simulated = simulated;
  r.low = low;
  r.high = high;
  return r;
}

TEST(TableRow, IsInsideWhenTheIntervalHoldsThePublishedValue) {
  EXPECT_TRUE(row(12, 10, 12, 13).inside());
  EXPECT_TRUE(row(12, 14, 11, 12).inside());
  EXPECT_FALSE(row(12, 14, 12.1, 15).inside());
  EXPECT_FALSE(row(12, 10, 9, 11.9).inside());
  EXPECT_EQ(1.25, *row(12, 15, 9, 20).ratio());
}

TEST(TableRow, NamesOnlyAssumptionsThatMoveItWidestFirst) {
  const config::Preset preset = config::load_preset("fake", fake::catalogue().presets(), {});
  TableRow r = row(1, 1, 1, 1);
  Interval interval;
  interval.low = 1;
  interval.high = 3;
  interval.contributions = {
      {"rate.words_per_s", 1, 3, ""}, {"delay.b_ticks", 1, 2, ""}, {"delay.a_ticks", 1, 1, ""}};
  set_interval(r, interval, preset.parameters);
  EXPECT_EQ((std::vector<std::string>{"DEV-004", "DEV-002"}), r.assumptions);
  EXPECT_EQ(2u, r.widened_by.size());
}

TEST(TableRow, WithoutAnAnswerSaysWhyAndHasNoVerdict) {
  TableRow r;
  r.id = "X-1";
  r.published = 3;
  r.note = "not in this slice";
  const std::string json = table_json({r});
  EXPECT_NE(std::string::npos, json.find("\"simulated\": null"));
  EXPECT_NE(std::string::npos, json.find("\"inside\": null"));
  EXPECT_NE(std::string::npos, json.find("not in this slice"));
}

TEST(Table, AnUnknownKeyListsTheKnownOnes) {
  try {
    table_plan("FG87");
    FAIL();
  } catch (const UserError& e) {
    EXPECT_STREQ("FG87: there is no such table: known are all, FG86, FGHS85, MO95", e.what());
  }
}

/// What grouped_table() needs when nothing is run.
struct NoRuns {
  Catalogue catalogue = fake::catalogue();
  TableOptions options;
  RunCache cache;
  TableContext context{catalogue, options, cache, nullptr};
};

TEST(GroupedTable, AGroupThatThrowsLosesItsRowsFiguresAndSaysWhyTheOthersStay) {
  const auto good = [](const TableContext&, std::vector<TableRow>& rows) { set_single(rows[0], 3); };
  const auto bad = [](const TableContext&, std::vector<TableRow>& rows) {
    set_single(rows[0], 5);
    throw UserError("--set", 0, "half_space.depth_bits", "12 is outside the allowed 6..8");
  };
  const PaperTable table =
      grouped_table("X", "",
                    {{"refused", {claim("X-2", "two", "s", 1.0), claim("X-3", "three", "s")}, bad},
                     {"", {claim("X-1", "one", "s", 3.0)}, good}},
                    {});
  EXPECT_EQ(std::vector<std::string>{"X-2, 3: refused"}, table.plan);
  const std::vector<TableRow> rows = table.make(NoRuns().context);
  ASSERT_EQ(3u, rows.size());
  EXPECT_EQ(3.0, *rows[0].simulated);
  EXPECT_TRUE(rows[0].inside());
  for (std::size_t i : {1u, 2u}) {
    EXPECT_FALSE(rows[i].simulated || rows[i].low || rows[i].high);
    EXPECT_EQ("no figure: --set: half_space.depth_bits: 12 is outside the allowed 6..8", rows[i].note);
  }
  EXPECT_EQ(1.0, *rows[1].published);
}

TEST(GroupedTable, RowsAreInTheOrderOfTheirClaimsNumbers) {
  const auto fill = [](const TableContext&, std::vector<TableRow>& rows) {
    for (TableRow& row : rows) set_single(row, 0);
  };
  const PaperTable table = grouped_table(
      "AB86", "",
      {{"", {claim("AB86-P1", "", ""), claim("AB86-A10b", "", ""), claim("AB86-A2", "", "")}, fill},
       {"", {claim("AB86-A10", "", ""), claim("AB86-A9b", "", ""), claim("AB86-A9a", "", "")}, fill}},
      {});
  std::string ids;
  for (const TableRow& row : table.make(NoRuns().context)) ids += row.id.substr(5) + " ";
  EXPECT_EQ("A2 A9a A9b A10 A10b P1 ", ids);
}

TEST(GroupedTable, OnlyGroupsOfWantedRowsAreMade) {
  const auto fill = [](const TableContext&, std::vector<TableRow>& rows) {
    for (TableRow& row : rows) set_single(row, 0);
  };
  const auto never = [](const TableContext&, std::vector<TableRow>&) { FAIL(); };
  const PaperTable table = grouped_table(
      "AB86", "",
      {{"", {claim("AB86-A1a", "", ""), claim("AB86-A2", "", ""), claim("AB86-A1b", "", "")}, fill},
       {"", {claim("AB86-A10", "", ""), claim("AB86-A3", "", "")}, never}},
      {});
  NoRuns none;
  none.options.rows = {"AB86-A1"};
  std::string ids;
  for (const TableRow& row : table.make(none.context)) ids += row.id.substr(5) + " ";
  EXPECT_EQ("A1a A1b ", ids);
}

TEST(TableText, WritesCountsInFullAndTimesWithFourDigits) {
  const std::string text =
      table_text({row(6291456, 6291456, 6291456, 6291456), row(12.5, 13.6789, 10.20123, 23.2)});
  EXPECT_NE(std::string::npos, text.find("6291456 .. 6291456")) << text;
  EXPECT_NE(std::string::npos, text.find("13.68")) << text;
  EXPECT_NE(std::string::npos, text.find("10.2 .. 23.2")) << text;
}

/// Pixels of a colour.
int count(const scene::RgbImage& image, int red, int green, int blue) {
  int found = 0;
  for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3)
    found += image.rgb[i] == red && image.rgb[i + 1] == green && image.rgb[i + 2] == blue;
  return found;
}

TEST(TablePicture, BarsAreGreenWhereThePublishedFigureIsInsideAndRedElsewhere) {
  TableRow inside = row(10, 12, 8, 16), outside = row(10, 25, 20, 40);
  inside.id = "X-1", outside.id = "X-2";
  const auto green = draw_table({inside}), red = draw_table({outside}), both = draw_table({inside, outside});
  ASSERT_TRUE(green && red && both);
  EXPECT_GT(count(*green, 44, 140, 60), 500);
  EXPECT_EQ(0, count(*green, 214, 39, 40));
  EXPECT_GT(count(*red, 214, 39, 40), 500);
  EXPECT_EQ(0, count(*red, 44, 140, 60));
  EXPECT_GT(both->height, green->height);
}

TEST(TablePicture, LeavesOutRowsThatAreEqualHaveNoFigureOrNoRatio) {
  TableRow equal = row(3, 3, 3, 3), zero = row(0, 1, 1, 2), open;
  open.published = 4;
  EXPECT_FALSE(draw_table({equal, zero, open}));
  EXPECT_FALSE(draw_table({}));
}

}  // namespace
}  // namespace dendro::study
