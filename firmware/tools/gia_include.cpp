#include "firmware/tools/gia_include.h"

#include <algorithm>
#include <regex>

#include "firmware/tools/source_error.h"

namespace dendro::tools {
namespace {

class Expansion {
 public:
  explicit Expansion(const IncludeReader& read) : read_(read) {}

  void append(std::string_view text, const std::string& file) {
    result_.parts.push_back({file, line_ + 1});
    int own = 0;
    while (!text.empty()) {
      const std::size_t end = text.find('\n');
      const std::string line(text.substr(0, end));
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      ++own, ++line_;
      if (!take_include(line, file, own)) result_.text += line;
      if (end != std::string_view::npos || !text.empty()) result_.text += '\n';
    }
  }

  ExpandedSource finish() {
    for (std::size_t i = 0; i < wanted_.size(); ++i) {  // grows while included files include more
      const Wanted include = wanted_[i];
      const std::optional<std::string> text = read_ ? read_(include.path) : std::nullopt;
      if (!text)
        throw SourceError(include.file, include.line, 1,
                          "there is no file '" + include.path + "' to include");
      if (!result_.text.empty() && result_.text.back() != '\n') result_.text += '\n';
      append(*text, include.path);
    }
    return std::move(result_);
  }

 private:
  struct Wanted {
    std::string path, file;
    int line = 0;
  };

  bool take_include(const std::string& line, const std::string& file, int number) {
    static const std::regex begins(R"(^\s*include\b.*)"),
        whole(R"re(^\s*include\s*"([^"]+)"\s*;\s*(//.*)?\r?$)re");
    if (!std::regex_match(line, begins)) return false;
    std::smatch match;
    if (!std::regex_match(line, match, whole))
      throw SourceError(file, number, 1, "an include stands on a line of its own: include \"PATH\";");
    const std::string path = match[1];
    const bool again =
        std::any_of(wanted_.begin(), wanted_.end(), [&](const Wanted& w) { return w.path == path; });
    if (!again && path != result_.parts.front().file) wanted_.push_back({path, file, number});
    return true;
  }

  const IncludeReader& read_;
  ExpandedSource result_;
  std::vector<Wanted> wanted_;
  int line_ = 0;
};

}  // namespace

std::pair<std::string, int> ExpandedSource::origin(int line) const {
  const auto after =
      std::find_if(parts.begin() + 1, parts.end(), [&](const Part& p) { return p.first_line > line; });
  const Part& part = *(after - 1);
  return {part.file, line - part.first_line + 1};
}

ExpandedSource expand_includes(std::string_view source, const std::string& file, const IncludeReader& read) {
  Expansion expansion(read);
  expansion.append(source, file);
  return expansion.finish();
}

}  // namespace dendro::tools
