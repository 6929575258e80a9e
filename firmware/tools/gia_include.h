#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dendro::tools {

/// Finds the text of an included file by the path that the source gives, or nothing.
using IncludeReader = std::function<std::optional<std::string>(const std::string& path)>;

/// A source with what it includes: its own lines first, unchanged in number, then each included file once.
struct ExpandedSource {
  struct Part {
    std::string file;
    int first_line = 1;  ///< its line 1 is this line of `text`
  };
  std::string text;
  std::vector<Part> parts;  ///< ascending by first_line

  /// Where line `line` of `text` was written.
  std::pair<std::string, int> origin(int line) const;
};

/// Replaces every line `include "PATH";` by an empty one and puts the file's text behind all others; a file
/// that is included again is not repeated. Throws SourceError for a file that `read` does not find or an
/// include line that is wrong.
ExpandedSource expand_includes(std::string_view source, const std::string& file, const IncludeReader& read);

}  // namespace dendro::tools
