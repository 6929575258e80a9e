#include <gtest/gtest.h>

#include "tests/cli/cli.h"

namespace dendro::cli {
namespace {

using TraceCommands = CommandTest;

const char* const kProgram =
    "scratch result[1];\nreg n = r0;\nentry start;\nstart:\n  n = 0;\n  bus_address = 0;\n"
    "  for 5 { n = n + 1; bus_data = n, write lores; }\n  read lores;\n  n = bus;\n  result[0] = n;\n  halt;\n";

const char* const kTrace =
    "dendro-trace 1\nmachine rds3000:fg86\nboundary rds3000.frame_memory\n"
    "@0 write 0x10 0x7 fn=2 -> +1 wait=0\n@1 read 0x10 fn=2 -> +5 0x7 wait=1\n";

TEST_F(TraceCommands, WhatWasRecordedReplaysInBothFormsAndAtBothLevels) {
  write("p.gia", kProgram);
  for (const std::string boundary : {"frame_memory", "processor", "host"}) {
    const std::string words = "record --exec rds3000 p.gia --boundary rds3000." + boundary + " --out ";
    EXPECT_EQ(0, dendro(words + "a.trace").status);
    EXPECT_EQ(0, dendro(words + "a.txt --text").status);
    for (const std::string name : {"a.trace", "a.txt"}) {
      EXPECT_EQ(0, dendro("replay " + name).status) << boundary << " " << name;
      EXPECT_EQ(0, dendro("replay " + name + " --level clocked").status) << boundary << " " << name;
    }
    const Result packed = dendro("replay a.trace --print"), text = dendro("replay a.txt --print");
    EXPECT_EQ(packed.out, text.out);
    write("b.txt", packed.out);
    EXPECT_EQ(packed.out, dendro("replay b.txt --print").out) << "what --print gives is a trace again";
  }
}

TEST_F(TraceCommands, APictureShowsTheOperationsOverTime) {
  write("t.txt", kTrace);
  write("p.gia", kProgram);
  ASSERT_EQ(0, dendro("record --exec rds3000 p.gia --boundary rds3000.processor --out p.trace").status);
  for (const std::string name : {"t.txt", "p.trace"}) {
    EXPECT_EQ(0, dendro("replay " + name + " --quiet --picture " + name + ".png").status);
    EXPECT_EQ(0u, read(name + ".png").find("\x89PNG"));
  }
  EXPECT_NE(read("t.txt.png"), read("p.trace.png"));
  expect_user_error("replay t.txt --picture nowhere/p.png", "nowhere/p.png: cannot write here: ");
}

TEST_F(TraceCommands, AReplayReportsItsUnitAndCounts) {
  write("t.txt", kTrace);
  const auto json = nlohmann::json::parse(dendro("replay t.txt --json -").out);
  EXPECT_EQ("rds3000.frame_memory", json.at("unit"));
  EXPECT_EQ(2, json.at("transactions"));
  EXPECT_EQ(0, json.at("differences"));
  EXPECT_TRUE(json.at("first_difference").is_null());
  EXPECT_EQ(6, json.at("cycles"));
}

TEST_F(TraceCommands, TheFirstDifferenceIsExplainedAndExitsWithOne) {
  write("t.txt", kTrace);
  const Result result = dendro("replay t.txt --set frame_memory.card_busy_ticks=5 --json out.json");
  EXPECT_EQ(1, result.status);
  EXPECT_EQ("dendro: t.txt:5: the read of 0x10 that asked at tick 1: ticks it waited for its cards: 4, the trace says 1\n",
            result.err);
  const auto json = nlohmann::json::parse(read("out.json"));
  EXPECT_EQ(1, json.at("differences"));
  EXPECT_NE(std::string::npos, json.at("first_difference").get<std::string>().find("t.txt:5:"));
}

TEST_F(TraceCommands, BadTracesAreOneLine) {
  write("p.gia", kProgram);
  ASSERT_EQ(0, dendro("record --exec rds3000 p.gia --boundary rds3000.host --out good.trace").status);
  const std::string good = read("good.trace");
  write("cut.trace", good.substr(0, good.size() / 2));
  std::string bytes = good;
  bytes[bytes.size() - 100] = static_cast<char>(bytes[bytes.size() - 100] ^ 1);
  write("rotten.trace", bytes);
  write("newer.trace", "dendro-trace 2" + good.substr(14));
  write("picture.trace", "PNG");
  const std::string head = "dendro-trace 1\nmachine rds3000:fg86\n";
  write("boundary.txt", head + "boundary rds3000.bus\n@0 read 1\n");
  write("machine.txt", "dendro-trace 1\nmachine zx81\nboundary rds3000.bus\n@0 read 1\n");
  write("preset.txt", "dendro-trace 1\nmachine rds3000:zx81\nboundary rds3000.host\n+0 end -> @0\n");
  write("set.txt", head + "boundary rds3000.host\nset processor.tick_sn 3\n+0 end -> @0\n");
  write("entry.txt", head + "boundary rds3000.host\nparameter processor.tick_ns { value = \n+0 end -> @0\n");
  write("few.txt", head + "boundary rds3000.host\nparameter processor.tick_ns { value = 200.0, source = \"X\" }\n+0 end -> @0\n");
  write("none.txt", head + "boundary rds3000.host\n");
  write("op.txt", head + "boundary rds3000.host\n+0 fly\n");
  write("half.txt", head + "boundary rds3000.host\n+0 dma_to 0x820000 count=2\n+0 bus_write 0x820000 1\n");
  write("address.txt", head + "boundary rds3000.frame_memory\n@0 read 0x820000\n");
  write("far.txt", head + "boundary rds3000.frame_memory\n@999999999999999999 read 0\n");
  const std::pair<const char*, const char*> cases[] = {
      {"absent.trace", "absent.trace: cannot read the file"},
      {"cut.trace", "cut.trace: is truncated"},
      {"rotten.trace", "rotten.trace: is corrupt"},
      {"newer.trace", "newer.trace:1: was written by a newer dendro"},
      {"picture.trace", "picture.trace: is no trace"},
      {"boundary.txt", "boundary.txt:3: boundary: rds3000 has no boundary `rds3000.bus`: rds3000.frame_memory"},
      {"machine.txt", "machine.txt:2: machine: there is no machine `zx81`"},
      {"preset.txt", "preset.txt:2:"},
      {"set.txt", "set.txt:4: processor.tick_sn"},
      {"entry.txt", "entry.txt:4: processor.tick_ns"},
      {"few.txt", "multiply_ticks"},
      {"none.txt", "none.txt: has no records"},
      {"op.txt", "op.txt:4: rds3000.host has no operation `fly`"},
      {"half.txt", "half.txt:4: the trace ends in the middle of this `dma_to`"},
      {"address.txt", "address.txt:4: 0x820000 is no address of image memory"},
      {"far.txt", "far.txt:4:"}};
  for (const auto& [file, wanted] : cases) expect_user_error(std::string("replay ") + file, wanted);
  expect_user_error("replay good.trace --level function", "--level: a trace says when things happen");
  expect_user_error("replay good.trace --set processor.tick_sn=3", "--set: processor.tick_sn");
}

TEST_F(TraceCommands, BadRecordingsAreOneLineAndLeaveNoFile) {
  write("p.gia", kProgram);
  expect_user_error("record --exec rds3000 p.gia --boundary rds3000.bus --out a", "--boundary: rds3000 has no boundary");
  expect_user_error("record --boundary rds3000.host --out a", "give a scene, or --exec MACHINE PROGRAM");
  expect_user_error("record icosahedron --exec rds3000 p.gia --boundary rds3000.host --out a", "give a scene, or --exec");
  expect_user_error("record --exec rds3000 p.gia --boundary rds3000.host --out a --from 9 --to 9", "--to: the window ends");
  expect_user_error("record --exec rds3000 p.gia --boundary rds3000.host --out a --from 999999999999", "nothing passes");
  expect_user_error("record --exec rds3000 p.gia --boundary rds3000.host --out no/such/folder/a", "no/such/folder");
}

}  // namespace
}  // namespace dendro::cli
