#include "sim/base/embedded.h"

#include <map>

namespace dendro::base {
namespace {

struct File {
  const char* text = nullptr;
  std::string made;  ///< when first asked for: most runs need few of the files, and programs are large
};

std::map<std::string, File, std::less<>>& table() {
  static std::map<std::string, File, std::less<>> files;
  return files;
}

}  // namespace

EmbeddedFile::EmbeddedFile(const char* path, const char* text) { table()[path].text = text; }

const std::string* embedded_file(std::string_view path) {
  const auto found = table().find(path);
  if (found == table().end()) return nullptr;
  File& file = found->second;
  if (file.made.empty()) file.made = file.text;
  return &file.made;
}

std::vector<std::string> embedded_files(std::string_view folder, std::string_view suffix) {
  std::vector<std::string> paths;
  for (const auto& [path, file] : table()) {
    const bool inside = path.size() > folder.size() && path.compare(0, folder.size(), folder) == 0 &&
                        path[folder.size()] == '/';
    const bool ends = path.size() >= suffix.size() &&
                      path.compare(path.size() - suffix.size(), suffix.size(), suffix) == 0;
    if (inside && ends) paths.push_back(path);
  }
  return paths;
}

}  // namespace dendro::base
