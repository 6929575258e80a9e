#include "tests/cli/cli.h"

namespace dendro::cli {
namespace {

using PixelPlanes = CommandTest;
using json = nlohmann::json;

TEST_F(PixelPlanes, RunsTheScenesOfTheFrameBuffer) {
  for (const char* scene : {"icosahedron", "figure5", "grove", "aspen-hull"}) {
    SCOPED_TRACE(scene);
    const json object = ran(std::string(scene) + " --machine pixel-planes");
    EXPECT_EQ("pixel-planes", object["machine"]);
    EXPECT_EQ("pxpl4", object["preset"]);
    EXPECT_LT(0, object["cycles"].get<std::int64_t>());
    EXPECT_LT(object["error"]["wrong_pixels"].get<double>(), object["error"]["covered_pixels"].get<double>() / 1000);
    const json array = object["units"]["pixel_planes.array"];
    EXPECT_LE(array["evaluated_pixel_operations"].get<double>(), array["pixel_operations"].get<double>());
  }
}

TEST_F(PixelPlanes, AResolvedRunRepeatsItself) {
  ASSERT_EQ(0, dendro("run figure5 --machine pixel-planes --set half_space.depth_bits=12 --out a --json a.json --quiet").status);
  const Result again = dendro("run a/resolved.toml --out b --json b.json --quiet");
  ASSERT_EQ(0, again.status) << again.err;
  const json a = json::parse(read("a.json")), b = json::parse(read("b.json"));
  EXPECT_EQ(a["cycles"], b["cycles"]);
  EXPECT_EQ(a["image"]["sha256"], b["image"]["sha256"]);
  EXPECT_EQ("pixel-planes", b["machine"]);
}

TEST_F(PixelPlanes, AnIntervalNamesTheAssumptionsThatWidenIt) {
  ASSERT_EQ(0, dendro("run figure5 --machine pixel-planes --interval --out o --json o.json --quiet").status);
  const json object = json::parse(read("o.json"));
  EXPECT_LT(object["seconds_low"].get<double>(), object["seconds"].get<double>());
  EXPECT_GT(object["seconds_high"].get<double>(), object["seconds"].get<double>());
}

TEST_F(PixelPlanes, ALargePictureIsDrawnInTilesByRenderersAtOnce) {
  std::int64_t last = INT64_MAX;
  std::string digest;
  for (const char* renderers : {"1", "4", "16"}) {
    SCOPED_TRACE(renderers);
    const json object = ran(std::string("grove --machine pixel-planes:pxpl5 --set parameters.host.program_load_ms=0") +
                            " --set parameters.renderers.count=" + renderers);
    EXPECT_EQ(0, object["error"]["wrong_pixels"]);
    EXPECT_EQ(16, object["facts"]["tiles"]);
    EXPECT_LT(object["cycles"].get<std::int64_t>(), last);
    last = object["cycles"].get<std::int64_t>();
    if (!digest.empty()) {
      EXPECT_EQ(digest, object["image"]["sha256"].get<std::string>());
    }
    digest = object["image"]["sha256"].get<std::string>();
    const std::string busiest = object["busiest"]["unit"];
    EXPECT_EQ(0u, busiest.rfind(renderers == std::string("16") ? "pixel_planes.host" : "pixel_planes.controller", 0)) << busiest;
  }
}

TEST_F(PixelPlanes, WhatDoesNotFitIsOneLine) {
  expect_user_error("run grove --machine pixel-planes:pxpl5 --set image.width=1300", "image.width: 1300 is more than the 1280 pixels of the frame buffer");
  expect_user_error("run grove --machine pixel-planes:pxpl5 --set parameters.frame_buffer.width=1000", "frame_buffer.width: must be whole tiles, 128 pixels each");
  expect_user_error("run grove --machine pixel-planes --set parameters.renderers.count=2", "renderers.count: the machine has no such parameter");
  const std::string run = "run icosahedron --machine pixel-planes --set ";
  expect_user_error(run + "half_space.depth_bits=17", "half_space.depth_bits: 3 registers of 17 bits and 24 further bits are 75 of a pixel; the memory has 72");
  expect_user_error(run + "half_space.variant=scratch", "half_space.variant: the scratch copy needs a memory with two ports");
  expect_user_error(run + "parameters.array.width=256", "image.width: 512 is more than the 256 pixels of the array");
  expect_user_error(run + "parameters.array.width=300", "array.width: must be a power of two");
  expect_user_error(run + "half_space.guard_bits=23", "half_space.guard_bits: 16 depth, 10 fraction and 23 guard bits do not fit a stream of 48 bits");
  expect_user_error(run + "parameters.array.ports=3", "array.ports");
  expect_user_error(run + "parameters.tree.masked=false", "tree.gap_clocks: without masks an expression runs into the next unless 8 clocks or more lie between");
  expect_user_error(run + "parameters.array.memory_bit=3", "did you mean `array.memory_bits`?");
  expect_user_error("run icosahedron --machine pixel-planes:pxpl6", "pxpl");
}

TEST_F(PixelPlanes, CommandsThatDoNotApplySaySoInOneLine) {
  expect_user_error("run icosahedron --machine pixel-planes --cost", "there is no cost by pixel");
  expect_user_error("run icosahedron --machine pixel-planes --level estimate", "pixel-planes has no level `estimate`");
  expect_user_error("run icosahedron --machine pixel-planes --vcd f.vcd", "--level clocked only");
  write("p.ucode", "");
  expect_user_error("disasm pixel-planes p.ucode", "p.ucode:1: the file is truncated");
  expect_user_error("exec pixel-planes p.ucode -- p", "p.ucode:1: the file is truncated");
  expect_user_error("asm pixel-planes p.igc -o - --listing l", "there are listings of rds3000 programs only");
  expect_user_error("record icosahedron --machine pixel-planes --boundary rds3000.host --out o",
                    "--boundary: pixel-planes has no boundary `rds3000.host`: pixel_planes.commands, pixel_planes.array");
}

const char* const kPrograms =
    "register f = 1;\nregister n = 2;\n"
    "program store phase scan { enable = 1; loop fraction { tree; } loop n { f[i] = tree; } }\n"
    "program fill { enable = 1; loop n { f[i] = constant; } }\n";
const char* const kSmall = " --set array.width=64 --set array.height=64 ";

TEST_F(PixelPlanes, ExecSendsCommandsToMicroprograms) {
  write("p.igc", kPrograms);
  ASSERT_EQ(0, dendro("asm pixel-planes p.igc -o p.ucode").status);
  const std::string commands = "store:0.5,-2,3:fraction=1 ";
  std::string first;
  for (const std::string level : {"cycle", "clocked"}) {
    const Result source = dendro(std::string("exec pixel-planes p.igc") + kSmall + "--level " + level +
                                 " --dump 0:2 --dump 64 -- f=8 n=16 " + commands + "f=40 n=24 fill:constant=0xabcdef");
    ASSERT_EQ(0, source.status) << source.err;
    EXPECT_EQ(0u, source.out.find("pixel[0] = 0x00abcdef0000000300\npixel[1] = 0x00abcdef0000000300\npixel[64] = 0x00abcdef0000000100\n"))
        << source.out;
    const Result words = dendro(std::string("exec pixel-planes p.ucode") + kSmall + "--level " + level +
                                " --dump 0:2 --dump 64 -- r1=8 r2=16 " + commands + "r1=40 r2=24 fill:constant=0xabcdef");
    const auto pixels = [](const std::string& out) { return out.substr(0, out.find("pixel-planes")); };
    EXPECT_EQ(pixels(source.out), pixels(words.out)) << words.err;
    const auto clocks = [](const std::string& out) { return out.substr(out.find(": ")); };
    EXPECT_EQ(first.empty() ? clocks(source.out) : first, clocks(source.out));
    first = clocks(source.out);
  }
  ASSERT_EQ(0, dendro("exec pixel-planes p.igc --quiet --json o.json -- n=16 store:1,1,1:fraction=4").status);
  const json object = json::parse(read("o.json"));
  std::int64_t scan = 0;
  for (const json& phase : object["phases"])
    if (phase["name"] == "scan") scan = phase["cycles"];
  EXPECT_GE(scan, 1 + 4 + 16) << "the clocks of the command are booked under the program's phase";
  EXPECT_LE(scan, 1 + 4 + 16 + 4);
}

TEST_F(PixelPlanes, CommandsThatCannotBeSentAreOneLine) {
  write("p.igc", kPrograms);
  const std::string exec = "exec pixel-planes p.igc ";
  expect_user_error(exec, "p.igc: its programs run when they are commanded");
  expect_user_error(exec + "-- store", "store: takes an expression: store:A,B,C");
  expect_user_error(exec + "-- g=3", "p.igc: g: is not there: it has programs fill, store; registers f, n");
  expect_user_error(exec + "-- f=256", "f=256: value: `256` is not a whole number from 0 to 255");
  expect_user_error(exec + "-- f=60 n=16 fill:constant=1", "`f` reaches bit 75 of a pixel; the memory has bits 0..71");
  expect_user_error(exec + "--dump 262144 -- fill", "--dump: the array has pixels 0 to 262143");
  for (const char* value : {"nan", "inf", "-inf", "1e39"})
    expect_user_error(exec + "-- store:1," + value + ",0", "is no finite number of single precision");
  expect_user_error(exec + "-- store:1e18,0,0:fraction=8", "is too large for any number of guard bits");
  expect_user_error(exec + "-- store:1,2", "`1,2` is not A,B,C");
  expect_user_error(exec + "-- store:1,2,3:guard=64", "guard: `64` is not a whole number from 0 to 63");
  write("two.igc", "register f = 1;\nprogram p { enable = 1; loop 4 { f[i + 4] = f[i]; } }\n");
  ASSERT_EQ(0, dendro("asm pixel-planes two.igc -o two.ucode").status);
  expect_user_error("exec pixel-planes two.ucode -- p", "two.ucode: word 1 uses two ports: the array's memory has 1");
  EXPECT_EQ(0, dendro("exec pixel-planes two.ucode --set array.ports=2 -- p").status);
}

TEST_F(PixelPlanes, CoefficientsOfAnySizeAreDrawnOrRefused) {
  const std::string rest = ", [0,1,0,1], [0,-1,0,1], [0,0,1,1], [0,0,-1,1]]\n";
  const std::string run = "run s.toml --machine pixel-planes --set parameters.array.width=64 --set parameters.array.height=64 ";
  for (const char* bad : {"[nan,0,0,1], [-1,0,0,1]", "[1,0,0,inf], [-1,0,0,1]"}) {
    write("s.toml", scene_with("planes = [" + std::string(bad) + rest));
    expect_user_error(run, "must be a list of 4 finite numbers");
  }
  write("s.toml", scene_with("planes = [[1,0,0.19,1e30], [-1,0,0,1e30]" + rest));
  expect_user_error(run, "no point lies inside all 6 planes");
  // Depths that no guard bits hold: the nearly edge-on planes are taken as edges.
  for (const char* steep : {"[1,0,-1e-12,1], [-1,0,1e-14,1]", "[5,0,-1.0000001,5], [-1,0,0,1]", "[1,0,0.2000000001,1], [-1,0,-0.19999999999999,1]"}) {
    write("s.toml", scene_with("planes = [" + std::string(steep) + rest));
    const Result result = dendro(run + "--out o --json o.json --quiet");
    ASSERT_EQ(0, result.status) << result.err;
    const json object = json::parse(read("o.json"));
    EXPECT_EQ(0, object["error"]["wrong_pixels"].get<double>()) << steep;
    EXPECT_LT(2000, object["error"]["covered_pixels"].get<double>()) << steep;
  }
}

TEST_F(PixelPlanes, AFifoThatIsTooSmallStallsTheHostAndLosesNothing) {
  const std::string run = "run icosahedron --machine pixel-planes --set image.width=64 --set image.height=64 --quiet"
                          " --set parameters.array.width=64 --set parameters.array.height=64 --set parameters.host.word_ns=1";
  const auto object = [&](const std::string& more, const std::string& file) {
    EXPECT_EQ(0, dendro(run + more + " --out o --json " + file).status);
    return json::parse(read(file));
  };
  const json deep = object("", "deep.json");
  for (const char* level : {"cycle", "clocked"}) {
    const json shallow = object(std::string(" --set parameters.fifo.depth_words=8 --level ") + level, "shallow.json");
    EXPECT_EQ(deep["units"]["pixel_planes.controller"]["commands"], shallow["units"]["pixel_planes.controller"]["commands"]);
    EXPECT_EQ(deep["units"]["pixel_planes.host"]["fifo_words"], shallow["units"]["pixel_planes.host"]["fifo_words"]);
    EXPECT_GT(shallow["units"]["pixel_planes.host"]["fifo_full_clocks"].get<int>(), 100) << level;
    EXPECT_EQ(deep["image"]["sha256"], shallow["image"]["sha256"]);
  }
  EXPECT_EQ(0, deep["units"]["pixel_planes.host"]["fifo_full_clocks"].get<int>());
}

TEST_F(PixelPlanes, FieldsAndPicturesThatThePixelsDoNotHoldAreOneLine) {
  for (const char* scene : {"icosahedron", "teapot"}) {
    const std::string run = std::string("run ") + scene + " --machine pixel-planes --set parameters.array.";
    expect_user_error(run + "memory_bits=40", "memory has 40");
    expect_user_error(run + "height=256", "image.height: 512 is more than the 256 pixels of the array");
  }
}

TEST_F(PixelPlanes, MicroprogramsAssembleAndComeBack) {
  write("p.igc", "register f = 1;\nprogram p { enable = 1; loop 16 { f[i] = tree; } }\n");
  ASSERT_EQ(0, dendro("asm pixel-planes p.igc -o p.ucode").status);
  ASSERT_EQ(0, dendro("disasm pixel-planes p.ucode -o q.igc").status);
  ASSERT_EQ(0, dendro("asm pixel-planes q.igc -o q.ucode").status);
  EXPECT_EQ(read("p.ucode"), read("q.ucode"));
  expect_user_error("exec rds3000 p.ucode", "the program is for pixel-planes, not rds3000");
  expect_user_error("disasm rds3000 p.ucode", "the program is for pixel-planes");
  write("bad.igc", "register f = 1;\nprogram p { enable = 1; f[i] = 1; }\n");
  expect_user_error("asm pixel-planes bad.igc -o bad.ucode", "bad.igc:2:25: `i` counts the turns of a loop");
}

TEST_F(PixelPlanes, MachinesAndFirmwareListIt) {
  EXPECT_NE(std::string::npos, dendro("machines").out.find("pixel-planes:pxpl4"));
  EXPECT_NE(std::string::npos, dendro("machines pixel-planes:pxpl5").out.find("array.memory_bits"));
  EXPECT_NE(std::string::npos, dendro("firmware").out.find("firmware/half_space/pixel_planes/half_space.igc"));
}

}  // namespace
}  // namespace dendro::cli
