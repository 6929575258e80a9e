#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <toml++/toml.h>

#include "tests/hygiene/rules.h"

namespace dendro::hygiene {
namespace {

constexpr const char* kBegin = "<!-- parameters: generated from the presets, see docs/how-to/change-a-parameter.md -->\n";
constexpr const char* kEnd = "<!-- end of parameters -->";

struct Row {
  std::string key;
  const toml::table* entry;
  toml::source_position where;
};

/// Entries in the order of the file.
std::vector<Row> rows_of(const toml::table& preset) {
  std::vector<Row> rows;
  for (const auto& [section, node] : preset) {
    if (!node.is_table()) continue;
    for (const auto& [name, entry] : *node.as_table())
      if (entry.is_table())
        rows.push_back({std::string(section.str()) + "." + std::string(name.str()), entry.as_table(), entry.source().begin});
  }
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.where < b.where; });
  return rows;
}

std::string text_of(const toml::node& node) {
  std::ostringstream text;
  toml::node_view<const toml::node> view(node);
  if (const auto string = view.value_exact<std::string>()) return *string;
  if (const auto real = view.value_exact<double>()) return fmt::format("{}", *real);
  if (const auto integer = view.value_exact<std::int64_t>()) return fmt::format("{}", *integer);
  if (const auto boolean = view.value_exact<bool>()) return *boolean ? "true" : "false";
  return "?";
}

std::string list_of(const toml::array& array, const std::string& between) {
  std::string text;
  for (const toml::node& node : array) text += (text.empty() ? "" : between) + text_of(node);
  return text;
}

std::string range_of(const toml::table& entry) {
  std::string text;
  if (const toml::array* range = entry["range"].as_array()) text = list_of(*range, " to ");
  if (const toml::array* choices = entry["choices"].as_array()) text = list_of(*choices, ", ");
  if (entry["scale"].value_or(std::string()) == "log") text += " (log)";
  const std::string follows = entry["follows"].value_or(std::string());
  if (!follows.empty()) text += (text.empty() ? "" : "; ") + fmt::format("follows `{}`", follows);
  return text;
}

/// The unit that a parameter's name ends in.
std::string unit_of(const std::string& key) {
  static const std::pair<const char*, const char*> kUnits[] = {
      {"_ticks", "ticks"}, {"_ns", "ns"},   {"_us", "us"},      {"_ms", "ms"},       {"_mb_s", "MB/s"},
      {"_m_s", "10^6/s"},  {"_hz", "Hz"},   {"_bytes", "bytes"}, {"_bits", "bits"},  {"_words", "words"},
      {"_entries", "entries"}, {"bits_per_pixel", "bits"}, {"_s", "s"}};
  for (const auto& [end, unit] : kUnits)
    if (ends_with(key, end)) return unit;
  return "";
}

std::string source_of(const toml::table& entry) {
  const std::string source = entry["source"].value_or(std::string());
  if (!starts_with(source, "ASSUMED DEV-")) return source;
  const std::string number = source.substr(12);
  return fmt::format("[DEV-{0}](../deviations.md#dev-{0})", number);
}

std::string table_of(const std::string& title, const toml::table& preset) {
  std::string text = title + "\n\n| parameter | value | unit | range | source |\n| --- | --- | --- | --- | --- |\n";
  for (const Row& row : rows_of(preset)) {
    const toml::node* value = row.entry->get("value");
    text += fmt::format("| `{}` | {} | {} | {} | {} |\n", row.key, value ? text_of(*value) : "", unit_of(row.key),
                        range_of(*row.entry), source_of(*row.entry));
  }
  return text;
}

}  // namespace

std::vector<std::string> machine_pages(const Repository& repository) {
  std::vector<std::string> pages;
  for (const auto& [path, text] : repository.files) {
    if (!starts_with(path, "models/machines/") || !ends_with(path, ".toml")) continue;
    const std::string folder = folder_of(path);
    const std::string page = "docs/machines/" + folder.substr(folder.rfind('/') + 1) + ".md";
    if (pages.empty() || pages.back() != page) pages.push_back(page);
  }
  return pages;
}

std::string with_parameter_table(const Repository& repository, const std::string& page) {
  const std::string name = page.substr(page.rfind('/') + 1, page.size() - page.rfind('/') - 4);
  const std::string folder = "models/machines/" + name + "/";
  std::string whole, changes;
  for (const auto& [path, text] : repository.files) {
    if (!starts_with(path, folder) || !ends_with(path, ".toml")) continue;
    const toml::table preset = toml::parse(text, path);
    const std::string stem = path.substr(folder.size(), path.size() - folder.size() - 5);
    const std::string table = table_of(fmt::format("Preset `{}`: {}", stem, preset["description"].value_or(std::string())), preset);
    (preset.contains("include") ? changes : whole) += table + "\n";
  }
  const auto at = repository.files.find(page);
  const std::string text = at == repository.files.end() ? std::string() : at->second;
  const auto begin = text.find(kBegin), end = text.find(kEnd);
  if (begin == std::string::npos || end == std::string::npos || end < begin) return "";
  return text.substr(0, begin) + kBegin + "\n" + whole + changes + text.substr(end);
}

}  // namespace dendro::hygiene
