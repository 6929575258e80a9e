#include "sim/stats/run_object.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace dendro::stats {
namespace {

using Json = nlohmann::json;

RunObject example() {
  RunObject run;
  run.scene = "a, \"b\"";
  run.algorithm = "half_space";
  run.machine = "rds3000";
  run.preset = "fg86";
  run.level = "cycle";
  run.seed = 7;
  run.cycles = 10;
  run.machine_cycles = 6;
  run.clock_hz = 5e6;
  run.seconds = 2e-6;
  run.phases = {{"load", 4, 0.8e-6, true}, {"scan", 6, 1.2e-6, false}};
  run.units = {
      {"rds3000.processor", {{"cycles", 10}, {"busy", 5}, {"stall_bus", 1}, {"idle", 4}, {"reads", 99}}}};
  run.image = {"out/image.png", 2, 1, "ab"};
  run.error = {"double", std::nullopt, 0.25, 1, 2, {{"wrong_pixels_far", 0}}};
  run.host = {0.5, 12, 2.4, 1000};
  run.elaborated = {"rds3000.processor"};
  run.assumptions = {"DEV-003"};
  run.marks = {{"mark_plane", 4}};
  return run;
}

TEST(RunObject, HasEveryKeyOfTheContract) {
  const Json json = Json::parse(to_json(example()));
  for (const char* key :
       {"schema", "command", "scene",    "algorithm", "machine",     "preset",       "level",
        "seed",   "cycles",  "clock_hz", "seconds",   "seconds_low", "seconds_high", "phases",
        "units",  "image",   "error",    "host",      "elaborated",  "assumptions"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(1, json["schema"]);
  EXPECT_EQ("run", json["command"]);
  EXPECT_TRUE(json["seconds_low"].is_null());
  EXPECT_TRUE(json["error"]["psnr_db"].is_null()) << "identical pictures";
  EXPECT_EQ("host", json["phases"][0]["where"]);
  EXPECT_EQ("machine", json["phases"][1]["where"]);
  EXPECT_EQ(5, json["units"]["rds3000.processor"]["busy"]);
}

TEST(RunObject, ReadsBackWhatItWrote) {
  RunObject run = example();
  run.seconds_low = 1.0 / 3;
  run.seconds_high = 4;
  run.error.psnr_db = 31.4;
  run.contributions = {{"host.x", 1, 2, "ASSUMED DEV-001"}};
  const std::string text = to_json(run);
  EXPECT_EQ(text, to_json(from_json(text)));
}

TEST(RunObject, CsvQuotesWhatNeedsIt) {
  const std::string csv = to_csv(example());
  EXPECT_NE(std::string::npos, csv.find("scene,\"a, \"\"b\"\"\"\n"));
  EXPECT_NE(std::string::npos, csv.find("rds3000.processor.stall_bus,1\n"));
  EXPECT_NE(std::string::npos, csv.find("phase.scan.cycles,6\n"));
}

TEST(SanityGate, LetsConsistentCountersPass) { check_sanity(example()); }

TEST(SanityGate, StopsAUnitWhoseTicksDoNotAddUp) {
  RunObject run = example();
  run.units[0].values[2].second = 2;
  EXPECT_EXIT(check_sanity(run), ::testing::ExitedWithCode(70), "busy \\+ stalls \\+ idle = 11, cycles = 10");
}

TEST(SanityGate, StopsPhasesThatDoNotAddUp) {
  RunObject run = example();
  run.phases[0].cycles = 3;
  EXPECT_EXIT(check_sanity(run), ::testing::ExitedWithCode(70), "phases add up to 9");
}

TEST(SanityGate, StopsMoreMachineTimeThanTime) {
  RunObject run = example();
  run.machine_cycles = 11;
  EXPECT_EXIT(check_sanity(run), ::testing::ExitedWithCode(70), "machine 11 of 10");
}

TEST(SanityGate, StopsAUnitThatIsListedTwice) {
  RunObject run = example();
  run.units.push_back(run.units[0]);
  EXPECT_EXIT(check_sanity(run), ::testing::ExitedWithCode(70), "twice");
}

TEST(Text, GroupsThousands) {
  EXPECT_EQ("0", grouped(0));
  EXPECT_EQ("999", grouped(999));
  EXPECT_EQ("1,000", grouped(1000));
  EXPECT_EQ("-60,123,456", grouped(-60123456));
}

TEST(RunObject, HasNoFiguresOfTimeAtLevelFunction) {
  RunObject run = example();
  run.level = "function";
  run.cycles = run.machine_cycles = 0;
  run.seconds = 0;
  run.phases.clear();
  run.units.clear();
  run.notes = {"a note"};
  const std::string text = to_json(run);
  const Json json = Json::parse(text);
  for (const char* key : {"cycles", "seconds", "seconds_low", "seconds_high", "machine_cycles"})
    EXPECT_TRUE(json.at(key).is_null()) << key;
  EXPECT_EQ(Json::array(), json.at("phases"));
  EXPECT_EQ(Json::object(), json.at("units"));
  EXPECT_EQ(text, to_json(from_json(text)));
  EXPECT_NE(std::string::npos, to_csv(run).find("\ncycles,\n"));
  EXPECT_NE(std::string::npos, to_summary(run).find("  note: a note\n"));
}

}  // namespace
}  // namespace dendro::stats
