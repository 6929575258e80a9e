#include "sim/study/run_folder.h"

#include "tests/core/study/fake_machine.h"

namespace dendro::study {
namespace {

class RunFolderTest : public fake::TestFolder {
 protected:
  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_))
      found.push_back(entry.path().lexically_relative(folder_).string());
    std::sort(found.begin(), found.end());
    return found;
  }
};

TEST_F(RunFolderTest, AppearsWholeAtTheCommit) {
  RunFolder folder(path("a/b/run"));
  folder.write("x", "1");
  EXPECT_FALSE(std::filesystem::exists(path("a/b/run")));
  folder.commit();
  EXPECT_EQ("1", read("a/b/run/x"));
  EXPECT_EQ((std::vector<std::string>{"a", "a/b", "a/b/run", "a/b/run/x"}), names());
}

TEST_F(RunFolderTest, LeavesNothingBehindWithoutACommit) {
  { RunFolder(path("a/b/run")).write("x", "1"); }
  EXPECT_TRUE(names().empty());
}

TEST_F(RunFolderTest, KeepsOtherFilesOfAnExistingFolder) {
  std::filesystem::create_directory(path("run"));
  write("run/mine", "kept");
  write("run/x", "old");
  RunFolder folder(path("run") + "/");
  folder.write("x", "new");
  EXPECT_EQ("old", read("run/x"));
  folder.commit();
  EXPECT_EQ("new", read("run/x"));
  EXPECT_EQ("kept", read("run/mine"));
  EXPECT_EQ(3u, names().size());
}

TEST_F(RunFolderTest, AFileInTheWayIsAUserError) {
  write("file", "");
  EXPECT_EQ("file: cannot write here: it is a file, not a folder",
            error_of([&] { RunFolder f(path("file")); }));
  EXPECT_NE("no error", error_of([&] { RunFolder f(path("file/below/it")); }));
  EXPECT_EQ((std::vector<std::string>{"file"}), names());
}

TEST_F(RunFolderTest, AnOutputFileAppearsAtTheCommit) {
  { OutputFile never(path("x")); }
  EXPECT_TRUE(names().empty());
  OutputFile file(path("x"));
  file.commit("text");
  EXPECT_EQ("text", read("x"));
  EXPECT_EQ(1u, names().size());
  EXPECT_NE("no error", error_of([&] { OutputFile f(path("no/such/folder")); }));
  EXPECT_NE("no error", error_of([&] { OutputFile f(folder_.string()); }));
}

}  // namespace
}  // namespace dendro::study
