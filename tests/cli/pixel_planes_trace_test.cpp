#include "tests/cli/cli.h"

namespace dendro::cli {
namespace {

using PixelPlanesTrace = CommandTest;
using json = nlohmann::json;

const char* const kPrograms =
    "register f = 1;\nregister n = 2;\n"
    "program store phase scan { enable = 1; loop fraction { tree; } loop n { f[i] = tree; } }\n"
    "program below { enable = 1; carry = 0; loop n { carry = borrow(tree, f[i]); } enable = enable & carry; }\n";
const std::string kRecord =
    "record --exec pixel-planes p.igc f=8 n=6 store:1,-1,30.5:fraction=2 below:-1,0,20 n=3 store:0,1,1 "
    "--set array.width=64 --set array.height=64 --set host.program_load_ms=0.0 --boundary pixel_planes.";

TEST_F(PixelPlanesTrace, WhatWasRecordedReplaysInBothFormsAndAtBothLevels) {
  write("p.igc", kPrograms);
  for (const std::string boundary : {"commands", "array"}) {
    ASSERT_EQ(0, dendro(kRecord + boundary + " --out a.trace").status);
    ASSERT_EQ(0, dendro(kRecord + boundary + " --out a.txt --text").status);
    for (const std::string name : {"a.trace", "a.txt"})
      for (const std::string level : {"cycle", "clocked"})
        EXPECT_EQ(0, dendro("replay " + name + " --level " + level).status) << boundary << " " << name;
    const Result packed = dendro("replay a.trace --print"), text = dendro("replay a.txt --print");
    EXPECT_EQ(packed.out, text.out);
    write("b.txt", packed.out);
    EXPECT_EQ(packed.out, dendro("replay b.txt --print").out) << "what --print gives is a trace again";
    EXPECT_EQ(0, dendro("replay a.trace --quiet --picture p.png").status);
    const json object = json::parse(dendro("replay a.trace --json -").out);
    EXPECT_EQ("pixel_planes." + boundary, object["unit"]);
    EXPECT_EQ(0, object["differences"]);
    EXPECT_LT(10, object["transactions"].get<int>());
  }
}

TEST_F(PixelPlanesTrace, AScenesTraceHoldsItsCommandsAndCoefficients) {
  const std::string record = "record figure5 --machine pixel-planes --set image.width=64 --set image.height=64"
                             " --set parameters.array.width=64 --set parameters.array.height=64 --text --out a.txt --boundary ";
  ASSERT_EQ(0, dendro(record + "pixel_planes.commands").status);
  const std::string text = read("a.txt");
  EXPECT_NE(std::string::npos, text.find(" register "));
  EXPECT_NE(std::string::npos, text.find(" a=")) << "an expression";
  EXPECT_NE(std::string::npos, text.find(" idle -> @"));
  ASSERT_EQ(0, dendro(record + "pixel_planes.array").status);
  EXPECT_NE(std::string::npos, read("a.txt").find(" stream "));
  EXPECT_EQ(0, dendro("replay a.txt --level clocked").status);
}

TEST_F(PixelPlanesTrace, AFaultyMachineIsSeenAndExplained) {
  write("p.igc", kPrograms);
  ASSERT_EQ(0, dendro(kRecord + "commands --out c.trace").status);
  ASSERT_EQ(0, dendro(kRecord + "array --out a.trace").status);
  const auto difference = [&](const std::string& trace, const std::string& setting) {
    std::string first;
    for (const std::string level : {"cycle", "clocked"}) {
      const Result result = dendro("replay " + trace + " --set " + setting + " --level " + level + " --json o.json");
      EXPECT_EQ(1, result.status) << setting << " " << level << result.err;
      EXPECT_EQ(1, json::parse(read("o.json")).at("differences"));
      EXPECT_EQ(first.empty() ? result.err : first, result.err) << "both levels say the same";
      first = result.err;
    }
    return first;
  };
  const std::string translator = difference("c.trace", "translator.setup_clocks=7");
  EXPECT_NE(std::string::npos, translator.find("`program at word 0, fraction 2, guard 0, A 4, B -4, C 122`, offered from tick ")) << translator;
  EXPECT_NE(std::string::npos, translator.find("clocks until the controller takes it: ")) << translator;
  EXPECT_NE(std::string::npos, translator.find(", the trace says ")) << translator;
  const std::string width = difference("a.trace", "array.width=128");
  EXPECT_NE(std::string::npos, width.find("`enable = 1`, sent in clock ")) << width;
  const std::string gap = difference("a.trace", "tree.gap_clocks=1");
  EXPECT_NE(std::string::npos, gap.find("enabled pixels before clock ")) << gap;
  EXPECT_NE(std::string::npos, gap.find(", behind `enable = enable & carry` of line ")) << gap;
  const std::string memory = difference("c.trace", "array.memory_bits=71");
  EXPECT_NE(std::string::npos, memory.find("the digest of the memory, idle from tick ")) << memory;
}

TEST_F(PixelPlanesTrace, ADamagedRecordIsSeenAtItsLine) {
  write("p.igc", kPrograms);
  ASSERT_EQ(0, dendro(kRecord + "commands --out c.txt --text").status);
  std::string text = dendro("replay c.txt --print").out;
  const std::size_t c = text.find(" c=30.5");
  ASSERT_NE(std::string::npos, c);
  text.replace(c, 7, " c=34.5");
  write("d.txt", text);
  const Result result = dendro("replay d.txt");
  EXPECT_EQ(1, result.status);
  EXPECT_NE(std::string::npos, result.err.find("the digest of the memory")) << result.err;
  const std::size_t taken = text.find("taken=");
  text.insert(taken + 6, "1");
  write("d.txt", text);
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(taken), '\n');
  EXPECT_EQ(0u, dendro("replay d.txt").err.find("dendro: d.txt:" + std::to_string(line) + ": ")) << line;
}

TEST_F(PixelPlanesTrace, AWindowBeginsWithTheStateOfAnIdleMachine) {
  write("p.igc", kPrograms);
  const std::string slow = " --set host.word_ns=9000.0 --text --from 1850 --to 2200 --out w.txt";
  for (const std::string boundary : {"commands", "array"}) {
    ASSERT_EQ(0, dendro(kRecord + boundary + slow).status);
    const std::string text = read("w.txt");
    EXPECT_NE(std::string::npos, text.find("\nfrom 1850\n"));
    EXPECT_NE(std::string::npos, text.find(" set_memory 8 "));
    EXPECT_EQ(boundary == "commands", text.find(" set_control 0 ") != std::string::npos);
    for (const std::string level : {"cycle", "clocked"}) {
      EXPECT_EQ(0, dendro("replay w.txt --level " + level).status);
    }
  }
  expect_user_error(kRecord + "array --from 9 --to 9 --out w", "--to: the window ends before it begins");
  expect_user_error(kRecord + "array --from 999999 --out w", "nothing passes pixel_planes.array in this window of time");
}

TEST_F(PixelPlanesTrace, BadTracesAreOneLine) {
  write("p.igc", kPrograms);
  ASSERT_EQ(0, dendro(kRecord + "array --out good.trace").status);
  const std::string good = read("good.trace");
  write("cut.trace", good.substr(0, good.size() / 2));
  std::string bytes = good;
  bytes[bytes.size() - 100] = static_cast<char>(bytes[bytes.size() - 100] ^ 1);
  write("rotten.trace", bytes);
  write("newer.trace", "dendro-trace 2" + good.substr(14));
  expect_user_error("replay cut.trace", "cut.trace: is truncated");
  expect_user_error("replay rotten.trace", "rotten.trace: is corrupt");
  expect_user_error("replay newer.trace", "newer.trace:1: was written by a newer dendro");
  expect_user_error("replay good.trace --set array.width=100", "array.width: must be a power of two");
  expect_user_error("replay good.trace --set tree.masked=false", "tree.gap_clocks");
  const auto refused = [&](const std::string& boundary, const std::string& record, const std::string& wanted,
                           const std::string& level = "cycle") {
    write("t.txt", "dendro-trace 1\nmachine pixel-planes:pxpl4\nboundary pixel_planes." + boundary +
                       "\nset array.width 64\nset array.height 64\n" + record + "\n");
    expect_user_error("replay t.txt --level " + level, "t.txt:6: " + wanted);
  };
  for (const char* level : {"cycle", "clocked"}) {
    refused("array", "@28 word tree=1", "clock 28 is stolen by refresh or video", level);
    refused("commands", "@0 command entry=0", "the micro-program at word 0 of the control store has no end", level);
  }
  refused("array", "@0 word function=8", "function 8 is not within 0 to 7");
  refused("array", "@0 word x=3", "x: the controller sends a constant as 0 or 1");
  refused("array", "@0 word read_a=1 write_a=2", "read_a and write_a: a port takes one address a clock");
  refused("array", "@0 set_memory 72 0 1", "bit 72 is not within 0 to 71");
  refused("array", "@0 set_enable 63 1 count=2", "count 2 is not within 1 to 1");
  refused("array", "@0 pixel 4096", "pixel 4096 is not within 0 to 4095");
  refused("array", "@0 word tree=1.0", "`word` takes whole numbers here");
  refused("commands", "@0 command a=1", "a: a coefficient has a point, as 1.0");
  refused("commands", "@0 command a=1.0e", "`1.0e` is no number of single precision");
  refused("commands", "@0 register 16 1", "register 16 is not within 0 to 15");
  refused("commands", "@1 word 0x400000 -> taken=3", "it is not the last word of a command");
  refused("commands", "@0 store 0x800 1", "address 2048 is not within 0 to 2047");
  refused("commands", "@0 command entry=1024", "entry 1024 is not within 0 to 1023");
  refused("commands", "@0 command constant=1 at2=3", "at2: the command has 2 words");
}

}  // namespace
}  // namespace dendro::cli
