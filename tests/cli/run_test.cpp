#include "tests/cli/cli.h"

namespace dendro::cli {
namespace {

using nlohmann::json;

class Run : public CommandTest {
 protected:
  /// The parts of a run object that must not differ between two runs of the same scene.
  static json repeatable(json object) {
    object.erase("host");
    object["image"].erase("path");
    return object;
  }
};

void expect_keys(const json& object, std::initializer_list<const char*> keys) {
  for (const char* key : keys) EXPECT_TRUE(object.contains(key)) << key;
}

TEST_F(Run, WritesAWholeRunDirectoryAndTheObjectOfTheContract) {
  write("m.obj", kTetrahedron);
  write("s.toml", scene_with("mesh = \"m.obj\"\n"));
  const Result result = dendro("run s.toml --out run --json o.json");
  ASSERT_EQ(0, result.status) << result.err;
  EXPECT_EQ("", result.err) << "no banner, no progress into a pipe";
  EXPECT_EQ((std::vector<std::string>{"m.obj", "o.json", "run", "run/image.exr", "run/image.png",
                                      "run/resolved.toml", "run/stats.csv", "run/stats.json",
                                      "run/summary.txt", "s.toml"}),
            names());
  EXPECT_EQ(result.out, read("run/summary.txt"));
  EXPECT_EQ(read("o.json"), read("run/stats.json"));
  const json o = json::parse(read("o.json"));
  expect_keys(o, {"schema", "command", "scene",    "algorithm", "machine",     "preset",       "level",
                  "seed",   "cycles",  "clock_hz", "seconds",   "seconds_low", "seconds_high", "phases",
                  "units",  "image",   "error",    "host",      "elaborated",  "assumptions"});
  expect_keys(o["image"], {"path", "width", "height", "sha256"});
  expect_keys(o["error"], {"reference", "psnr_db", "max_depth_error", "wrong_pixels", "covered_pixels"});
  expect_keys(o["host"], {"seconds", "simulated_hz", "real_time_factor", "peak_rss_bytes"});
  EXPECT_EQ("run/image.png", o["image"]["path"]);
  EXPECT_EQ(64, o["image"]["width"]);
  EXPECT_TRUE(o["seconds_low"].is_null());
  EXPECT_LT(0, o["error"]["covered_pixels"].get<int>());
  std::int64_t sum = 0;
  for (const json& phase : o["phases"]) {
    expect_keys(phase, {"name", "cycles", "seconds", "where"});
    sum += phase["cycles"].get<std::int64_t>();
  }
  EXPECT_EQ(o["cycles"], sum);
  for (const auto& [name, unit] : o["units"].items()) {
    std::uint64_t ticks = 0;
    for (const auto& [counter, value] : unit.items())
      if (counter == "busy" || counter == "idle" || counter.compare(0, 6, "stall_") == 0)
        ticks += value.get<std::uint64_t>();
    EXPECT_EQ(unit["cycles"], ticks) << name;
  }
}

TEST_F(Run, TheResolvedSceneRepeatsTheRunBitForBit) {
  write("m.obj", kTetrahedron);
  write("s.toml", scene_with("mesh = \"m.obj\"\n"));
  ASSERT_EQ(0, dendro("run s.toml --out first --quiet --set parameters.frame_memory.read_ticks=5").status);
  ASSERT_EQ(0, dendro("run first/resolved.toml --out second --quiet").status);
  EXPECT_EQ(repeatable(json::parse(read("first/stats.json"))),
            repeatable(json::parse(read("second/stats.json"))));
  EXPECT_EQ(read("first/image.png"), read("second/image.png"));
  EXPECT_EQ(read("first/image.exr"), read("second/image.exr"));
  EXPECT_EQ(std::string::npos, read("second/summary.txt").find("note:"));
  EXPECT_EQ(read("first/resolved.toml"), read("second/resolved.toml"));

  write("m.obj", std::string(kTetrahedron) + "# changed\n");
  expect_user_error("run first/resolved.toml --out third", "m.obj has changed");
}

TEST_F(Run, SaysThatAnotherBuildResolvedTheScene) {
  write("s.toml", scene_with("solid = \"icosahedron\"\n"));
  ASSERT_EQ(0, dendro("run s.toml --out first --quiet").status);
  std::string text = read("first/resolved.toml");
  const auto digest = text.find("dendro = \"") + 10;
  text[digest] = text[digest] == '0' ? '1' : '0';
  write("first/resolved.toml", text);
  const Result result = dendro("run first/resolved.toml --out second");
  EXPECT_EQ(0, result.status);
  EXPECT_EQ("", result.err);
  EXPECT_NE(std::string::npos, result.out.find("note: resolved by another build")) << result.out;
}

TEST_F(Run, ASlowerMultiplierDrawsTheSamePictureLater) {
  write("s.toml", scene_with("solid = \"icosahedron\"\n"));
  for (const char* pack : {"none", "full"}) {
    std::int64_t cycles = 0;
    std::string picture;
    for (const char* ticks : {"2", "3", "4"}) {
      const Result result =
          dendro(std::string("run s.toml --quiet --json - --set parameters.microcode.pack=") + pack +
                 " --set parameters.processor.multiply_ticks=" + ticks);
      ASSERT_EQ(0, result.status) << result.err;
      const json o = json::parse(result.out);
      EXPECT_LT(cycles, o["cycles"].get<std::int64_t>()) << pack << " " << ticks;
      cycles = o["cycles"].get<std::int64_t>();
      if (picture.empty()) picture = o["image"]["sha256"];
      EXPECT_EQ(picture, o["image"]["sha256"]) << pack << " " << ticks;
    }
  }
}

TEST_F(Run, QuietPrintsNothing) {
  write("s.toml", scene_with("solid = \"icosahedron\"\n"));
  const Result result = dendro("run s.toml --quiet");
  EXPECT_EQ(0, result.status);
  EXPECT_EQ("", result.out + result.err);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/s/image.png"));
}

TEST_F(Run, JsonOnStandardOutputIsNothingElse) {
  write("s.toml", scene_with("solid = \"icosahedron\"\n"));
  const Result result = dendro("run s.toml --quiet --json - --out run");
  EXPECT_EQ("s", json::parse(result.out)["scene"]);
}

TEST_F(Run, FunctionAndCycleDrawTheSamePicture) {
  write("s.toml", scene_with("solid = \"icosahedron\"\n"));
  ASSERT_EQ(0, dendro("run s.toml --out f --level function --quiet").status);
  ASSERT_EQ(0, dendro("run s.toml --out c --quiet").status);
  const json f = json::parse(read("f/stats.json")), c = json::parse(read("c/stats.json"));
  EXPECT_EQ(f["image"]["sha256"], c["image"]["sha256"]);
  for (const char* key : {"cycles", "seconds", "seconds_low", "machine_cycles"})
    EXPECT_TRUE(f[key].is_null()) << key;
  EXPECT_EQ(json::array(), f["phases"]);
  EXPECT_EQ(json::object(), f["units"]);
  EXPECT_LT(0, c["cycles"]);
}

TEST_F(Run, AnIntervalHoldsTheNominalTime) {
  write("s.toml", scene_with("solid = \"icosahedron\"\n"));
  const Result result = dendro("run s.toml --interval --out run --json o.json");
  ASSERT_EQ(0, result.status) << result.err;
  EXPECT_EQ("", result.err);
  const json o = json::parse(read("o.json"));
  EXPECT_LT(o["seconds_low"], o["seconds"]);
  EXPECT_GT(o["seconds_high"], o["seconds"]);
  ASSERT_FALSE(o["contributions"].empty());
  for (const json& c : o["contributions"]) {
    EXPECT_LE(o["seconds_low"], c["seconds_low"]) << c["key"];
    EXPECT_GE(o["seconds_high"], c["seconds_high"]) << c["key"];
  }
}

TEST_F(Run, AFasterClockIsFasterInProportion) {
  write("s.toml", scene_with("solid = \"icosahedron\"\n"));
  // Blanked, so that no video fetch, whose time is not counted in ticks, comes between.
  const std::string blanked = "run s.toml --quiet --set parameters.video.display_mode=blanked ";
  ASSERT_EQ(0, dendro(blanked + "--out a").status);
  ASSERT_EQ(0, dendro(blanked + "--set parameters.processor.tick_ns=100 --out b").status);
  const auto machine = [&](const std::string& file) {
    std::int64_t cycles = 0;
    for (const json& phase : json::parse(read(file))["phases"])
      if (phase["where"] == "machine") cycles += phase["cycles"].get<std::int64_t>();
    return cycles;
  };
  EXPECT_EQ(machine("a/stats.json"), machine("b/stats.json"));
  EXPECT_EQ(2.0, json::parse(read("b/stats.json"))["clock_hz"].get<double>() /
                     json::parse(read("a/stats.json"))["clock_hz"].get<double>());
}

TEST_F(Run, AWaveformIsWrittenAtClocked) {
  write("s.toml", scene_with("solid = \"icosahedron\"\n"));
  const Result result =
      dendro("run s.toml --level clocked --quiet --out run --vcd w.vcd --vcd-from 0 --vcd-to 200");
  ASSERT_EQ(0, result.status) << result.err;
  EXPECT_EQ("", result.out + result.err);
  EXPECT_NE(std::string::npos, read("w.vcd").find("$enddefinitions"));
}

}  // namespace
}  // namespace dendro::cli
