#include <sstream>

#include "tests/cli/cli.h"

namespace dendro::cli {
namespace {

using nlohmann::json;
using Commands = CommandTest;

const char* const kProgram =
    "// Adds up 1 to 10.\nreg n = r0;\nreg sum = r1;\nscratch result[4] @ 0;\nentry start;\nstart:\n  n = "
    "10;\n"
    "  sum = 0;\nagain:\n  sum = sum + n;\n  n = n - 1 -> flags;\n  if (!zero) goto again;\n  result[0] = "
    "sum;\n  halt;\n";

TEST_F(Commands, ListsNameWhatThereIs) {
  for (const char* name : {"icosahedron", "aspen-hull", "bishop-hull"})
    EXPECT_NE(std::string::npos, dendro("scenes").out.find(name)) << name;
  EXPECT_NE(std::string::npos, dendro("machines").out.find("rds3000:big-store"));
  const std::string firmware = dendro("firmware").out;
  EXPECT_NE(std::string::npos, firmware.find("pack none"));
  EXPECT_NE(std::string::npos, firmware.find("pack full"));
}

TEST_F(Commands, MachinesPrintsEveryParameterWithValueRangeUnitAndSource) {
  const Result result = dendro("machines rds3000:fg86");
  ASSERT_EQ(0, result.status) << result.err;
  std::istringstream lines(result.out);
  bool found = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("frame_memory.read_ticks ") != 0) continue;
    found = true;
    EXPECT_NE(std::string::npos, line.find(" 4 "));
    EXPECT_NE(std::string::npos, line.find("3 to 6"));
    EXPECT_NE(std::string::npos, line.find("ticks  "));
    EXPECT_NE(std::string::npos, line.find("ASSUMED DEV-003"));
  }
  EXPECT_TRUE(found) << result.out;
}

TEST_F(Commands, ExecRunsAProgramAtEveryLevel) {
  write("p.gia", kProgram);
  ASSERT_EQ(0, dendro("asm rds3000 p.gia -o p.ucode").status);
  for (const char* level : {"function", "cycle", "clocked"}) {
    const Result result =
        dendro(std::string("exec rds3000 p.ucode --dump 0:2 --json o.json --level ") + level);
    ASSERT_EQ(0, result.status) << result.err;
    EXPECT_EQ("", result.err);
    EXPECT_NE(std::string::npos, result.out.find("scratch[0] = 0x00000037\nscratch[1] = 0x00000000\n"))
        << result.out;
    const json o = json::parse(read("o.json"));
    for (const char* key : {"schema", "command", "machine", "preset", "level", "cycles", "instructions",
                            "clock_hz", "seconds", "exit_code", "units", "host"})
      EXPECT_TRUE(o.contains(key)) << key;
    EXPECT_EQ(55, o["exit_code"]);
    EXPECT_EQ(level, o["level"]);
  }
}

TEST_F(Commands, DisassemblyAssemblesToTheSameProgram) {
  write("p.gia", kProgram);
  for (const char* pack : {"none", "full"}) {
    ASSERT_EQ(0, dendro(std::string("asm rds3000 p.gia -o p.ucode --listing p.lst --pack ") + pack).status);
    EXPECT_FALSE(read("p.lst").empty());
    ASSERT_EQ(0, dendro("disasm rds3000 p.ucode -o q.gia").status);
    EXPECT_EQ(read("q.gia"), dendro("disasm rds3000 p.ucode").out);
    ASSERT_EQ(0, dendro("exec rds3000 q.gia --json o.json").status) << read("q.gia");
    EXPECT_EQ(55, json::parse(read("o.json"))["exit_code"]);
  }
}

TEST_F(Commands, AProgramMayHaveTheLineEndsOfAnotherSystem) {
  write("p.gia", kProgram);
  ASSERT_EQ(0, dendro("asm rds3000 p.gia -o p.ucode").status);
  std::string text;
  for (const char c : read("p.ucode")) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  write("p.ucode", text);
  const Result result = dendro("exec rds3000 p.ucode --dump 0 --quiet");
  EXPECT_EQ(0, result.status) << result.err;
  EXPECT_EQ("scratch[0] = 0x00000037\n", result.out);
}

