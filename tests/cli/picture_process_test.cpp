#include "tests/cli/cli.h"

namespace dendro::cli {
namespace {

namespace fs = std::filesystem;

class PictureProcess : public CommandTest {
 protected:
  PictureProcess() { write("s.toml", scene_with("solid = \"icosahedron\"\n")); }

  /// Runs a shell's line in the test's folder.
  int shell(const std::string& line) const { return std::system(("cd '" + folder_.string() + "' && (" + line + ") 2>err").c_str()); }

  void expect_two_pictures(const std::string& folder) const {
    EXPECT_EQ(read("wanted/image.png"), read(folder + "/image.png"));
    EXPECT_EQ(read("wanted/image.exr"), read(folder + "/image.exr"));
  }

  /// The command alone, without what belongs to it.
  void copy_command(const std::string& folder) const {
    fs::create_directories(folder_ / folder);
    fs::copy_file(DENDRO, folder_ / folder / "dendro");
  }
};

TEST_F(PictureProcess, IsFoundThroughALinkFromAnyFolderAndAfterAnInstallation) {
  ASSERT_EQ(0, dendro("run s.toml --quiet --out wanted").status);
  ASSERT_FALSE(read("wanted/image.png").empty());
  fs::create_symlink(DENDRO, folder_ / "link");
  EXPECT_EQ(0, shell("./link run s.toml --quiet --out linked")) << read("err");
  expect_two_pictures("linked");
  EXPECT_EQ(0, shell(std::string(CMAKE) + " --install '" + fs::path(DENDRO).parent_path().string() + "' --prefix there >install.log"))
      << read("install.log");
  EXPECT_EQ(0, shell("PATH=there/bin:$PATH dendro run s.toml --quiet --out installed")) << read("err");
  expect_two_pictures("installed");
  EXPECT_EQ(0, shell("there/bin/dendro run aspen-hull --set image.width=32 --set image.height=32 --quiet --out share")) << read("err");
}

TEST_F(PictureProcess, ItsAbsenceIsOneLineBeforeARunBegins) {
  copy_command("alone");
  EXPECT_NE(0, shell("alone/dendro run s.toml --quiet --out r"));
  EXPECT_EQ("dendro: libexec/dendro/dendro-pictures: is missing in " + (fs::canonical(folder_) / "alone").string() +
                " and above it: no picture can be read or written\n",
            read("err"));
  EXPECT_FALSE(fs::exists(folder_ / "r"));
}

TEST_F(PictureProcess, ItsUnexpectedEndIsOneLineAndLeavesNothing) {
  copy_command("bin");
  for (const auto& [ends, how] : {std::pair("exit 3", "status 3"), std::pair("kill -SEGV $$", "signal 11 (Segmentation fault)")}) {
    fs::create_directories(folder_ / "libexec/dendro");
    write("libexec/dendro/dendro-pictures", std::string("#!/bin/sh\n") + ends + "\n");
    fs::permissions(folder_ / "libexec/dendro/dendro-pictures", fs::perms::owner_all);
    EXPECT_NE(0, shell("bin/dendro run s.toml --quiet --out r"));
    const std::string said = read("err");
    EXPECT_EQ(1, std::count(said.begin(), said.end(), '\n')) << said;
    EXPECT_EQ(0u, said.find("dendro: r/image.")) << said;
    EXPECT_NE(std::string::npos, said.find(std::string("the program that reads and writes pictures ended with ") + how)) << said;
    EXPECT_FALSE(fs::exists(folder_ / "r"));
  }
}

TEST_F(PictureProcess, StartsOnlyWhenThereIsAPicture) {
  copy_command("bin");
  EXPECT_EQ(0, shell("bin/dendro machines >out")) << read("err");
  EXPECT_FALSE(read("out").empty());
}

}  // namespace
}  // namespace dendro::cli
