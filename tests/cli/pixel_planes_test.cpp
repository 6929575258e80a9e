#include "tests/cli/cli.h"

namespace dendro::cli {
namespace {

using PixelPlanes = CommandTest;
using json = nlohmann::json;

TEST_F(PixelPlanes, RunsTheScenesOfTheFrameBuffer) {
  for (const char* scene : {"icosahedron", "figure5", "grove", "aspen-hull"}) {
    SCOPED_TRACE(scene);
    const Result run = dendro(std::string("run ") + scene + " --machine pixel-planes --out o --json o.json --quiet");
    ASSERT_EQ(0, run.status) << run.err;
    const json object = json::parse(read("o.json"));
    EXPECT_EQ("pixel-planes", object["machine"]);
    EXPECT_EQ("pxpl4", object["preset"]);
    EXPECT_LT(0, object["cycles"].get<std::int64_t>());
    EXPECT_LT(object["error"]["wrong_pixels"].get<double>(), object["error"]["covered_pixels"].get<double>() / 1000);
    const json array = object["units"]["pixel_planes.array"];
    EXPECT_LE(array["evaluated_pixel_operations"].get<double>(), array["pixel_operations"].get<double>());
    std::filesystem::remove_all(folder_ / "o");
    std::filesystem::remove(folder_ / "o.json");
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
    const Result run = dendro(std::string("run grove --machine pixel-planes:pxpl5 --set parameters.host.program_load_ms=0") +
                              " --set parameters.renderers.count=" + renderers + " --out o --json o.json --quiet");
    ASSERT_EQ(0, run.status) << run.err;
    const json object = json::parse(read("o.json"));
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
    std::filesystem::remove_all(folder_ / "o");
    std::filesystem::remove(folder_ / "o.json");
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
  expect_user_error(run + "parameters.array.ports=3", "array.ports");
  expect_user_error(run + "parameters.tree.masked=false", "tree.gap_clocks: without masks an expression runs into the next unless 8 clocks or more lie between");
  expect_user_error(run + "parameters.array.memory_bit=3", "did you mean `array.memory_bits`?");
  expect_user_error("run icosahedron --machine pixel-planes:pxpl6", "pxpl");
}

TEST_F(PixelPlanes, CommandsThatDoNotApplySaySoInOneLine) {
  expect_user_error("run icosahedron --machine pixel-planes --cost", "there is no cost by pixel");
  write("p.ucode", "");
  expect_user_error("exec pixel-planes p.ucode", "pixel-planes has no processor that runs a program by itself");
  expect_user_error("disasm pixel-planes p.ucode", "p.ucode:1: the file is truncated");
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
