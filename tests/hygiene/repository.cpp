#include "tests/hygiene/repository.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace dendro::hygiene {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> listed_by_git(const std::string& root) {
  const std::string command = "git -C '" + root + "' ls-files -z -co --exclude-standard 2>&-";
  std::vector<std::string> paths;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return paths;
  std::string path;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
    if (c != '\0') {
      path += static_cast<char>(c);
      continue;
    }
    paths.push_back(path);
    path.clear();
  }
  if (pclose(pipe) != 0) paths.clear();
  return paths;
}

std::vector<std::string> walked(const fs::path& root) {
  std::vector<std::string> paths;
  for (auto entry = fs::recursive_directory_iterator(root); entry != fs::recursive_directory_iterator(); ++entry) {
    const std::string name = entry->path().filename().string();
    const bool top = entry.depth() == 0;
    if (entry->is_directory() && ((top && (name == "build" || name == "out")) || name == ".git"))
      entry.disable_recursion_pending();
    if (entry->is_regular_file()) paths.push_back(fs::relative(entry->path(), root).string());
  }
  return paths;
}

Repository load(const std::string& root) {
  std::vector<std::string> paths = listed_by_git(root);
  if (paths.empty()) paths = walked(root);
  Repository repository;
  for (const std::string& path : paths) {
    std::ifstream in(fs::path(root) / path, std::ios::binary);
    if (!in) continue;  // deleted, not yet committed
    std::ostringstream text;
    text << in.rdbuf();
    repository.files[path] = text.str();
  }
  return repository;
}

}  // namespace

bool Repository::has_path(const std::string& path) const {
  const auto at = files.lower_bound(path);
  if (at != files.end() && at->first == path) return true;
  const std::string folder = ends_with(path, "/") ? path : path + "/";
  const auto inside = files.lower_bound(folder);
  return inside != files.end() && starts_with(inside->first, folder);
}

const Repository& repository() {
  static const Repository loaded = load(REPOSITORY);
  return loaded;
}

std::string joined(const Problems& problems) {
  std::string text;
  for (const std::string& problem : problems) text += problem + "\n";
  return text;
}

bool starts_with(const std::string& text, const std::string& start) { return text.compare(0, start.size(), start) == 0; }

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::string folder_of(const std::string& path) {
  const auto slash = path.rfind('/');
  return slash == std::string::npos ? "" : path.substr(0, slash);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

bool is_text(const std::string& path) {
  static const char* const kEndings[] = {".h", ".cpp", ".md", ".toml", ".gia", ".cmake", "CMakeLists.txt", ".json", ".py"};
  return path == "dev" || path == ".ci/run" ||
         std::any_of(std::begin(kEndings), std::end(kEndings), [&](const char* end) { return ends_with(path, end); });
}

bool is_code(const std::string& path) { return ends_with(path, ".h") || ends_with(path, ".cpp"); }

}  // namespace dendro::hygiene
