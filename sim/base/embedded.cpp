#include "sim/base/embedded.h"

#include <map>

namespace dendro::base {
namespace {

std::map<std::string, std::string, std::less<>>& table() {
  static std::map<std::string, std::string, std::less<>> files;
  return files;
}

}  // namespace

EmbeddedFile::EmbeddedFile(const char* path, const char* text) { table()[path] = text; }

const std::string* embedded_file(std::string_view path) {
  const auto found = table().find(path);
  return found == table().end() ? nullptr : &found->second;
}

std::vector<std::string> embedded_files(std::string_view folder, std::string_view suffix) {
  std::vector<std::string> paths;
  for (const auto& [path, text] : table()) {
    const bool inside = path.size() > folder.size() && path.compare(0, folder.size(), folder) == 0 &&
                        path[folder.size()] == '/';
    const bool ends = path.size() >= suffix.size() &&
                      path.compare(path.size() - suffix.size(), suffix.size(), suffix) == 0;
    if (inside && ends) paths.push_back(path);
  }
  return paths;
}

}  // namespace dendro::base
