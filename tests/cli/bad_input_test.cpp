#include <cmath>

#include "tests/cli/cli.h"

namespace dendro::cli {
namespace {

using BadInput = CommandTest;

TEST_F(BadInput, MissingInclude) {
  write("s.toml", "\ninclude = \"gone.toml\"\n");
  expect_user_error("run s.toml", "s.toml:2: include: there is no file gone.toml: s.toml -> gone.toml");
}

TEST_F(BadInput, CyclicInclude) {
  write("s.toml", "include = \"t.toml\"\n");
  write("t.toml", "include = \"s.toml\"\n");
  expect_user_error("run s.toml", "t.toml:1: include: the file includes itself: s.toml -> t.toml -> s.toml");
}

TEST_F(BadInput, CyclicIncludeOfAPreset) {
  write("m.toml", "include = [\"n.toml\"]\n");
  write("n.toml", "include = [\"m.toml\"]\n");
  expect_user_error("run icosahedron --machine m.toml", "m.toml -> n.toml -> m.toml");
  expect_user_error("machines m.toml", "m.toml -> n.toml -> m.toml");
}

TEST_F(BadInput, MeshWithNan) {
  write("m.obj", "v 1 1 1\nv -1 nan 1\nv -1 1 -1\nv 1 -1 -1\nf 1 2 4\nf 1 3 2\nf 1 4 3\nf 2 3 4\n");
  write("s.toml", scene_with("mesh = \"m.obj\"\n"));
  expect_user_error("run s.toml", "m.obj");
}

TEST_F(BadInput, MeshWithoutArea) {
  write("m.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\nv 3 3 3\nf 1 2 3\nf 2 3 4\n");
  write("s.toml", scene_with("mesh = \"m.obj\"\n"));
  expect_user_error("run s.toml", "m.obj");
}

TEST_F(BadInput, MeshWithoutFaces) {
  write("m.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\n");
  write("s.toml", scene_with("mesh = \"m.obj\"\n"));
  expect_user_error("run s.toml", "m.obj");
}

TEST_F(BadInput, MissingMesh) {
  write("s.toml", scene_with("mesh = \"gone.obj\"\n"));
  expect_user_error("run s.toml", "gone.obj");
}

TEST_F(BadInput, TruncatedGz) {
  write("m.obj", kTetrahedron);
  ASSERT_EQ(0, std::system(("gzip '" + (folder_ / "m.obj").string() + "'").c_str()));
  const std::string whole = read("m.obj.gz");
  write("m.obj.gz", whole.substr(0, whole.size() - 12));
  write("s.toml", scene_with("mesh = \"m.obj.gz\"\n"));
  expect_user_error("run s.toml", "m.obj.gz");
}

TEST_F(BadInput, UnboundedPlanes) {
  write("s.toml", scene_with("planes = [[1,0,0,1],[-1,0,0,1],[0,1,0,1],[0,-1,0,1],[0.1,0.1,1,1]]\n"));
  expect_user_error("run s.toml", "unbounded");
}

TEST_F(BadInput, NoPlanes) {
  write("s.toml", scene_with("planes = []\n"));
  expect_user_error("run s.toml", "s.toml:11: object.0.planes");
  write("m.obj", kTetrahedron);
  write("s.toml", scene_with("mesh = \"m.obj\"\n", "[half_space]\nplanes = 0\n"));
  expect_user_error("run s.toml", "planes");
}

/// Planes that touch a sphere at points of a spiral.
std::string sphere_planes(int count) {
  std::string text = "planes = [\n";
  for (int i = 0; i < count; ++i) {
    const double y = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - y * y), phi = i * 2.399963229728653;
    text += "[" + std::to_string(r * std::cos(phi)) + "," + std::to_string(y) + "," +
            std::to_string(r * std::sin(phi)) + ",1.0],\n";
  }
  return text + "]\n";
}

TEST_F(BadInput, MorePlanesThanTheScratchpadHolds) {
  write("s.toml", scene_with(sphere_planes(2100)));
  expect_user_error("run s.toml", "s.toml:");
}

TEST_F(BadInput, MoreFrontFacesThanNumbers) {
  write("s.toml", scene_with(sphere_planes(700)));
  expect_user_error("run s.toml", "255");
}

TEST_F(BadInput, APictureTheFrameBufferCannotHold) {
  expect_user_error("run icosahedron --set image.width=1024", "512");
  expect_user_error("run icosahedron --set image.width=0", "--set: image.width: 0 is impossible");
}

TEST_F(BadInput, SplittingThatLeavesNoPlane) {
  const std::string tree = "tree = \"round\"\nstart = [[0.01, 1, 0.01]]\ngenerations = 6\nmu_alpha = 75\n"
                           "sigma_alpha = 20\nmu_b = 0.3\nkeep_parent = false\nseed = 2\n";
  write("s.toml", scene_with(tree, "[half_space]\nroughness = 0.1\n"));
  expect_user_error("run s.toml", "s.toml:11: object.tree: splitting leaves no plane");
}

TEST_F(BadInput, ATextureThatDoesNotFitTheFrameBuffer) {
  expect_user_error("run figure6 --set half_space.cube_bits=6", "half_space.cube_bits");
  expect_user_error("run figure6 --set image.height=300", "--set: image.height: 300 lines do not fit");
  expect_user_error("run figure6 --set half_space.layout=wide", "half_space.layout");
  expect_user_error("run figure6-wide --machine rds3000:fg86", "image.height");
}

TEST_F(BadInput, ATrunkThatCannotBeDrawn) {
  const std::string crown = "tree = \"round\"\n";
  const auto refused = [&](const std::string& object, const std::string& options, const std::string& message) {
    write("s.toml", scene_with(crown + object, "[half_space]\n" + options));
    expect_user_error("run s.toml", message);
  };
  refused("trunk_width = 0.2\n", "", "object.trunk_width: goes with trunk");
  refused("trunk = \"palm\"\n", "", "object.trunk");
  refused("trunk = \"cone\"\ntrunk_hight = 1.0\n", "", "did you mean trunk_height?");
  refused("trunk = \"cone\"\n", "depth_range = [2.0, 9.0]\n", "half_space.depth_range: goes without trunks");
  refused("trunk = \"cone\"\n", "depth_bits = 7\n", "half_space.depth_bits: a complete tree takes 8");
  refused("trunk = \"cone\"\n", "registers = 2\n", "half_space.registers");
  refused("", "roughness = 0.1\ntrunk_distance = 3.0\n", "half_space.trunk_distance: no object has a trunk");
}

TEST_F(BadInput, AMeshWithoutTheGroupsThatAreAskedFor) {
  write("m.obj", kTetrahedron);
  write("s.toml", scene_with("mesh = \"m.obj\"\ngroups = { crown = \"leaves*\" }\n", "[half_space]\nroughness = 0.1\n"));
  expect_user_error("run s.toml", "no group is named like crown");
}

TEST_F(BadInput, AMicroprogramThatDoesNotFit) {
  std::string source = "reg t = r0;\n";
  for (int i = 0; i < 4097; ++i) source += "t = t + 1;\n";
  write("big.gia", source);
  expect_user_error("asm rds3000 big.gia -o big.ucode", "4096");
  expect_user_error("exec rds3000 big.gia", "4096");
}

TEST_F(BadInput, EndlessMicrocodeNamesItsLoop) {
  write("endless.gia", "reg t = r0;\nentry start;\nstart:\n  t = t + 1;\nagain:\n  goto again;\n");
  for (const char* level : {"function", "cycle", "clocked"})
    expect_user_error(std::string("exec rds3000 endless.gia --limit 100000 --level ") + level, "001");
}

TEST_F(BadInput, AnUnwritableRunDirectory) {
  write("file", "");
  expect_user_error("run icosahedron --out file/below", "cannot write");
  expect_user_error("run icosahedron --out file", "it is a file");
  expect_user_error("run icosahedron --json no/such/folder.json --out run", "no/such/folder.json");
}

TEST_F(BadInput, WhatIsWrongInTheMiddleLeavesNoDirectory) {
  expect_user_error("run icosahedron --limit 1000 --out a/b/c", "");
  expect_user_error("run icosahedron --set half_space.boxin=false --out a/b/c", "boxing");
}

TEST_F(BadInput, UnknownKeysNameTheNearest) {
  expect_user_error("run icosahedron --set parameters.processor.tick_n=3",
                    "did you mean `processor.tick_ns`?");
  expect_user_error("run icosahedron --set imge.width=3", "did you mean `image`?");
  expect_user_error("run icosaedron", "did you mean `icosahedron`?");
  expect_user_error("run icosahedron --machine rds300", "rds3000");
  expect_user_error("run icosahedron --machine rds3000:fg87", "fg86");
  expect_user_error("run icosahedron --level estimate", "known are function, cycle, clocked");
}

TEST_F(BadInput, ImpossibleParameters) {
  expect_user_error("run icosahedron --set parameters.processor.scratch_words=100",
                    "processor.scratch_words");
  expect_user_error("run icosahedron --set parameters.processor.multiply_ticks=1000",
                    "processor.multiply_ticks");
  expect_user_error("run icosahedron --set parameters.frame_memory.bits_per_pixel=25",
                    "must be 24, 32 or 48");
  expect_user_error("run icosahedron --set parameters.microcode.pack=half", "\"none\", \"full\"");
  expect_user_error("exec rds3000 nothing.ucode --set processor.tick_ns=fast", "processor.tick_ns");
}

TEST_F(BadInput, BadToml) {
  write("s.toml", "algorithm = \"half_space\"\n[image\n");
  expect_user_error("run s.toml", "s.toml:2: not valid TOML");
}

TEST_F(BadInput, BadUcode) {
  write("p.gia", "entry s;\ns:\n  halt;\n");
  ASSERT_EQ(0, dendro("asm rds3000 p.gia -o p.ucode").status);
  const std::string good = read("p.ucode");
  write("p.ucode", good.substr(0, good.size() / 2));
  expect_user_error("exec rds3000 p.ucode", "p.ucode");
  std::string changed = good;
  changed[changed.find("0000") + 1] = '1';
  write("p.ucode", changed);
  expect_user_error("disasm rds3000 p.ucode", "p.ucode");
}

TEST_F(BadInput, UnknownKeysComeBeforeWhatTheirValuesBreak) {
  write("m.obj", kTetrahedron);
  write("s.toml", scene_with("mesh = \"m.obj\"\n", "[half_space]\nplane = 60\n"));
  expect_user_error("run s.toml", "s.toml:13: half_space.plane: unknown key; did you mean `planes`?");
  expect_user_error("run icosahedron --set camera.hieght=3 --set image.width=0",
                    "--set: camera.hieght: unknown key; did you mean `height`?");
  expect_user_error(
      "run icosahedron --set parameters.processor.tick_ns=fast --set parameters.bus.write_tick=1",
      "bus.write_tick: the machine has no such parameter");
}

TEST_F(BadInput, KeysThatCannotGoTogether) {
  expect_user_error("run icosahedron --set camera.fov_y=40", "--set: camera.fov_y: goes with projection");
  expect_user_error("run icosahedron --set object.0.units=mm", "--set: object.0.units: goes with a mesh");
  expect_user_error("run icosahedron --set 'object.0.groups={ a = \"b\" }'", "--set: object.0.groups");
}

TEST_F(BadInput, IsBlamedOnThePlaceThatSaidIt) {
  write("m.obj", "v 1 1 1\nf 1 2 4\n");
  write("s.toml", scene_with("mesh = \"m.obj\"\n"));
  expect_user_error("run s.toml", "(the mesh of s.toml:11)");
  write("t.toml", "level = \"estimate\"\n" + scene_with("solid = \"icosahedron\"\n"));
  expect_user_error("run t.toml",
                    "t.toml:1: level: rds3000 has no level `estimate`: known are function, cycle");
  write("u.toml", "include = \"icosahedron\"\n[image]\nheight = 5\nwidth = 513\n");
  expect_user_error("run u.toml", "u.toml:4: image.width: 513");
  expect_user_error("run icosahedron --set image.width=513", "--set: image.width: 513");
  expect_user_error("run icosahedron --set parameters.processor.scratch_words=16",
                    "--set: processor.scratch_words: the firmware half_space cannot run on this machine: ");
}

TEST_F(BadInput, NumbersAreNotClamped) {
  for (const char* seed : {"-1", "9223372036854775808", "18446744073709551616", "1.5", "x"})
    expect_user_error(std::string("run icosahedron --seed ") + seed,
                      "is not an integer in 0..9223372036854775807");
  expect_user_error("run icosahedron --limit 99999999999999999999", "--limit: ");
  expect_user_error("table --tolerance 1e999", "--tolerance: ");
  expect_user_error("table --tolerance nan", "--tolerance: ");
  expect_user_error("levels icosahedron --budget 1e999", "--budget: ");
}

TEST_F(BadInput, EmptyWordsAndOptionsThatLackAnother) {
  for (const char* option : {"--machine", "--json", "--out", "--level", "--vcd"})
    expect_user_error(std::string("run icosahedron ") + option + " ''", option);
  for (const char* option : {"--vcd-from 3", "--vcd-to 3", "--vcd-units rds3000.bus"})
    expect_user_error(std::string("run icosahedron ") + option, "requires --vcd");
  expect_user_error("run icosahedron --level clocked --vcd w.vcd --vcd-from 50 --vcd-to 10",
                    "ticks 50 up to 10 are none");
  expect_user_error("--bogus", "--bogus: unknown option");
}

TEST_F(BadInput, AnOutputThatIsTheInput) {
  write("p.gia", "entry s;\ns:\n  halt;\n");
  std::filesystem::create_symlink("p.gia", folder_ / "link.gia");
  ASSERT_EQ(0, dendro("asm rds3000 p.gia -o p.ucode").status);
  const std::string source = read("p.gia"), program = read("p.ucode");
  expect_user_error("asm rds3000 p.gia -o p.gia", "--out: p.gia");
  expect_user_error("asm rds3000 p.gia -o ../work/link.gia", "--out: ");
  expect_user_error("asm rds3000 p.gia -o q.ucode --listing link.gia", "--listing: ");
  expect_user_error("asm rds3000 p.gia -o q.ucode --listing ./q.ucode", "--listing: ");
  expect_user_error("disasm rds3000 p.ucode -o ./p.ucode", "--out: ");
  EXPECT_EQ(source, read("p.gia"));
  EXPECT_EQ(program, read("p.ucode"));
}

TEST_F(BadInput, OutputsThatFailLeaveNothing) {
  expect_user_error("run icosahedron --set image.width=64 --json /dev/full --out run", "/dev/full");
  for (const char* command : {"scenes", "machines rds3000", "run icosahedron --out run"}) {
    const int status = std::system(
        ("cd '" + folder_.string() + "' && '" DENDRO "' " + command + " >/dev/full 2>/dev/null </dev/null")
            .c_str());
    EXPECT_EQ(2, WEXITSTATUS(status)) << command;
  }
}

TEST_F(BadInput, ATableRefusesBeforeItPrintsItsPlan) {
  expect_user_error("table --set image.width=600", "image.width");
  expect_user_error("table --set parameters.processor.scratch_words=16", "processor.scratch_words");
  expect_user_error("table --level estimate", "--level: rds3000 has no level");
  expect_user_error("table --level function", "needs a level with time");
}

TEST_F(BadInput, AWorkingDirectoryThatIsGone) {
  std::filesystem::create_directory(folder_ / "gone");
  const Result result = dendro("scenes; cd gone; rmdir ../gone; '" DENDRO "' run icosahedron");
  EXPECT_EQ(2, result.status);
  EXPECT_EQ(0u, result.err.find("dendro: the working directory cannot be used")) << result.err;
  EXPECT_EQ(1, std::count(result.err.begin(), result.err.end(), '\n')) << result.err;
}

TEST_F(BadInput, DumpsOfNothing) {
  write("p.gia", "entry s;\ns:\n  halt;\n");
  for (const char* dump : {"0:0", ":", "0:", "x", "8192"})
    expect_user_error(std::string("exec rds3000 p.gia --dump ") + dump, "--dump");
}

TEST_F(BadInput, ControlCharactersAreNotPrinted) {
  write("p.ucode", "dendro-ucode 1\nmachine a\033[31m\n");
  const Result result = dendro("exec rds3000 p.ucode");
  EXPECT_EQ(2, result.status);
  EXPECT_NE(std::string::npos, result.err.find("a\\x1b[31m")) << result.err;
}

TEST_F(BadInput, CommandLines) {
  expect_user_error("", "a command is missing");
  expect_user_error("draw", "draw: there is no such command");
  expect_user_error("run", "scene is required");
  expect_user_error("run icosahedron --frob", "--frob");
  expect_user_error("run icosahedron --limit -3", "--limit");
  expect_user_error("run icosahedron --set image.width", "the form is key=value");
  expect_user_error("table FG87", "known are all, FG86");
  expect_user_error("run icosahedron --interval --level function", "--interval");
  expect_user_error("run icosahedron --vcd x.vcd", "clocked");
  expect_user_error("run icosahedron --level clocked --vcd x.vcd --vcd-units lamp", "no unit \"lamp\"");
  expect_user_error("exec rds3000 gone.ucode", "gone.ucode: cannot read the file");
  expect_user_error("asm sgi-4d35 gone.gia -o x", "rds3000");
}

}  // namespace
}  // namespace dendro::cli
