#include <unistd.h>

#include <tuple>

#include "tests/cli/cli.h"

namespace dendro::cli {
namespace {

using nlohmann::json;

class Sweep : public CommandTest {
 protected:
  Sweep() { write("s.toml", scene_with("solid = \"icosahedron\"\n")); }

  static std::string study(const std::string& axis, const std::string& more = "") {
    return "scene = \"s.toml\"\n" + more + "[[axis]]\n" + axis;
  }
};

const char* const kReadTicks = "key = \"parameters.frame_memory.read_ticks\"\nvalues = [2, 4, 8]\n";

TEST_F(Sweep, WritesTableDatabaseAndPictureAndGoesOnWhereItStopped) {
  write("a.toml", study(kReadTicks));
  const Result first = dendro("sweep a.toml --out r --json first.json");
  ASSERT_EQ(0, first.status) << first.err;
  EXPECT_EQ("", first.err) << "no progress into a pipe";
  for (const char* file : {"r/results.sqlite", "r/results.csv", "r/seconds.png"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / file)) << file;
  const json o = json::parse(read("first.json"));
  EXPECT_EQ(1, o["schema"]);
  EXPECT_EQ("sweep", o["command"]);
  EXPECT_EQ(3, o["made"]);
  EXPECT_EQ("none", o["rows"][0]["git"]) << "the folder of a test lies in no repository";
  EXPECT_LT(o["rows"][0]["outputs"]["seconds"], o["rows"][2]["outputs"]["seconds"]);

  const std::string csv = read("r/results.csv");
  ASSERT_EQ(0, dendro("sweep a.toml --out r --quiet --json again.json").status);
  const json again = json::parse(read("again.json"));
  EXPECT_EQ(0, again["made"]);
  EXPECT_EQ(3, again["found"]);
  EXPECT_EQ(o["rows"], again["rows"]);
  EXPECT_EQ(csv, read("r/results.csv"));
}

TEST_F(Sweep, ARowIsTheRunOfTheSameSettings) {
  write("a.toml", study("key = \"half_space.boxing\"\nvalues = [true, false]\n",
                        "seed = 5\noutputs = [\"cycles\", \"rds3000.processor.busy\"]\n"
                        "[set]\n\"parameters.processor.tick_ns\" = 100.0\n"));
  ASSERT_EQ(0, dendro("sweep a.toml --out r --quiet --json o.json").status);
  ASSERT_EQ(0, dendro("run s.toml --quiet --out run --seed 5 --set half_space.boxing=false --set "
                      "parameters.processor.tick_ns=100")
                   .status);
  const json row = json::parse(read("o.json"))["rows"][1], run = json::parse(read("run/stats.json"));
  EXPECT_EQ(run["cycles"].get<double>(), row["outputs"]["cycles"].get<double>());
  EXPECT_EQ(run["units"]["rds3000.processor"]["busy"].get<double>(),
            row["outputs"]["rds3000.processor.busy"].get<double>());
  EXPECT_EQ(5, row["seed"]);
}

TEST_F(Sweep, TheNumberOfWorkersChangesNothing) {
  write("a.toml", study(kReadTicks));
  ASSERT_EQ(0, dendro("sweep a.toml --out one --quiet --jobs 1").status);
  ASSERT_EQ(0, dendro("sweep a.toml --out four --quiet --jobs 4").status);
  EXPECT_EQ(read("one/results.csv"), read("four/results.csv"));
  EXPECT_EQ(read("one/seconds.png"), read("four/seconds.png"));
}

TEST_F(Sweep, EveryRowKnowsTheCommitItWasMadeAt) {
  write("a.toml", study(kReadTicks));
  const std::string git = "git -c user.name=t -c user.email=t@t -C '" + folder_.string() + "' ";
  ASSERT_EQ(0, std::system((git + "init -q && " + git + "add s.toml a.toml && " + git + "commit -qm x").c_str()));
  ASSERT_EQ(0, dendro("sweep a.toml --out '" + (base_ / "r").string() + "' --quiet --json ../o.json").status);
  const std::string clean = json::parse(read("../o.json"))["rows"][0]["git"];
  EXPECT_EQ(40u, clean.size()) << clean;
  write("s.toml", scene_with("solid = \"icosahedron\"\nat = [0.1, 0, 0]\n"));
  ASSERT_EQ(0, dendro("sweep a.toml --out '" + (base_ / "r").string() + "' --quiet --json ../o.json").status);
  EXPECT_EQ(clean + "-dirty", json::parse(read("../o.json"))["rows"][0]["git"]);
}

TEST_F(Sweep, WrongStudiesAreOneLineAndLeaveNothing) {
  write("unknown.toml", study("key = \"parameters.processor.tick_nss\"\nvalues = [1]\n"));
  expect_user_error("sweep unknown.toml", "unknown.toml:2: parameters.processor.tick_nss: ");
  write("empty.toml", study("key = \"parameters.processor.tick_ns\"\nvalues = []\n"));
  expect_user_error("sweep empty.toml", "the axis is empty");
  write("million.toml", study("key = \"seed\"\nfrom = 1\nto = 1000000\nstep = 1\n"));
  expect_user_error("sweep million.toml", "1,000,000 runs, more than 10,000; say --yes");
  write("broken.toml", "scene = \n");
  expect_user_error("sweep broken.toml", "broken.toml:1");
  expect_user_error("sweep nowhere.toml", "nowhere.toml");
  expect_user_error("sweep tick-tme", "did you mean `tick-time`?");
  expect_user_error("sweep", "study");
}

TEST_F(Sweep, ADatabaseThatCannotBeUsedIsOneLineAndStaysAsItIs) {
  write("a.toml", study(kReadTicks));
  std::filesystem::create_directory(folder_ / "text");
  write("text/results.sqlite", std::string(4096, 'x'));
  expect_user_error("sweep a.toml --out text", "no SQLite database");
  EXPECT_EQ(std::string(4096, 'x'), read("text/results.sqlite"));

  ASSERT_EQ(0, dendro("sweep a.toml --out old --quiet").status);
  std::string bytes = read("old/results.sqlite");
  bytes[63] = 99;  // the last byte of user_version
  write("old/results.sqlite", bytes);
  expect_user_error("sweep a.toml --out old", "of version 99, this dendro reads and writes version 1");
  EXPECT_EQ(bytes, read("old/results.sqlite"));

  write("file", "");
  expect_user_error("sweep a.toml --out file", "file: cannot write here");
}

TEST_F(Sweep, AFullDiskIsOneLineAndKeepsWhatWasThere) {
  write("a.toml", study(kReadTicks));
  write("b.toml", study("key = \"parameters.frame_memory.read_ticks\"\nfrom = 1\nto = 16\nstep = 1\n"));
  ASSERT_EQ(0, dendro("sweep a.toml --out r --quiet").status);
  // A limit on the size of files stands for the disk's; the signal is ignored so that the write fails. 512-byte blocks.
  const auto blocks = std::filesystem::file_size(folder_ / "r/results.sqlite") / 512 + 16;
  const std::string err = (base_ / "err").string();
  const std::string line = "cd '" + folder_.string() + "' && trap '' XFSZ && ulimit -f " + std::to_string(blocks) +
                           " && '" DENDRO "' sweep b.toml --out r --quiet 2>'" + err + "' </dev/null";
  const int status = std::system(line.c_str());
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(2, WEXITSTATUS(status));
  const std::string said = read("../err");
  EXPECT_NE(std::string::npos, said.find("cannot write here: the disk is full")) << said;
  EXPECT_EQ(1, std::count(said.begin(), said.end(), '\n')) << said;
  ASSERT_EQ(0, dendro("sweep a.toml --out r --quiet --json o.json").status);
  EXPECT_EQ(3, json::parse(read("o.json"))["found"]);
}

// The machine's answers at the ends of three axes, so that none of them is a parameter that does nothing.
TEST_F(Sweep, WhatAStudyVariesChangesTheRun) {
  for (const auto& [key, low, high] : {std::tuple("parameters.processor.multiply_ticks", "2", "32"),
                                       {"parameters.frame_memory.read_ticks", "1", "12"},
                                       {"parameters.host.program_load_s", "0.03", "10.0"},
                                       {"half_space.boxing", "true", "false"},
                                       {"parameters.processor.tick_ns", "50.0", "400.0"}}) {
    write("a.toml", "scene = \"icosahedron\"\n[set]\n\"image.width\" = 64\n\"image.height\" = 64\n[[axis]]\nkey = \"" +
                        std::string(key) + "\"\nvalues = [" + low + ", " + high + "]\n");
    ASSERT_EQ(0, dendro("sweep a.toml --out r --quiet --json o.json").status) << key;
    const json rows = json::parse(read("o.json"))["rows"];
    EXPECT_LT(rows[0]["outputs"]["seconds"], rows[1]["outputs"]["seconds"]) << key;
  }
}

TEST_F(Sweep, CurvesOrAMapAndNamesOfValuesInTheTable) {
  write("a.toml", study("key = \"half_space.boxing\"\nvalues = [true, false]\n[[axis]]\nkey = "
                        "\"parameters.processor.multiply_ticks\"\nvalues = [2, 8]\nnames = [\"16x16\", \"8x8\"]\n"));
  const Result result = dendro("sweep a.toml --out r --json o.json");
  ASSERT_EQ(0, result.status) << result.err;
  EXPECT_NE(std::string::npos, result.out.find("16x16"));
  EXPECT_NE(std::string::npos, read("r/results.csv").find("\n1,cycle,true,8,"));
  EXPECT_EQ((json{"16x16", "8x8"}), json::parse(read("o.json"))["axes"][1]["names"]);
  EXPECT_EQ(0u, read("r/seconds.png").find("\x89PNG"));
}

TEST_F(Sweep, TheListNamesEveryStudyThatShips) {
  const Result list = dendro("sweep --list");
  EXPECT_EQ(0, list.status);
  for (const char* name : {"tick-time", "bits-per-pixel", "read-ticks", "boxing", "multiplier-width", "control-store"})
    EXPECT_NE(std::string::npos, list.out.find(name)) << name;
}

}  // namespace
}  // namespace dendro::cli
