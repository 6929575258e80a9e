#include "tests/cli/cli.h"

namespace dendro::cli {
namespace {

using json = nlohmann::json;

class Sgi4d35Trace : public CommandTest {
 protected:
  void SetUp() override {
    write("s.toml",
          "algorithm = \"zbuffer_views\"\nmachine = \"sgi-4d35\"\n[image]\nwidth = 24\nheight = 32\n[camera]\nheight = 3\n"
          "position = [3, 3, 9]\ntarget = [0, 1, 0]\n[[light]]\ndirection = [-1, -2, -1]\nambient = 0.3\n[[object]]\n"
          "tree = \"magnolia\"\nage = 6\nleaf_rows = 2\n[zbuffer_views]\nbands = 3\nview_width = 32\nview_height = 48\n");
  }
  json counters_of(const std::string& printed) const {
    json counters;
    std::istringstream words(printed.substr(printed.rfind(" counters -> ")));
    std::string word;
    while (words >> word)
      if (const std::size_t equals = word.find('='); equals != std::string::npos)
        counters[word.substr(0, equals)] = std::stoull(word.substr(equals + 1));
    return counters;
  }
};

TEST_F(Sgi4d35Trace, ASceneReplaysAtBothBoundariesAndLevelsAndCountsWhatTheRunCounts) {
  ASSERT_EQ(0, dendro("run s.toml --out o --json o.json --quiet").status);
  const json units = json::parse(read("o.json")).at("units");
  for (const std::string boundary : {"memory", "processor"}) {
    ASSERT_EQ(0, dendro("record s.toml --boundary sgi_4d35." + boundary + " --out a.trace").status);
    for (const std::string level : {"cycle", "clocked"}) {
      const Result result = dendro("replay a.trace --level " + level + " --json o.json");
      EXPECT_EQ(0, result.status) << boundary << " " << level << " " << result.err;
      EXPECT_LT(10000, json::parse(read("o.json")).at("transactions").get<int>());
    }
    const json counters = counters_of(dendro("replay a.trace --print").out);
    for (const std::string name : {"busy", "reads", "read_words", "writes", "page_writes", "overtaken"})
      EXPECT_EQ(units.at("sgi_4d35.memory").at(name), counters.at(name)) << boundary << " " << name;
    if (boundary == "memory") continue;
    for (const std::string cache : {"instruction", "data"}) {
      EXPECT_EQ(units.at("sgi_4d35." + cache + "_cache").at("busy"), counters.at(cache + "_accesses"));
      EXPECT_EQ(units.at("sgi_4d35." + cache + "_cache").at("misses"), counters.at(cache + "_misses"));
    }
  }
}

TEST_F(Sgi4d35Trace, AWindowIsTextThatIsATraceAgain) {
  const std::string record = "record s.toml --from 200000 --to 203000 --boundary sgi_4d35.";
  for (const std::string boundary : {"memory", "processor"}) {
    ASSERT_EQ(0, dendro(record + boundary + " --out w.trace").status);
    ASSERT_EQ(0, dendro(record + boundary + " --text --out w.txt").status);
    const std::string packed = dendro("replay w.trace --print").out;
    EXPECT_EQ(packed, dendro("replay w.txt --print").out);
    write("again.txt", packed);
    EXPECT_EQ(0, dendro("replay again.txt --level clocked").status);
    EXPECT_EQ(0, dendro("replay w.trace --quiet --picture p.png").status);
    EXPECT_EQ(boundary == "processor", packed.find(" set_instruction ") != std::string::npos);
  }
}

TEST_F(Sgi4d35Trace, AFaultyMemoryIsSeenAndExplainedAlikeAtBothLevels) {
  ASSERT_EQ(0, dendro("record s.toml --to 60000 --boundary sgi_4d35.memory --out m.trace").status);
  ASSERT_EQ(0, dendro("record s.toml --to 20000 --boundary sgi_4d35.processor --out p.trace").status);
  const auto difference = [&](const std::string& trace, const std::string& setting) {
    std::string first;
    for (const std::string level : {"cycle", "clocked"}) {
      const Result result = dendro("replay " + trace + " --set " + setting + " --level " + level);
      EXPECT_EQ(1, result.status) << setting << " " << level << result.err;
      EXPECT_EQ(first.empty() ? result.err : first, result.err) << "both levels say the same";
      first = result.err;
    }
    return first;
  };
  EXPECT_NE(std::string::npos, difference("m.trace", "memory.word_cycles=2").find("its last word is there at tick "));
  EXPECT_NE(std::string::npos, difference("m.trace", "memory.write_cycles=7").find(": clocks until memory has written it: "));
  EXPECT_NE(std::string::npos, difference("p.trace", "instruction_cache.refill_words=4").find("goes on at tick "));
  EXPECT_NE(std::string::npos, difference("p.trace", "data_cache.partial_store_cycles=2").find("the store of 0x"));
}

TEST_F(Sgi4d35Trace, ADamagedRecordIsSeenAtItsLine) {
  ASSERT_EQ(0, dendro("record s.toml --to 20000 --boundary sgi_4d35.memory --text --out m.txt").status);
  std::string text = dendro("replay m.txt --print").out;
  const std::size_t word = text.find(" w3=0x") + 6;
  text[word] = text[word] == '1' ? '2' : '1';
  write("d.txt", text);
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(word), '\n');
  for (const std::string level : {"cycle", "clocked"}) {
    const Result result = dendro("replay d.txt --level " + level);
    EXPECT_EQ(1, result.status);
    EXPECT_EQ(0u, result.err.find("dendro: d.txt:" + std::to_string(line) + ": w3 is 0x")) << result.err;
  }
}

TEST_F(Sgi4d35Trace, BadTracesAreOneLine) {
  ASSERT_EQ(0, dendro("record s.toml --to 20000 --boundary sgi_4d35.memory --out good.trace").status);
  const std::string good = read("good.trace");
  write("cut.trace", good.substr(0, good.size() - 900));
  std::string bytes = good;
  bytes[bytes.size() - 200] = static_cast<char>(bytes[bytes.size() - 200] ^ 4);
  write("rotten.trace", bytes);
  write("newer.trace", "dendro-trace 2" + good.substr(14));
  const auto write_trace = [&](const std::string& name, const std::string& boundary, const std::string& record) {
    write(name, "dendro-trace 1\nmachine sgi-4d35:4d35\nboundary sgi_4d35." + boundary + "\n" + record + "\n");
  };
  write_trace("block.txt", "memory", "@0 read 0x1004 words=4");
  write_trace("words.txt", "memory", "@0 read 0x1000 words=4 -> w4=0x0");
  write_trace("device.txt", "memory", "@0 read_uncached 0x1f000000 -> 0x0");
  write_trace("data.txt", "memory", "@0 write 0x1000");
  write_trace("page.txt", "memory", "@0 read 0x1000\n@9 set_page 0x1000");
  write_trace("odd.txt", "processor", "@0 fetch 0x1002");
  write_trace("size.txt", "processor", "@0 store 0x1002 0x1 size=3");
  write_trace("late.txt", "processor", "@0 load 0x1000\n@20 set_data 0x1000");
  write_trace("far.txt", "processor", "@0 load 0x100000000");
  const std::pair<const char*, const char*> cases[] = {
      {"cut.trace", "cut.trace: is truncated"},
      {"rotten.trace", "rotten.trace: is corrupt"},
      {"newer.trace", "newer.trace:1: was written by a newer dendro"},
      {"block.txt", "block.txt:4: a block is 1, 2, 4, 8, 16 or 32 words of main memory"},
      {"words.txt", "words.txt:4: the block has no w4"},
      {"device.txt", "device.txt:4: what a device answers is not memory's"},
      {"data.txt", "data.txt:4: `write` to main memory takes the word"},
      {"page.txt", "page.txt:5: `set_page` comes before everything else"},
      {"odd.txt", "odd.txt:4: 0x1002 is no address of a word"},
      {"size.txt", "size.txt:4: size 3 is not within 1 to 2"},
      {"late.txt", "late.txt:5: `set_data` comes before everything else"},
      {"far.txt", "far.txt:4: address 4294967296 is not within"}};
  for (const auto& [file, wanted] : cases) expect_user_error(std::string("replay ") + file, wanted);
  expect_user_error("record s.toml --boundary sgi_4d35.caches --out a", "sgi-4d35 has no boundary `sgi_4d35.caches`: sgi_4d35.memory, sgi_4d35.processor");
  expect_user_error("record s.toml --boundary sgi_4d35.memory --from 999999999999 --out a", "nothing passes sgi_4d35.memory");
  expect_user_error("record --exec sgi-4d35 s.toml --boundary sgi_4d35.memory --out a", "s.toml: ");
}

TEST_F(Sgi4d35Trace, AMemoryTraceFromElsewhereDrivesTheCaches) {
  write("m.din", "2 1000\n0 2000\n2 1004\n1 2004\n");
  for (const std::string level : {"cycle", "clocked"}) {
    const Result result = dendro("replay m.din --boundary sgi_4d35.processor --json m.json --level " + level);
    EXPECT_EQ(0, result.status) << result.err;
    EXPECT_EQ("sgi_4d35.processor level " + level + ": 4 accesses in 34 cycles\n"
              "  instruction cache: 2 accesses, 1 hits, 1 misses (50.00%)\n"
              "  data cache: 2 accesses, 1 hits, 1 misses (50.00%)\n"
              "  stall clocks: 31 (91.18%): instruction misses 11, data misses 20, partial stores 0, write buffer 0\n"
              "  memory: busy 94.12%: 2 reads of 12 words, 0 writes, 0 of them in the open page\n",
              result.out);
    const json object = json::parse(read("m.json"));
    EXPECT_EQ(4, object.at("transactions"));
    EXPECT_EQ(20, object.at("units").at("sgi_4d35.processor").at("stall_data_miss"));
  }
  EXPECT_NE(std::string::npos, dendro("replay m.din --boundary sgi_4d35.processor --set instruction_cache.streaming=false").out.find("instruction misses 18,"));
  write("wrong.txt", "1 r 0x10\n2 jump 0x10\n");
  expect_user_error("replay wrong.txt --boundary sgi_4d35.processor", "wrong.txt:2: `jump` is no operation");
  expect_user_error("replay m.din --boundary sgi_4d35.memory", "--boundary: `sgi_4d35.memory` takes no memory trace from elsewhere; those that do: sgi_4d35.processor");
  expect_user_error("replay m.din", "m.din: is no trace: it does not begin with `dendro-trace 1`");
  expect_user_error("replay absent.din --boundary sgi_4d35.processor", "absent.din: cannot read the file");
  expect_user_error("replay m.din --boundary sgi_4d35.processor --print", "--boundary: --print and --picture are of traces");
  expect_user_error("replay m.din --boundary sgi_4d35.processor --level function", "--level: a trace says when things happen");
  expect_user_error("replay m.din --boundary sgi_4d35.processor --set memory.word_cycles=0", "memory.word_cycles");
}

}  // namespace
}  // namespace dendro::cli
