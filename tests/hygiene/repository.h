#pragma once

#include <map>
#include <string>
#include <vector>

namespace dendro::hygiene {

/// Files of a repository by their path below its root: the real one, or a few made up by a test.
struct Repository {
  std::map<std::string, std::string> files;

  bool has(const std::string& path) const { return files.count(path) != 0; }
  /// True for a file or for a folder that holds one.
  bool has_path(const std::string& path) const;
};

/// What a rule found wrong, a line each: "path:line: what".
using Problems = std::vector<std::string>;

/// The committed files and those that could be; without git, everything but build, out and hidden folders.
const Repository& repository();

/// One text with the problems, for a test's message; empty when there are none.
std::string joined(const Problems& problems);

bool starts_with(const std::string& text, const std::string& start);
bool ends_with(const std::string& text, const std::string& end);
/// The path up to its last slash, without it.
std::string folder_of(const std::string& path);
std::vector<std::string> lines_of(const std::string& text);
/// Sources, pages, scripts and configuration: what people write by hand.
bool is_text(const std::string& path);
/// C++ of ours.
bool is_code(const std::string& path);

}  // namespace dendro::hygiene
