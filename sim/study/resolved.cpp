#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "sim/study/run.h"

namespace dendro::study {
namespace {

namespace fs = std::filesystem;
using config::Node;
using config::Value;

std::string quoted(const std::string& text) { return config::to_text(Value(text)); }

std::string relative(const std::string& path, const std::string& folder) {
  const fs::path found = fs::path(path).lexically_relative(fs::absolute(folder).lexically_normal());
  return found.empty() ? path : found.string();
}

/// The scene's own tables; what the run resolved is written from the request instead.
bool is_resolved_key(const std::string& key) {
  for (const char* name : {"machine", "preset", "level", "seed", "name", "image", "parameters", "input",
                           "firmware", "build", "algorithm"})
    if (key == name) return true;
  return false;
}

bool is_list_of_tables(const Node& node) {
  return node.kind == Node::Kind::kArray && !node.items.empty() &&
         node.items.front().kind == Node::Kind::kTable;
}

std::string table_lines(const Node& table) {
  std::string text;
  for (const auto& [key, node] : table.members) text += key + " = " + config::to_toml(node) + "\n";
  return text;
}

/// The plain values, which TOML wants before the first table, and the tables.
std::pair<std::string, std::string> scene_tables(const Node& document, const Algorithm& algorithm, const std::string& folder) {
  std::string values, tables;
  for (const auto& [key, node] : document.members) {
    if (is_resolved_key(key)) continue;
    if (node.kind == Node::Kind::kTable) {
      Node table = node;
      for (const std::string& path : algorithm.path_keys)
        if (Node* file = key == algorithm.name ? table.member(path) : nullptr)
          file->value = relative(std::get<std::string>(file->value), folder);
      tables += "\n[" + key + "]\n" + table_lines(table);
    } else if (is_list_of_tables(node)) {
      for (Node item : node.items) {
        if (Node* mesh = item.member("mesh"); mesh && key == "object")
          mesh->value = relative(std::get<std::string>(mesh->value), folder);
        tables += "\n[[" + key + "]]\n" + table_lines(item);
      }
    } else {
      values += key + " = " + config::to_toml(node) + "\n";
    }
  }
  return {values, tables};
}

std::string section_of(const std::string& key) {
  const auto dot = key.rfind('.');
  return dot == std::string::npos ? "" : key.substr(0, dot);
}

std::string parameter_tables(const config::ParameterSet& parameters) {
  std::string text, section;
  for (const config::Parameter& p : parameters.all()) {
    const std::string in = section_of(p.key);
    if (in != section || text.empty()) text += "\n[parameters" + (in.empty() ? "" : "." + in) + "]\n";
    section = in;
    text += (in.empty() ? p.key : p.key.substr(in.size() + 1)) + " = " + config::to_entry(p) + "\n";
  }
  return text;
}

/// TOML forbids to open a table twice, so parameters of one section stand together.
config::ParameterSet by_section(const config::ParameterSet& parameters) {
  std::vector<config::Parameter> all = parameters.all();
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return section_of(a.key) < section_of(b.key); });
  config::ParameterSet sorted;
  for (auto& p : all) sorted.add(std::move(p));
  return sorted;
}

}  // namespace

std::string resolved_scene(const RunRequest& request, const RunOutput& output, const std::string& folder) {
  const SceneFile& file = request.file;
  const bool built_in = [&] {
    for (const std::string& preset : request.type->presets)
      if (preset == request.preset.name) return true;
    return false;
  }();
  std::string text = "# Everything of one run, resolved. `dendro run` on this file repeats it.\n";
  text += "name = " + quoted(file.scene.name) + "\n";
  text += "algorithm = " + quoted(file.scene.algorithm) + "\n";
  text += "machine = " + quoted(request.type->name + (built_in ? ":" + request.preset.name : "")) + "\n";
  text += "preset = " + quoted(output.object.preset) + "\n";
  text += "level = " + quoted(output.object.level) + "\n";
  text += "seed = " + std::to_string(file.scene.seed) + "\n";
  const auto [values, tables] = scene_tables(file.document, *request.algorithm, folder);
  text += values;
  text += fmt::format("build = {{ dendro = {}, compiler = {} }}\n", quoted(executable_digest()),
                      quoted(compiler_name()));
  text +=
      fmt::format("\n[image]\nwidth = {}\nheight = {}\n", file.scene.image.width, file.scene.image.height);
  text += tables;
  for (const auto& [path, digest] : output.inputs)
    text += "\n[[input]]\npath = " + quoted(relative(path, folder)) + "\nsha256 = " + quoted(digest) + "\n";
  for (const auto& [name, digest] : output.firmware)
    text += "\n[[firmware]]\nname = " + quoted(name) + "\nsha256 = " + quoted(digest) + "\n";
  return text + parameter_tables(by_section(request.preset.parameters));
}

}  // namespace dendro::study
