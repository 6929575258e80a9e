#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <set>
#include <toml++/toml.h>

#include "tests/hygiene/rules.h"

namespace dendro::hygiene {
namespace {

constexpr std::size_t kSoftLines = 400, kHardLines = 800;
constexpr std::size_t kLargestFile = 200'000;
constexpr const char* kLargeFiles = "tests/hygiene/large_files.toml";

std::size_t line_count(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

Problems longer_than(const Repository& repository, std::size_t limit) {
  Problems problems;
  for (const auto& [path, text] : repository.files)
    if ((is_code(path) || ends_with(path, ".gia") || ends_with(path, ".cmake")) && line_count(text) > limit)
      problems.push_back(fmt::format("{}: {} lines, more than {}", path, line_count(text), limit));
  return problems;
}

}  // namespace

Problems oversized_sources(const Repository& repository) { return longer_than(repository, kHardLines); }

Problems long_sources(const Repository& repository) { return longer_than(repository, kSoftLines); }

Problems oversized_data(const Repository& repository) {
  Problems problems;
  toml::table reasons;
  if (const auto list = repository.files.find(kLargeFiles); list != repository.files.end())
    reasons = toml::parse(list->second, std::string(kLargeFiles));
  for (const auto& [path, text] : repository.files) {
    const std::string reason = reasons[path].value_or(std::string());
    if (text.size() > kLargestFile && reason.empty())
      problems.push_back(fmt::format("{}: {} bytes without a reason in {}", path, text.size(), kLargeFiles));
  }
  for (const auto& [path, reason] : reasons) {
    const auto file = repository.files.find(std::string(path.str()));
    if (file == repository.files.end() || file->second.size() <= kLargestFile)
      problems.push_back(fmt::format("{}: {} is not large any more", kLargeFiles, path.str()));
  }
  return problems;
}

Problems machine_traces(const Repository& repository) {
  static const std::regex kTrace(
      R"((^|[^\w.~<])/(work|tmp|root|home|mnt|var|private|Users)/\w|https?://(localhost|[0-9]{1,3}\.[0-9]{1,3}\.|[^/\s)]*:[0-9])|\b(pypi\.org|files\.pythonhosted\.org|registry\.npmjs\.org|proxy\.golang\.org|crates\.io|ghcr\.io|docker\.io|deb\.debian\.org|repo\.maven)\b)");
  Problems problems;
  for (const auto& [path, text] : repository.files) {
    if (!is_text(path) || starts_with(path, "tests/hygiene/")) continue;
    int number = 0;
    for (const std::string& line : lines_of(text)) {
      ++number;
      std::smatch match;
      if (std::regex_search(line, match, kTrace))
        problems.push_back(fmt::format("{}:{}: `{}` belongs to one machine", path, number, match.str()));
    }
  }
  return problems;
}

Problems headers_without_pragma_once(const Repository& repository) {
  Problems problems;
  for (const auto& [path, text] : repository.files)
    if (ends_with(path, ".h") && !starts_with(text, "#pragma once\n"))
      problems.push_back(path + ": does not begin with #pragma once");
  return problems;
}

}  // namespace dendro::hygiene
