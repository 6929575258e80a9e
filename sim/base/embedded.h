#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace dendro::base {

/// A text file that was compiled in (presets, scenes, microcode). Instances are made by cmake/embed.cmake only.
class EmbeddedFile {
 public:
  EmbeddedFile(const char* path, const char* text);
};

/// The text of an embedded file by its path from the repository root, or nullptr.
const std::string* embedded_file(std::string_view path);

/// Paths of all embedded files below `folder` that end in `suffix`, sorted.
std::vector<std::string> embedded_files(std::string_view folder, std::string_view suffix);

}  // namespace dendro::base
