#include <fmt/format.h>

#include <cctype>
#include <filesystem>
#include <regex>
#include <set>

#include "tests/hygiene/rules.h"

namespace dendro::hygiene {
namespace {

struct Link {
  int line;
  std::string path;    ///< below the root; empty: outside the repository
  std::string anchor;  ///< without #
};

/// The page without what stands in fenced blocks; lines keep their numbers.
std::vector<std::string> prose_of(const std::string& text) {
  std::vector<std::string> lines = lines_of(text);
  bool fenced = false;
  for (std::string& line : lines) {
    const bool fence = line.find("```") == 0;
    if (fenced || fence) line.clear();
    if (fence) fenced = !fenced;
  }
  return lines;
}

std::vector<Link> links_of(const std::string& page, const std::string& text) {
  static const std::regex kLink(R"(\[[^\]]*\]\(([^)\s]+)\))");
  std::vector<Link> links;
  int number = 0;
  for (const std::string& line : prose_of(text)) {
    ++number;
    for (std::sregex_iterator at(line.begin(), line.end(), kLink), end; at != end; ++at) {
      const std::string target = (*at)[1];
      if (target.find("://") != std::string::npos || starts_with(target, "mailto:")) continue;
      const auto hash = target.find('#');
      const std::string path = target.substr(0, hash);
      Link link{number, page, hash == std::string::npos ? "" : target.substr(hash + 1)};
      if (!path.empty()) link.path = (std::filesystem::path(folder_of(page)) / path).lexically_normal().string();
      if (ends_with(link.path, "/")) link.path.pop_back();
      links.push_back(link);
    }
  }
  return links;
}

/// Anchors as the usual hosts make them from headings.
std::set<std::string> anchors_of(const std::string& text) {
  std::set<std::string> anchors;
  for (const std::string& line : prose_of(text)) {
    if (!starts_with(line, "#")) continue;
    std::string anchor;
    for (const char c : line.substr(line.find_first_not_of("# "))) {
      const auto u = static_cast<unsigned char>(c);
      if (std::isalnum(u) || c == '-' || c == '_' || u >= 0x80) anchor += static_cast<char>(std::tolower(u));
      if (c == ' ') anchor += '-';
    }
    anchors.insert(anchor);
  }
  return anchors;
}

}  // namespace

Problems broken_links(const Repository& repository) {
  Problems problems;
  for (const auto& [page, text] : repository.files) {
    if (!ends_with(page, ".md")) continue;
    for (const Link& link : links_of(page, text)) {
      if (!repository.has_path(link.path)) {
        problems.push_back(fmt::format("{}:{}: there is no {}", page, link.line, link.path));
      } else if (!link.anchor.empty()) {
        const auto target = repository.files.find(link.path);
        if (target == repository.files.end() || !anchors_of(target->second).count(link.anchor))
          problems.push_back(fmt::format("{}:{}: {} has no heading #{}", page, link.line, link.path, link.anchor));
      }
    }
  }
  return problems;
}

Problems unreachable_pages(const Repository& repository) {
  std::set<std::string> seen = {"README.md"};
  std::vector<std::string> open = {"README.md"};
  while (!open.empty()) {
    const std::string page = open.back();
    open.pop_back();
    const auto text = repository.files.find(page);
    if (text == repository.files.end() || !ends_with(page, ".md")) continue;
    for (const Link& link : links_of(page, text->second))
      if (seen.insert(link.path).second) open.push_back(link.path);
  }
  Problems problems;
  for (const auto& [path, text] : repository.files)
    if ((starts_with(path, "docs/") || ends_with(path, "/README.md")) && !seen.count(path))
      problems.push_back(path + ": no page that README.md leads to links it");
  return problems;
}

Problems named_paths_that_do_not_exist(const Repository& repository) {
  static const std::regex kPath(R"(`((?:sim|models|firmware|tests|docs|traces|cmake)/[A-Za-z0-9_./-]*)`)");
  Problems problems;
  for (const auto& [page, text] : repository.files) {
    if (!ends_with(page, ".md")) continue;
    int number = 0;
    for (const std::string& line : prose_of(text)) {
      ++number;
      for (std::sregex_iterator at(line.begin(), line.end(), kPath), end; at != end; ++at)
        if (!repository.has_path((*at)[1]))
          problems.push_back(fmt::format("{}:{}: there is no {}", page, number, (*at)[1].str()));
    }
  }
  return problems;
}

}  // namespace dendro::hygiene