TEST_F(Commands, LevelsComparesEveryLevelWithClocked) {
  write("s.toml", scene_with("solid = \"icosahedron\"\n"));
  const Result result = dendro("levels s.toml --out lv --json o.json");
  ASSERT_EQ(0, result.status) << result.err;
  EXPECT_EQ("", result.err);
  EXPECT_EQ(read("o.json"), read("lv/levels.json"));
  EXPECT_EQ(0u, result.out.find(read("lv/summary.txt")));
  const std::string csv = read("lv/levels.csv");
  EXPECT_EQ(5, std::count(csv.begin(), csv.end(), '\n'));
  EXPECT_EQ(0u, read("lv/levels.png").find("\x89PNG"));
  const json rows = json::parse(read("o.json"))["rows"];
  ASSERT_EQ(4u, rows.size());
  std::int64_t cycles = 0;
  for (const json& row : rows) {
    for (const char* key : {"level", "host_seconds", "cycles", "cycle_error", "interval", "image_psnr_db",
                            "different_pixels", "speed", "speedup_over_clocked", "skipped"})
      EXPECT_TRUE(row.contains(key)) << key;
    if (!row["skipped"].is_null()) continue;
    EXPECT_EQ(0, row["different_pixels"]) << row["level"];
    EXPECT_LT(0.0, row["speed"]) << row["level"];
    if (row["level"] == "function") {
      EXPECT_TRUE(row["cycles"].is_null() && row["cycle_error"].is_null() && row["interval"].is_null())
          << row;
      continue;
    }
    EXPECT_EQ(0.0, row["cycle_error"]) << row["level"];
    if (row["level"] == "cycle") cycles = row["cycles"].get<std::int64_t>();
    if (row["level"] == "clocked") {
      EXPECT_EQ(cycles, row["cycles"]);
    }
  }
  EXPECT_LT(0, cycles);
}

TEST_F(Commands, LevelsKeepsItsBudget) {
  write("s.toml", scene_with("solid = \"icosahedron\"\n"));
  ASSERT_EQ(0, dendro("levels s.toml --budget 0.000001 --json o.json").status);
  const json rows = json::parse(read("o.json"))["rows"];
  EXPECT_TRUE(rows.back()["skipped"].is_string());
  EXPECT_TRUE(rows.back()["cycles"].is_null());
}

TEST_F(Commands, LevelsWorksOnEverySceneThatShips) {
  std::istringstream scenes(dendro("scenes").out);
  int seen = 0;
  for (std::string line; std::getline(scenes, line); ++seen) {
    const std::string name = line.substr(0, line.find(' '));
    // Whole sets of views and films would take the first level minutes.
    const bool views = line.find("zbuffer_views") != std::string::npos;
    const char* const few =
        views ? " --set zbuffer_views.frames=1 --set zbuffer_views.view_width=32 --set zbuffer_views.view_height=64" : "";
    const Result result = dendro("levels " + name + few + " --budget 0.001 --out " + name);
    EXPECT_EQ(0, result.status) << name << result.err;
    const json rows = json::parse(read(name + "/levels.json"))["rows"];
    ASSERT_EQ(4u, rows.size());
    EXPECT_TRUE(rows[0]["skipped"].is_null()) << name;
    for (std::size_t i = 1; i < rows.size(); ++i) EXPECT_TRUE(rows[i]["skipped"].is_string()) << name;
    EXPECT_EQ(0u, read(name + "/levels.png").find("\x89PNG"));
  }
  EXPECT_LE(7, seen);
}

TEST_F(Commands, BenchMeasuresTheLevelAskedFor) {
  ASSERT_EQ(0, dendro("bench --level function --repeats 1 --json o.json").status);
  const json rows = json::parse(read("o.json"))["rows"];
  ASSERT_EQ(2u, rows.size());
  for (const char* key : {"machine", "level", "work", "simulated_hz", "real_time_factor"})
    EXPECT_TRUE(rows[0].contains(key)) << key;
  EXPECT_LT(0.0, rows[0]["simulated_hz"]);
}

