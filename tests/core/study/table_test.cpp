#include "sim/study/table.h"

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
    EXPECT_STREQ("FG87: there is no such table: known are all, FG86, FGHS85", e.what());
  }
}

}  // namespace
}  // namespace dendro::study
