#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

/// Runs the built command in a folder of the test's own.
namespace dendro::cli {

struct Result {
  int status = -1;
  std::string out, err;
};

class CommandTest : public ::testing::Test {
 protected:
  CommandTest() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    // The process is in the name: two trees may be tested at once.
    std::string name = "dendro_cli_" + std::to_string(::getpid()) + "_" + info->test_suite_name() + "_" + info->name();
    std::replace(name.begin(), name.end(), '/', '_');
    base_ = std::filesystem::path(::testing::TempDir()) / name;
    folder_ = base_ / "work";
    std::filesystem::remove_all(base_);
    std::filesystem::create_directories(folder_);
  }
  ~CommandTest() override { std::filesystem::remove_all(base_); }

  /// `arguments` is a shell's text; the working directory is the test's folder.
  Result dendro(const std::string& arguments) const {
    const std::string out = (base_ / "out").string(), err = (base_ / "err").string();
    const std::string line = "cd '" + folder_.string() + "' && XDG_CACHE_HOME='" +
                             (base_ / "cache").string() + "' '" DENDRO "' " + arguments + " >'" + out +
                             "' 2>'" + err + "' </dev/null";
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status), text_of(out), text_of(err)};
  }

  /// The same with files that cannot grow beyond so many blocks of 512 bytes, which stands for a full disk.
  Result dendro_within(int blocks, const std::string& arguments) const {
    const std::string limited = (base_ / "limited.sh").string();
    std::ofstream(limited) << "ulimit -f " << blocks << "\nexec '" DENDRO "' " << arguments << "\n";
    const std::string out = (base_ / "out").string(), err = (base_ / "err").string();
    // Pipes, as the limit holds for the command's messages, too.
    const std::string line = "cd '" + folder_.string() + "' && { sh '" + limited + "' 2>&1 >/dev/null </dev/null; echo $? >'" +
                             out + "'; } | cat >'" + err + "'";
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? std::atoi(text_of(out).c_str()) : 1000, "", text_of(err)};
  }

  /// The object that `dendro run` writes with these arguments; its files are gone again.
  nlohmann::json ran(const std::string& arguments) const {
    const Result run = dendro("run " + arguments + " --out o --json o.json --quiet");
    if (run.status != 0) throw std::runtime_error(arguments + ": exit " + std::to_string(run.status) + "\n" + run.err);
    const nlohmann::json object = nlohmann::json::parse(read("o.json"));
    std::filesystem::remove_all(folder_ / "o");
    std::filesystem::remove(folder_ / "o.json");
    return object;
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  std::string read(const std::string& name) const { return text_of((folder_ / name).string()); }

  /// All names in the test's folder, sorted.
  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_))
      found.push_back(entry.path().lexically_relative(folder_).string());
    std::sort(found.begin(), found.end());
    return found;
  }

  /// Exit 2, nothing on standard output, one line on standard error that holds `wanted`, and no new file.
  void expect_user_error(const std::string& arguments, const std::string& wanted) const {
    const auto before = names();
    const Result result = dendro(arguments);
    EXPECT_EQ(2, result.status) << arguments << "\n" << result.err;
    EXPECT_EQ("", result.out) << arguments;
    EXPECT_EQ(1, std::count(result.err.begin(), result.err.end(), '\n')) << result.err;
    EXPECT_EQ(0u, result.err.find("dendro: ")) << result.err;
    EXPECT_NE(std::string::npos, result.err.find(wanted)) << "wanted: " << wanted << "\ngot: " << result.err;
    EXPECT_EQ(before, names()) << arguments;
  }

  std::filesystem::path base_, folder_;

 private:
  static std::string text_of(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  }
};

/// A scene with one object, given by its lines.
inline std::string scene_with(const std::string& object, const std::string& more = "") {
  return "algorithm = \"half_space\"\nmachine = \"rds3000:fg86\"\n"
         "[image]\nwidth = 64\nheight = 64\n"
         "[camera]\nheight = 3.0\nposition = [1, 2, 5]\ntarget = [0, 0, 0]\n"
         "[[object]]\n" +
         object + more;
}

/// A tetrahedron as an OBJ file.
inline const char* const kTetrahedron =
    "v 1 1 1\nv -1 -1 1\nv -1 1 -1\nv 1 -1 -1\nf 1 2 4\nf 1 3 2\nf 1 4 3\nf 2 3 4\n";

}  // namespace dendro::cli
