#include "sim/study/scene_file.h"

#include "tests/core/study/fake_machine.h"

namespace dendro::study {
namespace {

class SceneFileTest : public fake::TestFolder {
 protected:
  SceneFile load(const std::string& text, const std::vector<std::string>& settings = {}) {
    return load_scene(write("s.toml", text), settings, catalogue_);
  }
  std::string error(const std::string& text, const std::vector<std::string>& settings = {}) {
    return error_of([&] { load(text, settings); });
  }
};

TEST_F(SceneFileTest, ReadsWhatTheContractShows) {
  const SceneFile file = load(
      "algorithm = \"toy\"\nmachine = \"fake:plain\"\n"
      "[image]\nwidth = 512\nheight = 256\n"
      "[camera]\nprojection = \"perspective\"\nfov_y = 40\nposition = [0, 2, 6]\ntarget = [0, 2, 0]\nup = "
      "[0, 1, 0]\n"
      "[[light]]\ndirection = [-1, -2, -1]\nambient = 0.2\n"
      "[[object]]\nmesh = \"m/aspen.obj.gz\"\nat = [1, 2, 3]\nrotate = [0, 30, 0]\nscale = 2.0\nunits = "
      "\"cm\"\n"
      "up_axis = \"z\"\ngroups = { leaf = \"leaves*\", trunk = \"trunk*\" }\n"
      "[[object]]\ntree = \"pine\"\nheight = 3\n"
      "[toy]\nunbounded = \"error\"\nlist = [[1, 2], [3, 4]]\n"
      "[parameters.delay]\na_ticks = 15\n");
  const scene::Scene& s = file.scene;
  EXPECT_EQ("s", s.name);
  EXPECT_EQ(512, s.image.width);
  EXPECT_EQ(256, s.image.height);
  EXPECT_EQ(scene::Camera::Projection::kPerspective, s.camera.projection);
  EXPECT_EQ(40, s.camera.fov_y);
  EXPECT_EQ((scene::Vector3{0, 2, 6}), s.camera.position);
  EXPECT_EQ(0.2, s.lights.at(0).ambient);
  EXPECT_EQ(path("m/aspen.obj.gz"), s.objects.at(0).mesh);
  EXPECT_EQ("cm", s.objects[0].units);
  EXPECT_EQ("trunk*", s.objects[0].groups.at("trunk"));
  EXPECT_EQ(15, s.objects[0].where.line);
  EXPECT_EQ("pine", s.objects.at(1).tree);
  EXPECT_EQ(std::int64_t{3}, std::get<std::int64_t>(s.objects[1].tree_parameters.at("height").value));
  EXPECT_EQ(2u, s.options.values().size());
  ASSERT_EQ(1u, file.parameters.size());
  EXPECT_EQ("delay.a_ticks", file.parameters[0].first);
}

TEST_F(SceneFileTest, AnUnknownKeyNamesFileLineAndTheNearestKnownOne) {
  EXPECT_EQ("s.toml:3: image.widht: unknown key; did you mean `width`?",
            error("algorithm = \"toy\"\n[image]\nwidht = 3\n"));
  EXPECT_EQ("s.toml:9: lihgt: unknown key; did you mean `light`?", error(fake::toy_scene("[lihgt]\n")));
  EXPECT_EQ("s.toml:9: object.0.scael: unknown key; did you mean `scale`?",
            error(fake::toy_scene("scael = 2\n")));
}

TEST_F(SceneFileTest, ImpossibleValuesSayWhatIsAllowed) {
  EXPECT_EQ("s.toml:3: image.width: 0 is impossible, allowed are 1..16384",
            error("algorithm = \"toy\"\n[image]\nwidth = 0\n"));
  EXPECT_EQ("s.toml:3: image.width: must be an integer in 1..16384",
            error("algorithm = \"toy\"\n[image]\nwidth = 2.5\n"));
  EXPECT_EQ("s.toml:3: camera.up: must not point along the view",
            error("algorithm = \"toy\"\n[camera]\nup = [0, 0, 2]\nheight = 1\n"));
  EXPECT_EQ("s.toml:3: camera.height: must be a finite number from 1e-09 to 1000000000000",
            error("algorithm = \"toy\"\n[camera]\nheight = nan\n"));
  EXPECT_EQ("s.toml:1: algorithm: \"tow\" is not known, allowed are toy", error("algorithm = \"tow\"\n"));
  EXPECT_EQ("s.toml:8: object.0.planes: an object is exactly one of: mesh, solid, planes, tree",
            error(fake::toy_scene("mesh = \"x.obj\"\n")));
}

TEST_F(SceneFileTest, SettingsAddressKeysByTheirPath) {
  const SceneFile file = load(fake::toy_scene(), {"image.width=9", "object.0.scale=0.5", "toy.crash=true",
                                                  "parameters.mode.kind=dense", "camera.position=[0, 0, 9]"});
  EXPECT_EQ(9, file.scene.image.width);
  EXPECT_EQ(0.5, file.scene.objects[0].scale);
  EXPECT_EQ(9, file.scene.camera.position[2]);
  EXPECT_EQ("mode.kind", file.parameters.at(0).first);
  EXPECT_EQ("--set: image.widht: unknown key; did you mean `width`?",
            error(fake::toy_scene(), {"image.widht=9"}));
  EXPECT_EQ("--set: image.width: must be an integer in 1..16384",
            error(fake::toy_scene(), {"image.width=wide"}));
}

TEST_F(SceneFileTest, PathsBelongToTheFileTheyStandIn) {
  std::filesystem::create_directory(path("sub"));
  write("sub/base.toml", fake::toy_scene());
  write("sub/mesh.toml", "algorithm = \"toy\"\n[camera]\nheight = 1\n[[object]]\nmesh = \"a.obj\"\n");
  EXPECT_EQ(path("sub/a.obj"), load("include = \"sub/mesh.toml\"\n").scene.objects[0].mesh);
}

TEST_F(SceneFileTest, LaterKeysStandAboveIncludedOnes) {
  write("base.toml", fake::toy_scene());
  const SceneFile file = load("include = [\"base.toml\"]\n[image]\nheight = 7\n");
  EXPECT_EQ(2, file.scene.image.width);
  EXPECT_EQ(7, file.scene.image.height);
}

TEST_F(SceneFileTest, MissingAndCyclicIncludesNameTheChain) {
  EXPECT_EQ("s.toml:1: include: there is no file gone.toml: s.toml -> gone.toml",
            error("include = \"gone.toml\"\n"));
  write("a.toml", "include = \"s.toml\"\n");
  EXPECT_EQ("a.toml:1: include: the file includes itself: s.toml -> a.toml -> s.toml",
            error("include = \"a.toml\"\n"));
}

TEST_F(SceneFileTest, AnUnknownNameNamesTheNearestScene) {
  EXPECT_NE(std::string::npos,
            error_of([&] { load_scene("toi", {}, catalogue_); }).find("did you mean `toy`?"));
  EXPECT_EQ("gone.toml: cannot read the file",
            error_of([&] { load_scene(path("gone.toml"), {}, catalogue_); }));
}

}  // namespace
}  // namespace dendro::study