// On a picture of 64x64 pixels the times mean nothing, but the rows, the cache and the exit statuses are the
// same.
TEST_F(Commands, TableHasItsRowsAndATolerance) {
  const std::string small = "table FG86 --set image.width=64 --set image.height=64 --json o.json";
  const Result result = dendro(small);
  ASSERT_EQ(0, result.status) << result.err;
  EXPECT_EQ("", result.err);
  EXPECT_EQ(0u, result.out.find("plan:\n"));
  const json rows = json::parse(read("o.json"))["rows"];
  std::map<std::string, json> by_id;
  for (const json& row : rows) {
    EXPECT_TRUE(by_id.emplace(row["id"], row).second) << row["id"];
    for (const char* key : {"id", "paper", "what", "unit", "published", "simulated", "low", "high", "ratio",
                            "inside", "assumptions", "reading", "note"})
      EXPECT_TRUE(row.contains(key)) << key;
    if (row["simulated"].is_null()) {
      EXPECT_NE("", row["note"]) << row["id"];
      continue;
    }
    EXPECT_LE(row["low"], row["simulated"]) << row["id"];
    EXPECT_GE(row["high"], row["simulated"]) << row["id"];
  }
  // Every claim of the paper has a row; what they are of the picture's size is not looked at.
  for (int claim = 1; claim <= 38; ++claim) {
    const std::string id = "FG86-A" + std::to_string(claim);
    EXPECT_TRUE(std::any_of(by_id.begin(), by_id.end(), [&](const auto& row) {
      return row.first == id ||
             (row.first.compare(0, id.size(), id) == 0 && std::isalpha(row.first[id.size()]));
    })) << id;
  }
  const std::pair<const char*, double> exact[] = {
      {"A1", 256},   {"A2a", 6291456}, {"A2b", 6291456}, {"A3", 400},     {"A4a", 32768},  {"A4b", 32768},
      {"A5a", 4},    {"A6", 512},      {"A11a", 48},     {"A13", 131072}, {"A14", 149796}, {"A15a", 17},
      {"A15b", 18},  {"A16a", 3},      {"A17", 1},       {"A20", 6},      {"A26a", 8},     {"A26b", 7},
      {"A27a", 100}, {"A27b", 50},     {"A27c", 20},     {"A29a", 80},    {"A29b", 96},    {"A31", 0}};
  for (const auto& [id, value] : exact) EXPECT_EQ(value, by_id["FG86-" + std::string(id)]["simulated"]) << id;

  const std::string first = read("o.json");
  EXPECT_EQ(3, dendro(small + " --tolerance 0.01").status) << "from the cache, and far outside";
  EXPECT_EQ(first, read("o.json"));
  EXPECT_EQ(0, dendro(small + " --tolerance 1e9 --out tab").status);
  EXPECT_EQ(first, read("tab/table.json"));
  EXPECT_EQ(0u, read("tab/table.png").find("\x89PNG"));
}

TEST_F(Commands, ASettingThatOnlySomeScenesTakeCostsTheTableOnlyTheRowsOfTheOthers) {
  const std::string small =
      "table FG86 --set image.width=64 --set image.height=64 --set half_space.depth_bits=10 --json o.json";
  const Result result = dendro(small);
  ASSERT_EQ(0, result.status) << result.err;
  std::map<std::string, json> by_id;
  const json rows = json::parse(read("o.json"))["rows"];
  for (const json& row : rows) by_id[row["id"]] = row;
  EXPECT_TRUE(by_id["FG86-A7a"]["simulated"].is_number());
  EXPECT_TRUE(by_id["FG86-A33a"]["simulated"].is_number());
  for (const char* id : {"FG86-A19a", "FG86-A33e", "FG86-A34a"}) {
    EXPECT_TRUE(by_id[id]["simulated"].is_null()) << id;
    EXPECT_NE(std::string::npos, by_id[id]["note"].get<std::string>().find("half_space.depth_bits")) << id;
  }
  expect_user_error("table FG86 --set half_space.depth_bit=10", "half_space.depth_bit");
  expect_user_error("table FG86 --set half_space.depth_bits=99", "half_space.depth_bits");
  expect_user_error("table FG86 --level function", "level with time");
}

TEST_F(Commands, HelpIsNoError) {
  EXPECT_EQ(0, dendro("--help").status);
  EXPECT_EQ(0, dendro("run --help").status);
  EXPECT_EQ("dendro 0.1.0\n", dendro("--version").out);
}

}  // namespace
}  // namespace dendro::cli
