#include "tests/cli/cli.h"

namespace dendro::cli {
namespace {

using Primitives = CommandTest;
using json = nlohmann::json;

TEST_F(Primitives, ScenesRunAndAgreeWithTheReferenceExceptAtSilhouettes) {
  for (const char* scene : {"teapot --set raster_primitives.patch_steps=3", "buckyball",
                            "shadows --set raster_primitives.patch_steps=1", "textured --set raster_primitives.patch_steps=1"}) {
    SCOPED_TRACE(scene);
    const json object = ran(scene);
    EXPECT_EQ("raster_primitives", object["algorithm"]);
    EXPECT_LT(0, object["cycles"].get<std::int64_t>());
    EXPECT_LT(object["error"]["wrong_pixels"].get<double>(), object["error"]["covered_pixels"].get<double>() / 300);
    EXPECT_GT(object["error"]["psnr_db"].get<double>(), 25);
  }
}

TEST_F(Primitives, AreDrawnInTilesAsInOneArray) {
  for (const char* scene : {"teapot --set raster_primitives.patch_steps=2", "buckyball", "shadows --set raster_primitives.patch_steps=2",
                            "textured --set raster_primitives.texture_size=16 --set raster_primitives.patch_steps=2"}) {
    SCOPED_TRACE(scene);
    json runs[2];
    for (const bool tiled : {false, true})
      runs[tiled] = ran(std::string(scene) + (tiled ? " --machine pixel-planes:pxpl5" : ""))["error"];
    EXPECT_EQ(runs[0]["covered_pixels"], runs[1]["covered_pixels"]);
    EXPECT_EQ(runs[0]["wrong_pixels"], runs[1]["wrong_pixels"]);  // edges are exact in both
    EXPECT_NEAR(runs[0]["psnr_db"].get<double>(), runs[1]["psnr_db"].get<double>(), 1);  // roundings choose texels
    EXPECT_LE(runs[1]["inner_wrong_shadows"].get<double>(), 1);
  }
}

TEST_F(Primitives, TakeTheSameClocksAndShowTheSameAtEveryLevelWithTime) {
  for (const char* scene : {"teapot --set raster_primitives.patch_steps=1", "buckyball",
                            "shadows --set raster_primitives.patch_steps=1",
                            "textured --set raster_primitives.texture_size=16 --set raster_primitives.patch_steps=1"}) {
    SCOPED_TRACE(scene);
    json runs[2];
    for (const bool clocked : {false, true})
      runs[clocked] = ran(std::string(scene) + " --level " + (clocked ? "clocked" : "cycle"));
    EXPECT_EQ(runs[0]["cycles"], runs[1]["cycles"]);
    EXPECT_EQ(runs[0]["phases"], runs[1]["phases"]);
    EXPECT_EQ(runs[0]["image"]["sha256"], runs[1]["image"]["sha256"]);
    EXPECT_EQ(runs[0]["error"], runs[1]["error"]);
  }
}

TEST_F(Primitives, TexturesLieWhereTheReferenceHasThem) {
  for (const char* settings : {"", " --set 'raster_primitives.texture=\"wood\"' --set raster_primitives.texture_size=32",
                               " --machine pixel-planes:pxpl5"}) {
    SCOPED_TRACE(settings);
    const json error =
        ran(std::string("textured --level function --set raster_primitives.patch_steps=2") + settings)["error"];
    EXPECT_GT(error["texture_pixels"].get<double>(), 50000);
    EXPECT_EQ(error["texture_wrong_colours"], 0);
    EXPECT_EQ(error["inner_texels_beyond_rounding"], 0);
    EXPECT_LT(error["inner_colour_error"].get<double>(), 2);
  }
}

TEST_F(Primitives, AResolvedRunRepeatsItself) {
  ASSERT_EQ(0, dendro("run teapot --set raster_primitives.patch_steps=1 --out a --json a.json --quiet").status);
  const Result again = dendro("run a/resolved.toml --out b --json b.json --quiet");
  ASSERT_EQ(0, again.status) << again.err;
  const json a = json::parse(read("a.json")), b = json::parse(read("b.json"));
  EXPECT_EQ(a["cycles"], b["cycles"]);
  EXPECT_EQ(a["image"]["sha256"], b["image"]["sha256"]);
}

TEST_F(Primitives, WhatCannotBeDrawnIsOneLine) {
  const std::string run = "run teapot --set ";
  expect_user_error(run + "image.width=600", "image.width: 600 is more than the 512 pixels of the array");
  expect_user_error(run + "raster_primitives.colours=[[2,0,0]]", "raster_primitives.colours: a colour's parts are 0..1");
  expect_user_error(run + "raster_primitives.spheres=[[0,0,0,0,1,1,1]]", "with a radius above 0");
  expect_user_error(run + "raster_primitives.spheres=[[900,0,0,950,1,1,1]]", "sphere 1 is too large for the numbers in a pixel");
  expect_user_error(run + "raster_primitives.sphere=1", "did you mean `spheres`?");
  expect_user_error(run + "parameters.array.memory_bits=32", "the picture takes 41 bits of a pixel; its memory has 32");
  const std::string textured = "run textured --set raster_primitives.";
  expect_user_error(textured + "texture_size=48", "raster_primitives.texture_size: 48 is not a power of two");
  expect_user_error(textured + "textured=[[3,0,0,0,1,0,0,0,0,1]]", "there is no object 3; the first is 1, the last 2");
  expect_user_error(textured + "textured=[[2,0,0,0,0,0,0,0,0,1]]", "a repeat of the texture is shorter than a micrometre");
  expect_user_error(textured + "textured=[[2,0,0,0,0.001,0,0,0,0,1]]", "a corner lies farther than 4096 texels from the origin");
  expect_user_error(textured + "depth_bits=24 --set raster_primitives.texture_size=128 --set parameters.array.memory_bits=64",
                    "raster_primitives.texture_size: the picture takes 65 bits of a pixel; its memory has 64");
  expect_user_error("run teapot --machine rds3000", "rds3000 has no firmware for raster_primitives");
}

}  // namespace
}  // namespace dendro::cli
