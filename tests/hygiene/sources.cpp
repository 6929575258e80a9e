#include <fmt/format.h>

#include <regex>
#include <set>
#include <toml++/toml.h>

#include "tests/hygiene/rules.h"

namespace dendro::hygiene {
namespace {

constexpr const char* kSourcesPage = "docs/sources.md";
constexpr const char* kDeviationsPage = "docs/deviations.md";

bool is_preset(const std::string& path) { return starts_with(path, "models/machines/") && ends_with(path, ".toml"); }

/// First cells of the tables of docs/sources.md.
std::set<std::string> listed_keys(const Repository& repository) {
  static const std::regex kRow(R"(^\| `?([A-Z0-9][A-Z0-9-]+)`? \|)");
  std::set<std::string> keys;
  const auto page = repository.files.find(kSourcesPage);
  if (page == repository.files.end()) return keys;
  std::smatch match;
  for (const std::string& line : lines_of(page->second))
    if (std::regex_search(line, match, kRow)) keys.insert(match[1]);
  return keys;
}

/// A word that can only be a key: capitals with a digit or a hyphen, or a mark.
bool like_key(const std::string& word) {
  static const std::regex kKey(R"([A-Z0-9]*[A-Z][A-Z0-9]*(-[A-Z0-9]+)*)");
  static const std::set<std::string> kWords = {"DER", "GEN", "ENG", "HINTS", "ASSUMED"};
  if (kWords.count(word)) return true;
  return word.size() >= 4 && std::regex_match(word, kKey) && word.find_first_of("0123456789-") != std::string::npos;
}

/// FG86-K9 is part of FG86 unless it is listed itself.
bool known(const std::string& word, const std::set<std::string>& keys) {
  static const std::regex kClaim(R"((.+)-[A-Z][0-9]+[a-z]?)");
  std::smatch match;
  return keys.count(word) || (std::regex_match(word, match, kClaim) && keys.count(match[1]));
}

/// The citation's parts ("FG86 2.2, 6; rest ASSUMED DEV-001") each begin with a key or continue the one before.
void check_citation(const std::string& citation, const std::string& at, const std::set<std::string>& keys,
                    bool must_begin_with_key, Problems& problems) {
  static const std::regex kPart(R"([^,;:]+)");
  static const std::regex kWord(R"([A-Za-z0-9-]+)");
  bool first = true;
  for (std::sregex_iterator part(citation.begin(), citation.end(), kPart), end; part != end; ++part) {
    const std::string text = part->str();
    std::smatch match;
    const std::string word = std::regex_search(text, match, kWord) ? match.str() : "";
    if (!known(word, keys) && (like_key(word) || (first && must_begin_with_key)))
      problems.push_back(fmt::format("{}: `{}` is no key of {}", at, word, kSourcesPage));
    first = false;
  }
}

void check_table(const toml::table& table, const std::string& prefix, const std::string& path,
                 const std::set<std::string>& keys, Problems& problems) {
  static const std::regex kAssumed(R"(ASSUMED DEV-[0-9]{3})");
  for (const auto& [name, node] : table) {
    const std::string key = prefix + std::string(name.str());
    const std::string at = fmt::format("{}:{}: {}", path, node.source().begin.line, key);
    const bool plain_text = prefix.empty() && (name == "include" || name == "description" || name == "machine");
    if (plain_text) continue;
    const toml::table* entry = node.as_table();
    if (entry != nullptr && !entry->contains("value") && !entry->contains("source") && !entry->contains("follows")) {
      check_table(*entry, key + ".", path, keys, problems);
      continue;
    }
    const std::string source = entry ? (*entry)["source"].value_or(std::string()) : std::string();
    if (source.empty()) {
      problems.push_back(at + ": has no source");
    } else if (starts_with(source, "ASSUMED")) {
      if (!std::regex_match(source, kAssumed)) problems.push_back(at + ": an assumption names one DEV");
      if (!entry->contains("range") && !entry->contains("choices") && !entry->contains("follows"))
        problems.push_back(at + ": an assumption has a range or choices");
    } else {
      check_citation(source, at, keys, true, problems);
    }
  }
}

/// Text of a line that can hold citations: all of a page's, the comment of a line of code.
std::string citing_part(const std::string& path, const std::string& line) {
  if (ends_with(path, ".md")) return line;
  if (!is_code(path) && !ends_with(path, ".gia") && !ends_with(path, ".toml")) return "";
  const auto comment = line.find(ends_with(path, ".toml") ? "#" : "//");
  return comment == std::string::npos ? "" : line.substr(comment);
}

std::map<std::string, std::string> deviations_used(const Repository& repository, bool only_where_assumed) {
  static const std::regex kDeviation(R"(DEV-[0-9]{3})");
  std::map<std::string, std::string> used;
  for (const auto& [path, text] : repository.files) {
    if (!is_text(path) || path == kDeviationsPage) continue;
    const bool assumed_here = starts_with(path, "models/") || starts_with(path, "firmware/") || starts_with(path, "sim/");
    if (only_where_assumed && !assumed_here) continue;
    int number = 0;
    for (const std::string& line : lines_of(text)) {
      ++number;
      for (std::sregex_iterator at(line.begin(), line.end(), kDeviation), end; at != end; ++at)
        used.emplace(at->str(), fmt::format("{}:{}", path, number));
    }
  }
  return used;
}

/// Sections of docs/deviations.md by their DEV.
std::map<std::string, std::string> deviation_sections(const Repository& repository) {
  static const std::regex kHeading(R"(^### (DEV-[0-9]{3})$)");
  std::map<std::string, std::string> sections;
  const auto page = repository.files.find(kDeviationsPage);
  if (page == repository.files.end()) return sections;
  std::string current;
  std::smatch match;
  for (const std::string& line : lines_of(page->second)) {
    if (starts_with(line, "#")) current = std::regex_match(line, match, kHeading) ? match[1].str() : "";
    if (!current.empty()) sections[current] += line + "\n";
  }
  return sections;
}

std::set<std::string> test_names(const Repository& repository) {
  static const std::regex kTest(R"(^TEST(?:_F|_P)?\((\w+), *(\w+)\))");
  std::set<std::string> names;
  for (const auto& [path, text] : repository.files) {
    if (!starts_with(path, "tests/") || !ends_with(path, ".cpp")) continue;
    for (const std::string& line : lines_of(text)) {
      std::smatch match;
      if (starts_with(line, "TEST") && std::regex_search(line, match, kTest))
        names.insert(match[1].str() + "." + match[2].str());
    }
  }
  return names;
}

/// Parameter key to DEV, over all presets.
std::map<std::string, std::string> assumed_parameters(const Repository& repository) {
  std::map<std::string, std::string> assumed;
  for (const auto& [path, text] : repository.files) {
    if (!is_preset(path)) continue;
    const toml::table preset = toml::parse(text, path);
    for (const auto& [section, node] : preset) {
      const toml::table* entries = node.as_table();
      if (entries == nullptr) continue;
      for (const auto& [name, entry] : *entries) {
        const std::string source = entry.is_table() ? (*entry.as_table())["source"].value_or(std::string()) : "";
        if (starts_with(source, "ASSUMED "))
          assumed[std::string(section.str()) + "." + std::string(name.str())] = source.substr(8);
      }
    }
  }
  return assumed;
}

}  // namespace

Problems presets_without_source(const Repository& repository) {
  Problems problems;
  const std::set<std::string> keys = listed_keys(repository);
  for (const auto& [path, text] : repository.files) {
    if (!is_preset(path)) continue;
    try {
      check_table(toml::parse(text, path), "", path, keys, problems);
    } catch (const toml::parse_error& error) {
      problems.push_back(fmt::format("{}: {}", path, error.description()));
    }
  }
  return problems;
}

Problems unresolved_keys(const Repository& repository) {
  // A bracket after a word or a bracket is an index or a link's other half; one before "(" is a link.
  static const std::regex kBracket(R"((^|[^\w\]\)`])\[([^\[\]]+)\](?!\())");
  Problems problems;
  const std::set<std::string> keys = listed_keys(repository);
  for (const auto& [path, text] : repository.files) {
    if (!is_text(path) || starts_with(path, "tests/hygiene/")) continue;
    int number = 0;
    for (const std::string& line : lines_of(text)) {
      ++number;
      const std::string part = citing_part(path, line);
      if (part.find('[') == std::string::npos) continue;
      for (std::sregex_iterator at(part.begin(), part.end(), kBracket), end; at != end; ++at)
        check_citation((*at)[2], fmt::format("{}:{}", path, number), keys, false, problems);
    }
  }
  return problems;
}

Problems unlisted_or_unused_deviations(const Repository& repository) {
  Problems problems;
  const auto sections = deviation_sections(repository);
  for (const auto& [deviation, where] : deviations_used(repository, false))
    if (!sections.count(deviation)) problems.push_back(fmt::format("{}: {} is not in {}", where, deviation, kDeviationsPage));
  const auto used = deviations_used(repository, true);
  for (const auto& [deviation, section] : sections)
    if (!used.count(deviation))
      problems.push_back(fmt::format("{}: {} is named nowhere in models, firmware or sim", kDeviationsPage, deviation));
  return problems;
}

Problems incomplete_deviations(const Repository& repository) {
  static const char* const kQuestions[] = {"- Why: ", "- Range: ", "- Effect: ", "- Settled by: ", "- Pinned by: "};
  static const std::regex kTest(R"(`(\w+\.\w+)`)");
  Problems problems;
  const auto sections = deviation_sections(repository);
  const std::set<std::string> tests = test_names(repository);
  for (const auto& [deviation, section] : sections) {
    for (const char* question : kQuestions)
      if (section.find(question) == std::string::npos)
        problems.push_back(fmt::format("{}: {} has no line `{}`", kDeviationsPage, deviation, question));
    const auto pinned = section.find("- Pinned by: ");
    const std::string names = pinned == std::string::npos ? "" : section.substr(pinned);
    std::sregex_iterator at(names.begin(), names.end(), kTest), end;
    if (at == end) problems.push_back(fmt::format("{}: {} names no test", kDeviationsPage, deviation));
    for (; at != end; ++at)
      if (!tests.count((*at)[1]))
        problems.push_back(fmt::format("{}: {}: there is no test {}", kDeviationsPage, deviation, (*at)[1].str()));
  }
  for (const auto& [key, deviation] : assumed_parameters(repository)) {
    const auto section = sections.find(deviation);
    if (section != sections.end() && section->second.find("`" + key + "`") == std::string::npos)
      problems.push_back(fmt::format("{}: {} does not name `{}`, which rests on it", kDeviationsPage, deviation, key));
  }
  return problems;
}

}  // namespace dendro::hygiene
