#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/firmware/mips/shell.h"

namespace dendro::mips {
namespace {

using Json = nlohmann::json;

Json exec_json(const std::string& program, const std::string& level, const std::string& options,
               const std::string& arguments, std::string& output) {
  const std::string json = scratch() + "/" + level + ".json";
  const Ran ran =
      run(model(elf(program), arguments, "--level " + level + " --json " + json + options) + " </dev/null");
  EXPECT_EQ("", ran.errors);
  output = ran.output;
  return Json::parse(read_file(json));
}

TEST(MipsClocked, ProgramsWriteAndCountWhatTheyDoWithoutTimeAndTakeCyclesClocks) {
  struct Case {
    const char *program, *arguments;
  };
  for (const Case& c : {Case{"hello", "one two"}, Case{"hello-unmapped", "x"}, Case{"maths", "30"}}) {
    std::string untimed, clocked, ignored;
    const Json a = exec_json(c.program, "function", "", c.arguments, untimed);
    const Json b = exec_json(c.program, "clocked", "", c.arguments, clocked);
    EXPECT_EQ(untimed, clocked) << c.program;
    EXPECT_FALSE(clocked.empty());
    EXPECT_EQ(a["instructions"], b["instructions"]) << c.program;
    EXPECT_GT(b["cycles"].get<std::int64_t>(), b["instructions"].get<std::int64_t>());
    EXPECT_EQ(b["units"].size(), 4u);
    const Json phases = b["phases"];
    std::int64_t together = 0;
    for (const Json& phase : phases) together += phase["cycles"].get<std::int64_t>();
    EXPECT_EQ(together, b["cycles"].get<std::int64_t>());
    EXPECT_EQ(phases, exec_json(c.program, "cycle", "", c.arguments, ignored)["phases"]);
  }
}

TEST(MipsClocked, AProgramsClocksFollowTheParameters) {
  std::string output;
  const auto cycles = [&](const std::string& options) {
    return exec_json("hello", "clocked", options, "", output)["cycles"].get<std::int64_t>();
  };
  const std::int64_t nominal = cycles("");
  EXPECT_EQ(nominal, cycles(""));
  EXPECT_LT(nominal, cycles(" --set memory.first_word_cycles=21"));
  EXPECT_LT(nominal, cycles(" --set instruction_cache.streaming=false"));
}

/// What a viewer reads out of a Kanata log: the stages of every word with the clocks in which they begin.
struct Log {
  struct Word {
    std::string text, stages;
    std::map<std::string, long> begins;
    long end = -1;
    bool flushed = false;
  };
  std::map<long, Word> words;
  long first = -1, clock = 0;
};

Log read_log(const std::string& path) {
  std::istringstream lines(read_file(path));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ("Kanata\t0004", line);
  Log log;
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    std::string command, rest;
    long id = 0, second = 0, third = 0;
    fields >> command >> id;
    if (command == "C=") log.first = log.clock = id;
    if (command == "C") {
      EXPECT_GT(id, 0);
      log.clock += id;
    }
    if (command == "I") {
      EXPECT_EQ(log.words.size(), static_cast<std::size_t>(id));
      log.words[id];
    }
    if (command == "C" || command == "C=") continue;
    EXPECT_TRUE(log.words.count(id)) << line;
    Log::Word& word = log.words[id];
    EXPECT_EQ(-1, word.end) << line;
    if (command == "L") {
      fields >> second;
      std::getline(fields, word.text);
    } else if (command == "S") {
      fields >> second >> rest;
      if (second == 0) word.stages += rest + " ", word.begins[rest] = log.clock;
    } else if (command == "R") {
      fields >> second >> third;
      word.end = log.clock, word.flushed = third != 0;
    }
  }
  return log;
}

TEST(MipsClocked, ThePipelineLogFollowsTheWordsOfItsWindow) {
  const std::string path = scratch() + "/pipeline.log";
  const Ran ran = run(model(elf("hello"), "",
                            "--level clocked --pipeline " + path + " --pipeline-from 300 --pipeline-to 500") +
                      " </dev/null");
  ASSERT_EQ(0, ran.status) << ran.errors;
  const Log log = read_log(path);
  ASSERT_GT(log.words.size(), 50u);
  EXPECT_GE(log.first, 300);
  int whole = 0;
  for (const auto& [id, word] : log.words) {
    EXPECT_GE(word.begins.at("IF"), 300);
    EXPECT_LT(word.begins.at("IF"), 500);
    EXPECT_GT(word.end, word.begins.at("IF")) << word.text;
    if (word.flushed) continue;
    ++whole;
    EXPECT_EQ("IF RD ALU MEM WB ", word.stages) << word.text;
    EXPECT_LT(word.begins.at("IF"), word.begins.at("RD"));
    EXPECT_LT(word.begins.at("MEM"), word.begins.at("WB"));
    EXPECT_NE(std::string::npos, word.text.find(": ")) << word.text;
  }
  EXPECT_GT(whole, 40);
}

TEST(MipsClocked, WaveformsShowTheWindow) {
  const std::string path = scratch() + "/wave.vcd";
  const Ran ran =
      run(model(elf("hello"), "", "--level clocked --vcd " + path + " --vcd-from 100 --vcd-to 140") +
          " </dev/null");
  ASSERT_EQ(0, ran.status) << ran.errors;
  const std::string text = read_file(path);
  for (const char* part :
       {"$timescale 1 ps", "module pipeline", "module registers", "module fpu", "module memory"})
    EXPECT_NE(std::string::npos, text.find(part)) << part;
  const auto first = text.find('#', text.find("$enddefinitions"));
  EXPECT_EQ("#2777778\n", text.substr(first, 9));  // clock 100 at 36 MHz
  EXPECT_EQ(std::string::npos, text.find("#3888889\n"));
}

TEST(MipsClocked, LogsAndWaveformsAreForClockedAlone) {
  const std::string path = scratch() + "/none";
  for (const std::string& options :
       {" --pipeline " + path, " --vcd " + path,
        " --level clocked --pipeline " + path + " --pipeline-from 5 --pipeline-to 5",
        std::string(" --level clocked --pipeline-from 5")}) {
    const Ran ran = run(model(elf("hello"), "", options) + " </dev/null");
    EXPECT_EQ(2, ran.status) << options;
    EXPECT_EQ(ran.errors.size() - 1, ran.errors.find('\n')) << options << ran.errors;
    EXPECT_EQ("", read_file(path));
  }
}

}  // namespace
}  // namespace dendro::mips
