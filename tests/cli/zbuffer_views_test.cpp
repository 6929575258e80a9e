#include "tests/cli/cli.h"

namespace dendro::cli {
namespace {

using json = nlohmann::json;

class ZbufferViews : public CommandTest {
 protected:
  /// A scene of a small tree; `options` are lines of its own table.
  std::string scene(const std::string& options, const std::string& object = "tree = \"magnolia\"\nage = 8\nleaf_rows = 3\n",
                    const std::string& camera = "height = 3\nposition = [3, 3, 9]\n") const {
    return "algorithm = \"zbuffer_views\"\nmachine = \"sgi-4d35\"\nlevel = \"function\"\n"
           "[image]\nwidth = 80\nheight = 120\n[camera]\n" + camera + "target = [0, 1, 0]\n"
           "[[light]]\ndirection = [-1, -2, -1]\nambient = 0.3\n[[object]]\n" + object +
           "[zbuffer_views]\nbands = 3\nview_width = 100\nview_height = 160\n" + options;
  }

  json run(const std::string& arguments) const {
    const Result result = dendro("run " + arguments + " --json o.json --quiet");
    EXPECT_EQ(0, result.status) << result.err;
    return result.status == 0 ? json::parse(read("o.json")) : json();
  }

  static std::vector<std::string> phases(const json& object) {
    std::vector<std::string> names;
    for (const json& phase : object["phases"]) names.push_back(phase["name"]);
    return names;
  }
};

TEST_F(ZbufferViews, PicturesAreThoseOfTheReferenceButForRounding) {
  const char* const options[] = {"", "shadows = true\nlayers = 3\n", "rule = \"peel\"\nleaf_side = \"early\"\n",
                                 "full_product = true\nskip_empty = true\nlayers = 1\n", "compiler = \"O1\"\n",
                                 "compiler = \"fcr31\"\nshadows = true\n", "mapped = false\n"};
  for (const std::string projection : {"height = 3\n", "projection = \"perspective\"\nfov_y = 20\n"})
    for (const char* option : options) {
      SCOPED_TRACE(projection + option);
      write("s.toml", scene(option, "tree = \"magnolia\"\nage = 8\nleaf_rows = 3\n", projection + "position = [3, 3, 9]\n"));
      const json object = run("s.toml --out o");
      const json& error = object["error"];
      EXPECT_GT(error["covered_pixels"].get<int>(), 1500);
      // Single precision moves some samples over a pixel's border, and inserted layers are not the canonical ones.
      EXPECT_LT(error["wrong_pixels"].get<double>(), error["covered_pixels"].get<double>() / 100);
      EXPECT_GT(error["psnr_db"].get<double>(), 28);
    }
}

TEST_F(ZbufferViews, PolygonsAreThoseOfTheReference) {
  write("s.toml", scene("draw = \"polygons\"\n"));
  const json object = run("s.toml --out o");
  EXPECT_EQ("zbuffer_views_polygons.start", phases(object).front());
  EXPECT_LT(object["error"]["wrong_pixels"].get<double>(), object["error"]["covered_pixels"].get<double>() / 100);
}

TEST_F(ZbufferViews, AFirStandsThereAndItsPhasesAreTold) {
  write("s.toml", scene("precompute = \"timed\"\n", "tree = \"fir\"\nage = 6\n"));
  const json object = run("s.toml --out o");
  EXPECT_LT(object["error"]["wrong_pixels"].get<double>(), object["error"]["covered_pixels"].get<double>() / 25);
  const std::vector<std::string> names = phases(object);
  for (const char* wanted : {"zbuffer_views_precompute.scan", "zbuffer_views_reconstruct.reproject_camera",
                             "zbuffer_views_reconstruct.shade"})
    EXPECT_TRUE(std::count(names.begin(), names.end(), wanted)) << wanted;
}

TEST_F(ZbufferViews, AMeshIsDrawnWithItsGroupsAsParts) {
  write("m.obj", std::string("o trunk\nv 0 0 0\nv 0.2 0 0\nv 0.1 1 0\nf 1 2 3\no leaves\nv -1 1 0\nv 1 1 0\nv 0 2 0.3\nf 4 5 6\n"));
  write("s.toml", scene("", "mesh = \"m.obj\"\ngroups = { trunk = \"trunk*\", leaf = \"leaves\" }\n"));
  const json object = run("s.toml --out o");
  const json& facts = object["facts"];
  EXPECT_EQ(1, facts["triangles.trunk"]);
  EXPECT_EQ(1, facts["triangles.leaf"]);
  EXPECT_EQ(0, facts["triangles.branch"]);
  EXPECT_LT(object["error"]["wrong_pixels"].get<double>(), 40);
  EXPECT_GT(object["error"]["covered_pixels"].get<double>(), 500);
}

TEST_F(ZbufferViews, SavedViewsGiveTheSamePictureAndAResolvedRunRepeats) {
  write("s.toml", scene("save_views = true\n"));
  const json made = run("s.toml --out a");
  write("t.toml", scene("views = \"a/views.zbv\"\n"));
  const json loaded = run("t.toml --out b");
  EXPECT_EQ(made["image"]["sha256"], loaded["image"]["sha256"]);
  EXPECT_EQ("zbuffer_views_precompute (untimed)", phases(made).front());
  EXPECT_EQ("zbuffer_views_reconstruct.start", phases(loaded).front());
  const json again = run("b/resolved.toml --out c");
  EXPECT_EQ(made["image"]["sha256"], again["image"]["sha256"]);
}

TEST_F(ZbufferViews, SavedViewsThatDoNotSuitAreOneLine) {
  write("s.toml", scene("save_views = true\n"));
  run("s.toml --out a");
  const std::string views = read("a/views.zbv");
  write("t.toml", scene("views = \"v.zbv\"\n"));
  expect_user_error("run t.toml", "v.zbv: cannot be read");
  expect_user_error("run t.toml --set zbuffer_views.views=a", "a: cannot be read: it is a folder");
  write("v.zbv", views.substr(0, views.size() - 1000));
  expect_user_error("run t.toml", "v.zbv: is truncated or damaged");
  std::string other = views;
  other[7] = 9;
  write("v.zbv", other);
  expect_user_error("run t.toml", "v.zbv: has version 9, this dendro reads 1");
  write("v.zbv", "no views at all, but some text that is long enough for a head");
  expect_user_error("run t.toml", "v.zbv: is no file of stored views");
  write("v.zbv", views);
  expect_user_error("run t.toml --set object.0.seed=7", "v.zbv: holds views of another tree than the scene's");
  expect_user_error("run t.toml --set zbuffer_views.layers=3", "v.zbv: layers: its views have 2, the scene wants 3");
  expect_user_error("run t.toml --set zbuffer_views.precompute=timed", "zbuffer_views.precompute: has nothing to time");
}

TEST_F(ZbufferViews, SavedViewsThatAreDamagedAreOneLineAndAChecksumIsNoneOfTheMachinesBusiness) {
  const auto with = [](std::string bytes, std::size_t at, const std::string& other) { return bytes.replace(at, other.size(), other); };
  write("s.toml", scene("save_views = true\n"));
  run("s.toml --level cycle --out a");
  const std::string views = read("a/views.zbv");
  write("t.toml", scene("views = \"v.zbv\"\n"));
  const std::string line = "v.zbv: is damaged: ", checksum = line + "its content does not have the checksum";
  for (const std::size_t at : {std::size_t{74}, std::size_t{89}, views.size() / 2, views.size() - 1})
    for (const int bit : {1, 128}) {
      write("v.zbv", with(views, at, std::string(1, static_cast<char>(views[at] ^ bit))));
      expect_user_error("run t.toml", checksum);
    }
  // Without a checksum, as a program writes it: the values still have to be possible.
  constexpr std::size_t kHead = 76, kColour = 16, kView = 64, kSamples = 100 * 160;
  const auto word = [&](std::size_t at) {
    std::size_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(views[at + i]);
    return value;
  };
  const std::size_t frames = kHead + kColour * word(48), planes = frames + kView * word(32);
  EXPECT_NE(0u, word(kHead + 12));
  const std::string bare = with(views, kHead + 12, std::string(4, '\0'));
  const std::size_t colours = planes + 6 * kSamples, covered = bare.find_first_not_of('\xff', colours) - colours;
  ASSERT_LT(covered, kSamples);
  const auto refused = [&](std::size_t at, const std::string& bytes, const std::string& what) {
    write("v.zbv", with(bare, at, bytes));
    expect_user_error("run t.toml", line + what);
  };
  const std::string sample = "view 0, layer 0: sample " + std::to_string(covered);
  refused(colours + covered, "\xc8", sample + " has colour 200 of ");
  refused(colours + covered, "\xff", sample + " is half empty");
  refused(planes + 4 * covered, "\x7f\xc0", sample + " has the depth nan");
  refused(planes + 4 * covered, "\x49\x80", sample + " has the depth 10");
  refused(frames + 28, "\x7f\x80", "view 0 holds a value that is not finite");
  refused(kHead, "\x01", "colour 0 is none");
  write("v.zbv", bare);
  const json without = run("t.toml --level cycle --out b");
  write("v.zbv", views);
  const json loaded = run("t.toml --level cycle --set zbuffer_views.save_views=true --out c");
  EXPECT_EQ(without["phases"], loaded["phases"]);
  EXPECT_EQ(without["image"]["sha256"], loaded["image"]["sha256"]);
  EXPECT_EQ(views, read("c/views.zbv"));
}

/// All of a run but what its host did and where its files went.
json simulated(json object) {
  for (const char* key : {"host", "notes"}) object.erase(key);
  object["image"].erase("path");
  return object;
}

TEST_F(ZbufferViews, UntimedViewsAreMadeOnceAndTheRunIsTheSame) {
  write("s.toml", scene(""));
  const json made = run("s.toml --level cycle --out a");
  EXPECT_EQ(0u, made["notes"].size());
  const json kept = run("s.toml --level cycle --out b");
  EXPECT_EQ(simulated(made), simulated(kept));
  EXPECT_EQ(read("a/image.exr"), read("b/image.exr"));
  ASSERT_EQ(1u, kept["notes"].size());
  EXPECT_NE(std::string::npos, kept["notes"][0].get<std::string>().find("zbuffer_views_precompute was not run"));
  EXPECT_EQ(0u, run("s.toml --level cycle --no-cache --out c")["notes"].size());
  // Another camera looks at the same views, another tree or threshold has others; views that are timed are made.
  EXPECT_EQ(1u, run("s.toml --set camera.height=4 --out c")["notes"].size());
  for (const char* other : {"object.0.seed=7", "zbuffer_views.threshold=0.02", "zbuffer_views.layers=1", "zbuffer_views.precompute=timed"})
    EXPECT_EQ(0u, run(std::string("s.toml --out c --set ") + other)["notes"].size()) << other;
  const json again = run("a/resolved.toml --out d");
  EXPECT_EQ(simulated(made)["phases"], simulated(again)["phases"]);
}

TEST_F(ZbufferViews, KeptViewsThatAreRottenCutOrAnothersAreMadeAgain) {
  namespace fs = std::filesystem;
  const auto kept_files = [&] {
    std::vector<fs::path> files;
    for (const auto& file : fs::directory_iterator(base_ / "cache/dendro/files")) files.push_back(file.path());
    return files;
  };
  const auto bytes_of = [](const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  write("s.toml", scene(""));
  const json made = run("s.toml --out a");
  ASSERT_EQ(1u, kept_files().size());
  const fs::path file = kept_files()[0];
  const std::string whole = bytes_of(file);
  run("s.toml --set object.0.seed=7 --out o");
  ASSERT_EQ(2u, kept_files().size());
  const fs::path other = kept_files()[kept_files()[0] == file];
  std::string rotten = whole;
  rotten[whole.size() / 2] ^= 4;
  for (const std::string& bytes : {rotten, whole.substr(0, whole.size() - 3), whole + "x", bytes_of(other), std::string()}) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
    const json again = run("s.toml --out b");
    EXPECT_EQ(simulated(made), simulated(again));
    EXPECT_EQ(0u, again["notes"].size());
    EXPECT_EQ(whole, bytes_of(file));
  }
}

TEST_F(ZbufferViews, RunsAtTheSameTimeShareTheCache) {
  write("s.toml", scene(""));
  std::string line;
  for (int i = 0; i < 4; ++i)
    line += "(cd '" + folder_.string() + "' && XDG_CACHE_HOME='" + (base_ / "cache").string() + "' '" DENDRO "' run s.toml --quiet --out r" +
            std::to_string(i) + ") & ";
  ASSERT_EQ(0, std::system((line + "wait").c_str()));
  const json wanted = simulated(json::parse(read("r0/stats.json")));
  for (const char* other : {"r1", "r2", "r3"}) EXPECT_EQ(wanted, simulated(json::parse(read(std::string(other) + "/stats.json")))) << other;
  EXPECT_EQ(1u, run("s.toml --out r")["notes"].size());
}

TEST_F(ZbufferViews, WhatCannotBeDrawnIsOneLine) {
  write("s.toml", scene(""));
  expect_user_error("run s.toml --set zbuffer_views.layers=0", "zbuffer_views.layers: ");
  expect_user_error("run s.toml --set zbuffer_views.threshold=-0.1", "zbuffer_views.threshold: ");
  expect_user_error("run s.toml --set zbuffer_views.layer=1", "did you mean `layers`?");
  expect_user_error("run s.toml --set object.0.age=90", "object.age: ");
  expect_user_error("run s.toml --set image.width=2000", "image: a picture has at most 1024x1024 pixels");
  write("p.toml", scene("", "tree = \"fir\"\n", "projection = \"perspective\"\nfov_y = 40\nposition = [0.1, 1.2, 0.1]\n"));
  expect_user_error("run p.toml", "camera.position: is inside the tree");
  write("e.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  write("m.toml", scene("", "mesh = \"e.obj\"\n"));
  expect_user_error("run m.toml", "e.obj");
  write("e.obj", "v 0 0 0\nv 1e7 0 0\nv 0 1 0\nf 1 2 3\n");
  expect_user_error("run m.toml", "m.toml:15: object.mesh: a part of it lies 131072 m or more from the origin");
  expect_user_error("run s.toml --set 'object.0.at=[0,0,1e6]'", "object.at: lies 131072 m");
  expect_user_error("run s.toml --set 'camera.position=[0,0,1e6]'", "camera.position: lies 131072 m");
  expect_user_error("run s.toml --machine rds3000", "rds3000 has no firmware for zbuffer_views");
}

TEST_F(ZbufferViews, ASequenceIsNumberedPicturesAndAnAnimation) {
  write("s.toml", scene("frames = 3\nturn = 90\n"));
  const json object = run("s.toml --out o");
  std::vector<std::string> frames;
  for (const std::string& name : names())
    if (name.compare(0, 9, "o/frames/") == 0) frames.push_back(name.substr(9));
  EXPECT_EQ(frames, (std::vector<std::string>{"0000.png", "0001.png", "0002.png"}));
  EXPECT_EQ(read("o/frames/0000.png"), read("o/image.png"));
  EXPECT_NE(read("o/frames/0000.png"), read("o/frames/0001.png"));
  EXPECT_EQ("GIF89a", read("o/animation.gif").substr(0, 6));
  EXPECT_EQ(3, object["facts"]["frames"]);
  run("s.toml --set zbuffer_views.frames=2 --out o");
  const auto now = this->names();
  EXPECT_EQ(2, std::count_if(now.begin(), now.end(), [](const std::string& name) { return name.compare(0, 9, "o/frames/") == 0; }));
}

}  // namespace
}  // namespace dendro::cli
