#include <cmath>
#include <limits>

#include "tests/firmware/zbuffer_views/sgi_4d35/programs.h"

namespace dendro::zbuffer_views {
namespace {

/// Under qemu-mips, and the first of every list on the machine too: the program ends with 2, one line that
/// begins with the bad file's name and holds `text`, and no finished result.
void expect_complaint(const std::string& name, const std::string& job, const std::string& from,
                      bool job_is_bad, const std::string& text, bool on_machine = false) {
  const std::string job_path = write_file("bad_job", job), from_path = write_file("bad_from", from),
                    to = mips::scratch() + "/never";
  std::remove(to.c_str());
  const std::string arguments = job_path + " " + from_path + " " + to;
  std::vector<std::string> commands = {mips::qemu(program(name), arguments)};
  if (on_machine) commands.push_back(mips::model(program(name), arguments));
  for (const std::string& command : commands) {
    const Ran ran = mips::run(command);
    EXPECT_EQ(2, ran.status) << text << ran.errors;
    EXPECT_EQ("", ran.output);
    EXPECT_EQ(0u, ran.errors.find((job_is_bad ? job_path : from_path) + ": ")) << ran.errors;
    EXPECT_NE(std::string::npos, ran.errors.find(text)) << text << ": " << ran.errors;
    EXPECT_EQ(ran.errors.size() - 1, ran.errors.find('\n')) << ran.errors;
    EXPECT_EQ("", read_file(to)) << text;
  }
}

class BadFiles : public testing::Test {
 protected:
  const TreeFile tree_ = random_tree(5, 20);
  JobFile job_{tree_};
};

TEST_F(BadFiles, JobsOfViewsAreRefused) {
  bool first = true;
  const auto with = [&](auto change, const std::string& text) {
    JobFile job = job_;
    change(job.facts);
    expect_complaint("precompute", job.bytes(), tree_.bytes(), true, text, first);
    first = false;
  };
  with([](zbv_job& j) { j.layers = 0; }, "layers: is 0, allowed are 1 to 4");
  with([](zbv_job& j) { j.layers = 5; }, "layers: is 5");
  with([](zbv_job& j) { j.threshold = -0.01f; }, "threshold: is below 0");
  with([](zbv_job& j) { j.threshold = std::numeric_limits<float>::quiet_NaN(); }, "not finite");
  with([](zbv_job& j) { j.bands = 1; }, "bands: is 1");
  with([](zbv_job& j) { j.view_width = 62; }, "no multiple of 4");
  with([](zbv_job& j) { j.view_height = 5000; }, "view height: is 5000");
  with([](zbv_job& j) { j.rule = 2; }, "rule: is 2");
  with([](zbv_job& j) { j.leaf_side = 7; }, "leaf side: is 7");
  with(
      [](zbv_job& j) {
        j.bands = 32;
        j.view_width = j.view_height = 1024;
      },
      "asks for a file of");
  with([](zbv_job& j) { j.pitch = 1e-5f; }, "pitch: is too small");
}

TEST_F(BadFiles, TreesAreRefused) {
  bool first = true;
  const auto with = [&](auto change, const std::string& text, const char* name = "precompute") {
    TreeFile tree = tree_;
    change(tree);
    expect_complaint(name, JobFile(tree).bytes(), tree.bytes(), false, text, first);
    first = false;
  };
  with([](TreeFile& t) { t.triangles.clear(); }, "has no triangles");
  with([](TreeFile& t) { t.triangles.clear(); }, "has no triangles", "polygons");
  with([](TreeFile& t) { t.triangles[3].corner[1] = 100000; }, "triangle 3: names a vertex");
  with([](TreeFile& t) { t.triangles[0].colour = 3; }, "triangle 0: names a vertex or colour");
  with([](TreeFile& t) { t.colours[1].below = 9; }, "colour 1: is none");
  with([](TreeFile& t) { t.vertices[0][1] = std::numeric_limits<float>::infinity(); }, "not finite");
  with([](TreeFile& t) { t.vertices[0][1] = 2e5f; }, "131072 units or more");
  with(
      [](TreeFile& t) {
        for (auto& v : t.vertices) v = {0, 0, 0};
      },
      "has no extent");
  TreeFile other = tree_;
  other.vertices[0][0] += 1;
  expect_complaint("precompute", job_.bytes(), other.bytes(), false, "another tree");
  expect_complaint("polygons", job_.bytes(), other.bytes(), false, "another tree");
}

TEST_F(BadFiles, ViewsAreRefused) {
  const std::string good = precomputed(tree_, job_);
  bool first = true;
  const auto with = [&](const std::string& bytes, const std::string& text) {
    expect_complaint("reconstruct", job_.bytes(), bytes, false, text, first);
    first = false;
  };
  with(good.substr(0, good.size() - 1), "is truncated");
  with(good.substr(0, 100), "is truncated: 100 of");
  with(good.substr(0, 10), "is no views file");
  with("", "is no views file");
  with(good + "x", "bytes where its head says");
  with(tree_.bytes(), "is no views file");
  std::string other = good;
  other[7] = 2;
  with(other, "has version 2, this program reads version 1");
  other = good;
  other[15] = static_cast<char>(other[15] ^ 1);
  with(other, "another tree");
  other = good;
  std::fill(other.begin(), other.begin() + 4, 0);
  with(other, "was not finished");

  ViewsFile views = ViewsFile::parse(good);
  views.facts.layers = 0;
  with(views.bytes(), "layers: is 0");
  views = ViewsFile::parse(good);
  views.facts.threshold = -1;
  with(views.bytes(), "below 0");
  views = ViewsFile::parse(good);
  views.facts.bands = 4;
  with(views.bytes(), "has 14 views where 4 bands have 23");
  views = ViewsFile::parse(good);
  std::swap(views.views[2], views.views[3]);
  with(views.bytes(), "view 2: is of another direction");
  views = ViewsFile::parse(good);
  views.layers.pop_back();
  with(views.bytes(), "bytes where its counts need");
}

TEST_F(BadFiles, JobsOfPicturesAreRefused) {
  const std::string views = precomputed(tree_, job_);
  bool first = true;
  const auto with = [&](auto change, const std::string& text) {
    JobFile job = job_;
    change(job);
    expect_complaint("reconstruct", job.bytes(), views, true, text, first);
    first = false;
  };
  with(
      [](JobFile& j) {
        j.facts.projection = kZbvPerspective;
        j.frames[0].eye[0] = 0.1f;
        j.frames[0].eye[2] = 0.2f;
      },
      "frame 0: the camera is inside of tree 0");
  with([](JobFile& j) { j.facts.scale = 0; }, "scale: is not above 0");
  with(
      [](JobFile& j) {
        j.facts.projection = kZbvPerspective;
        j.facts.near = 0;
      },
      "near: is not above 0");
  with([](JobFile& j) { j.facts.width = 0; }, "width: is 0");
  with([](JobFile& j) { j.facts.ambient = 0.5f; }, "together above 1");
  with([](JobFile& j) { j.trees.clear(); }, "trees: is 0");
  with([](JobFile& j) { j.frames.clear(); }, "frames: is 0");
  with([](JobFile& j) { j.trees[0].turn = 256; }, "turn: is 256");
  with([](JobFile& j) { j.trees[0].at[0] = 1e9f; }, "units or more from the origin");
  with([](JobFile& j) { j.frames[0].frame[0] *= 2; }, "frame 0: its axes are not orthonormal");
  with([](JobFile& j) { j.frames[0].light[1] += 1; }, "frame 0: the light's direction");
  with([](JobFile& j) { j.facts.options = 8; }, "options: is 8");
  with(
      [](JobFile& j) {
        j.facts.width = j.facts.height = 1024;
        j.frames.assign(256, j.frames[0]);
      },
      "asks for a file of 2147491880 bytes");
  with(
      [](JobFile& j) {
        j.facts.shadows = 1;
        j.facts.epsilon = -1;
      },
      "light: a value is below 0");
  const std::string whole = job_.bytes();
  expect_complaint("reconstruct", whole.substr(0, whole.size() - 4), views, true, "is truncated");
  expect_complaint("reconstruct", "no job at all, but long enough to have a head", views, true,
                   "is no job file");
}

TEST_F(BadFiles, PolygonsHaveNoPerspectiveAndNoShadows) {
  JobFile job = job_;
  job.facts.projection = kZbvPerspective;
  expect_complaint("polygons", job.bytes(), tree_.bytes(), true, "parallel projection");
  job = job_;
  job.facts.shadows = 1;
  expect_complaint("polygons", job.bytes(), tree_.bytes(), true, "drawn without");
  job = job_;
  job.facts.scale = 1e6f;
  expect_complaint("polygons", job.bytes(), tree_.bytes(), true, "scale: is too large");
}

TEST_F(BadFiles, FilesThatAreNotThereAreNamed) {
  const std::string job = write_file("job", job_.bytes());
  for (const std::string& arguments : {"/nowhere " + job + " x", job + " /nowhere x"}) {
    const Ran ran = mips::run(mips::model(program("precompute"), arguments));
    EXPECT_EQ(2, ran.status);
    EXPECT_EQ(0u, ran.errors.find("/nowhere: cannot be opened")) << ran.errors;
  }
  const Ran ran = mips::run(mips::model(program("precompute"), job));
  EXPECT_EQ(2, ran.status);
  EXPECT_NE(std::string::npos, ran.errors.find("takes JOB TREE VIEWS")) << ran.errors;
}

}  // namespace
}  // namespace dendro::zbuffer_views
