#include "sim/config/parameters.h"

#include <gtest/gtest.h>

#include <functional>

#include "sim/base/error.h"

namespace dendro::config {
namespace {

Parameter parameter(const std::string& key, Value value, const std::string& source = "FG86 6.1") {
  Parameter p;
  p.key = key;
  p.value = std::move(value);
  p.source = source;
  p.where = {"preset.toml", 7};
  return p;
}

Parameter assumed(const std::string& key, Value value, const std::string& deviation, double low,
                  double high) {
  Parameter p = parameter(key, std::move(value), "ASSUMED " + deviation);
  p.spread = Spread{low, high, {}, false};
  return p;
}

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const UserError& error) {
    return error.what();
  }
  return "no error";
}

ParameterSet example() {
  ParameterSet set;
  set.add(parameter("processor.tick_ns", 200.0));
  set.add(assumed("memory.read_ticks", std::int64_t{4}, "DEV-003", 3, 6));
  Parameter mode = parameter("video.mode", std::int64_t{0}, "ASSUMED DEV-004");
  mode.spread =
      Spread{{}, {}, {Value(std::string("blanked")), Value(std::int64_t{0}), Value(std::int64_t{1})}, false};
  set.add(mode);
  Parameter tied = parameter("host.other_ticks", std::int64_t{4}, "ASSUMED DEV-005");
  tied.follows = "memory.read_ticks";
  set.add(tied);
  return set;
}

TEST(ParameterSet, AnIntegerServesAsAReal) {
  ParameterSet set = example();
  set.set("processor.tick_ns", std::int64_t{150}, {"--set", 0});
  EXPECT_EQ(Value(150.0), set.find("processor.tick_ns")->value);
}

TEST(ParameterSet, ARealDoesNotServeAsAnInteger) {
  ParameterSet set = example();
  EXPECT_EQ("scene.toml:3: memory.read_ticks: 4.5 is not an integer, as this parameter is", error_of([&] {
              set.set("memory.read_ticks", 4.5, {"scene.toml", 3});
            }));
  EXPECT_EQ(Value(std::int64_t{4}), set.find("memory.read_ticks")->value);
}

TEST(ParameterSet, AnUnknownKeyNamesTheNearestOne) {
  ParameterSet set = example();
  EXPECT_EQ("--set: memory.read_tics: the machine has no such parameter; did you mean `memory.read_ticks`?",
            error_of([&] {
              set.set("memory.read_tics", std::int64_t{4}, {"--set", 0});
            }));
}

TEST(ParameterSet, AValueOutsideTheIntervalIsAWhatIf) {
  ParameterSet set = example();
  set.set("memory.read_ticks", std::int64_t{9}, {"--set", 0});
  EXPECT_EQ(Value(std::int64_t{9}), set.find("memory.read_ticks")->value);
}

TEST(ParameterSet, AValueThatIsNoChoiceIsAnError) {
  ParameterSet set = example();
  EXPECT_EQ("--set: video.mode: 3 is none of its choices: \"blanked\", 0, 1", error_of([&] {
              set.set("video.mode", std::int64_t{3}, {"--set", 0});
            }));
}

TEST(ParameterSet, AFollowerTakesTheValueUnlessItWasSetItself) {
  ParameterSet set = example();
  set.set("memory.read_ticks", std::int64_t{6}, {"--set", 0});
  EXPECT_EQ(Value(std::int64_t{6}), set.find("host.other_ticks")->value);
  set.set("host.other_ticks", std::int64_t{2}, {"--set", 0});
  set.set("memory.read_ticks", std::int64_t{3}, {"--set", 0});
  EXPECT_EQ(Value(std::int64_t{2}), set.find("host.other_ticks")->value);
}

TEST(ParameterSet, WhatTheUserSetIsNoAssumptionAnyMore) {
  ParameterSet set = example();
  EXPECT_EQ((std::set<std::string>{"DEV-003", "DEV-004", "DEV-005"}), set.assumptions());
  set.set("video.mode", std::string("blanked"), {"/a/b/scene.toml", 12});
  EXPECT_EQ((std::set<std::string>{"DEV-003", "DEV-005"}), set.assumptions());
  EXPECT_EQ("what-if: scene.toml:12", set.find("video.mode")->source);
}

TEST(ParameterReader, AMissingParameterIsNamed) {
  const ParameterSet set = example();
  ParameterReader reader(set);
  EXPECT_NE(std::string::npos,
            error_of([&] { reader.real("processor.tock_ns", 0, 1); }).find("processor.tock_ns"));
}

TEST(ParameterReader, AnImpossibleValueIsAnErrorAtItsPlace) {
  const ParameterSet set = example();
  ParameterReader reader(set);
  EXPECT_EQ("preset.toml:7: memory.read_ticks: 4 is impossible, allowed are 5 to 9",
            error_of([&] { reader.integer("memory.read_ticks", 5, 9); }));
  EXPECT_EQ(4, reader.integer("memory.read_ticks", 4, 4));
}

TEST(ParameterReader, AChoiceMayBeANumberOrAWord) {
  ParameterSet set = example();
  EXPECT_EQ("0", ParameterReader(set).choice("video.mode", {"blanked", "0", "1"}));
  set.set("video.mode", std::string("blanked"), {"--set", 0});
  EXPECT_EQ("blanked", ParameterReader(set).choice("video.mode", {"blanked", "0", "1"}));
}

TEST(ParameterReader, AParameterThatNobodyReadIsAnError) {
  const ParameterSet set = example();
  ParameterReader reader(set);
  reader.real("processor.tick_ns", 0, 1e9);
  reader.integer("memory.read_ticks", 0, 9);
  reader.choice("video.mode", {"0"});
  EXPECT_NE(std::string::npos, error_of([&] { reader.finish(); }).find("host.other_ticks"));
  reader.integer("host.other_ticks", 0, 9);
  EXPECT_NO_THROW(reader.finish());
}

TEST(ValueText, ReadsBackAsTheSameValue) {
  EXPECT_EQ("200.0", to_text(200.0));
  EXPECT_EQ("0.1", to_text(0.1));
  EXPECT_EQ("1e+300", to_text(1e300));
  EXPECT_EQ("-3", to_text(std::int64_t{-3}));
  EXPECT_EQ("\"a\\\"b\\\\\"", to_text(std::string("a\"b\\")));
  EXPECT_EQ("true", to_text(true));
}

}  // namespace
}  // namespace dendro::config
