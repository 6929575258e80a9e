#include "sim/config/preset.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "sim/base/embedded.h"
#include "sim/base/error.h"

namespace dendro::config {
namespace {

const base::EmbeddedFile kFirst{
    "machines/toy/first.toml",
    "description = \"as built\"\n"
    "[processor]\n"
    "tick_ns = { value = 200.0, source = \"FG86 6.1\" }\n"
    "[memory]\n"
    "read_ticks = { value = 4, range = [3, 6], source = \"ASSUMED DEV-003\" }\n"
    "tied_ticks = { follows = \"memory.read_ticks\", source = \"ASSUMED DEV-004\" }\n"};
const base::EmbeddedFile kSecond{"machines/toy/second.toml",
                                 "include = \"first.toml\"\n"
                                 "[memory]\n"
                                 "read_ticks = { value = 2, source = \"what the paper asks for\" }\n"};

const std::vector<MachinePresets> kMachines = {{"toy", "machines/toy", {"first", "second"}}};

class PresetFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) /
              ("preset_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  Preset load(const std::string& text) { return load_preset(write("p.toml", text), kMachines, {}); }
  /// The error without the folder, or "no error".
  std::string error(const std::string& text) {
    try {
      load(text);
    } catch (const UserError& e) {
      std::string what = e.what();
      for (std::size_t at; (at = what.find(folder_.string() + "/")) != std::string::npos;)
        what.erase(at, folder_.string().size() + 1);
      return what;
    }
    return "no error";
  }

  std::filesystem::path folder_;
};

TEST_F(PresetFile, ABuiltInPresetIsFoundByName) {
  const Preset preset = load_preset("toy", kMachines, {});
  EXPECT_EQ("first", preset.name);
  EXPECT_EQ("as built", preset.description);
  ASSERT_EQ(3u, preset.parameters.all().size());
  const Parameter* read = preset.parameters.find("memory.read_ticks");
  EXPECT_EQ(3.0, *read->spread->low);
  EXPECT_EQ(6.0, *read->spread->high);
  EXPECT_EQ(5, read->where.line);
}

TEST_F(PresetFile, LaterKeysOverrideIncludedOnesAndFollowersFollow) {
  const Preset preset = load_preset("toy:second", kMachines, {});
  EXPECT_EQ("toy", preset.machine);
  EXPECT_EQ("second", preset.name);
  EXPECT_EQ(Value(std::int64_t{2}), preset.parameters.find("memory.read_ticks")->value);
  EXPECT_EQ(Value(std::int64_t{2}), preset.parameters.find("memory.tied_ticks")->value);
  EXPECT_FALSE(preset.parameters.find("memory.read_ticks")->spread);
}

TEST_F(PresetFile, AFileMayIncludeABuiltInPreset) {
  const Preset preset =
      load("include = [\"toy:first\"]\n[processor]\ntick_ns = { value = 150.0, source = \"mine\" }\n");
  EXPECT_EQ("toy", preset.machine);
  EXPECT_EQ("p", preset.name);
  EXPECT_EQ(Value(150.0), preset.parameters.find("processor.tick_ns")->value);
}

TEST_F(PresetFile, AnUnknownMachineOrPresetIsAnErrorThatSaysWhatIsKnown) {
  EXPECT_THROW(load_preset("tory", kMachines, {}), UserError);
  try {
    load_preset("toy:third", kMachines, {"scene.toml", 2});
    FAIL();
  } catch (const UserError& e) {
    EXPECT_STREQ("scene.toml:2: machine: toy has no preset `third`: known are first, second", e.what());
  }
}

TEST_F(PresetFile, AMissingIncludeNamesTheChain) {
  write("a.toml", "include = \"gone.toml\"\n");
  EXPECT_EQ("a.toml:1: include: there is no file gone.toml: p.toml -> a.toml -> gone.toml",
            error("include = \"a.toml\"\n"));
}

TEST_F(PresetFile, ACyclicIncludeNamesTheChain) {
  write("a.toml", "\ninclude = [\"p.toml\"]\n");
  EXPECT_EQ("a.toml:2: include: the file includes itself: p.toml -> a.toml -> p.toml",
            error("include = \"a.toml\"\n"));
}

TEST_F(PresetFile, AnEntryWithoutSourceIsAnError) {
  EXPECT_EQ("p.toml:2: a.b: every entry needs a `source`: a document, or \"ASSUMED DEV-nnn\"",
            error("machine = \"toy\"\na.b = { value = 3 }\n"));
}

TEST_F(PresetFile, AnEntryWithoutValueIsAnError) {
  EXPECT_EQ("p.toml:2: a.b: the entry has no `value`",
            error("machine = \"toy\"\na.b = { source = \"x\" }\n"));
  EXPECT_EQ("p.toml:2: a.b: the entry has no `value`", error("machine = \"toy\"\na.b = {}\n"));
}

TEST_F(PresetFile, APlainValueIsNoEntry) {
  EXPECT_EQ(
      "p.toml:3: a.b: a parameter is written as { value, source }, or { value, range | choices, source }",
      error("machine = \"toy\"\n[a]\nb = 3\n"));
}

TEST_F(PresetFile, AnUnknownSubKeyNamesTheNearest) {
  EXPECT_EQ("p.toml:2: a.b: an entry has no `sorce`; did you mean `source`?",
            error("machine = \"toy\"\na.b = { value = 3, sorce = \"x\" }\n"));
}

TEST_F(PresetFile, ARangeContainsItsValue) {
  EXPECT_EQ("p.toml:2: a.b: the value 7 lies outside its range [3, 6]",
            error("machine = \"toy\"\na.b = { value = 7, range = [3, 6], source = \"ASSUMED DEV-001\" }\n"));
  EXPECT_EQ("no error",
            error("machine = \"toy\"\na.b = { value = 6, range = [3, 6], source = \"ASSUMED DEV-001\" }\n"));
}

TEST_F(PresetFile, AnAssumptionSaysHowFarItMayBeOffAndNamesItsDeviation) {
  EXPECT_EQ("p.toml:2: a.b: an assumed value needs a `range` or `choices` (or `follows` another parameter)",
            error("machine = \"toy\"\na.b = { value = 7, source = \"ASSUMED DEV-001\" }\n"));
  EXPECT_EQ("p.toml:2: a.b: an assumption must name its deviation: \"ASSUMED DEV-nnn\"",
            error("machine = \"toy\"\na.b = { value = 7, range = [3, 9], source = \"ASSUMED\" }\n"));
}

TEST_F(PresetFile, ADocumentedValueHasNoRange) {
  EXPECT_NE("no error", error("machine = \"toy\"\na.b = { value = 7, range = [3, 9], source = \"FG86\" }\n"));
}

TEST_F(PresetFile, ALogarithmicScaleNeedsAPositiveRange) {
  EXPECT_NE("no error",
            error("machine = \"toy\"\n"
                  "a.b = { value = 7, range = [0, 9], scale = \"log\", source = \"ASSUMED DEV-001\" }\n"));
  const Preset preset = load(
      "machine = \"toy\"\n"
      "a.b = { value = 7, range = [0.5, 9], scale = \"log\", source = \"ASSUMED DEV-001\" }\n");
  EXPECT_TRUE(preset.parameters.find("a.b")->spread->logarithmic);
  EXPECT_EQ(Value(7.0), preset.parameters.find("a.b")->value) << "a real range makes a real parameter";
}

TEST_F(PresetFile, FollowersInACircleAreAnError) {
  EXPECT_NE(std::string::npos, error("machine = \"toy\"\na.b = { follows = \"a.c\", source = \"x\" }\n"
                                     "a.c = { follows = \"a.b\", source = \"x\" }\n")
                                   .find("circle"));
}

TEST_F(PresetFile, AFollowerThatDisagreesIsAnError) {
  EXPECT_EQ("p.toml:3: a.c: the value 3 differs from a.b = 2, which it follows",
            error("machine = \"toy\"\na.b = { value = 2, source = \"x\" }\n"
                  "a.c = { value = 3, follows = \"a.b\", source = \"x\" }\n"));
}

TEST_F(PresetFile, BadTomlNamesFileAndLine) {
  EXPECT_EQ(0u, error("machine = \"toy\"\na.b = { value = = 3 }\n").find("p.toml:2: not valid TOML: "));
}

TEST_F(PresetFile, AnEntryIsWrittenSoThatItReadsBack) {
  const Preset preset = load_preset("toy", kMachines, {});
  for (const Parameter& p : preset.parameters.all()) {
    const Node document = parse_toml("entry = " + to_entry(p), "text");
    const Parameter again = read_parameter(p.key, *document.member("entry"));
    EXPECT_EQ(p.value, again.value) << p.key;
    EXPECT_EQ(p.source, again.source);
    EXPECT_EQ(p.follows, again.follows);
    EXPECT_EQ(p.spread.has_value(), again.spread.has_value());
    if (p.spread) {
      EXPECT_EQ(p.spread->low, again.spread->low);
      EXPECT_EQ(p.spread->high, again.spread->high);
    }
  }
}

TEST_F(PresetFile, ADamagedFileIsAUserErrorAndNothingElse) {
  const unsigned seed = 20821;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  const std::string good =
      "machine = \"toy\"\n[a]\nb = { value = 7, range = [0.5, 9], scale = \"log\", source = \"ASSUMED "
      "DEV-001\" }\n"
      "c = { value = \"x\", choices = [\"x\", 1], source = \"ASSUMED DEV-002\" }\n";
  int errors = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string text = good;
    for (int n = 0; n < 1 + static_cast<int>(random() % 3); ++n)
      text[random() % text.size()] = "\"={}[]. \n09azE-_#"[random() % 17];
    try {
      load(text);
    } catch (const UserError& e) {
      ++errors;
      EXPECT_EQ(std::string::npos, std::string(e.what()).find('\n')) << text;
    }
  }
  EXPECT_GT(errors, 500);
}

}  // namespace
}  // namespace dendro::config
