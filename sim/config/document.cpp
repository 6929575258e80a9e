#include "sim/config/document.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "sim/base/embedded.h"
#include "sim/base/error.h"

namespace dendro::config {
namespace {

Node convert(const toml::node& node, const std::string& file) {
  Node out;
  out.where = {file, static_cast<int>(node.source().begin.line)};
  if (const auto* table = node.as_table()) {
    out.kind = Node::Kind::kTable;
    out.inline_table = table->is_inline();
    for (const auto& [key, child] : *table) {
      out.members.emplace_back(std::string(key.str()), convert(child, file));
      Where& where = out.members.back().second.where;
      if (key.source().begin.line != 0) where.line = static_cast<int>(key.source().begin.line);
    }
    // toml++ keeps keys sorted by name; the order of the file is what a reader expects to see printed.
    std::stable_sort(out.members.begin(), out.members.end(),
                     [](const auto& a, const auto& b) { return a.second.where.line < b.second.where.line; });
  } else if (const auto* array = node.as_array()) {
    out.kind = Node::Kind::kArray;
    for (const auto& item : *array) out.items.push_back(convert(item, file));
  } else {
    out.kind = Node::Kind::kValue;
    if (const auto* b = node.as_boolean())
      out.value = b->get();
    else if (const auto* i = node.as_integer())
      out.value = i->get();
    else if (const auto* d = node.as_floating_point())
      out.value = d->get();
    else if (const auto* s = node.as_string())
      out.value = s->get();
    else
      throw UserError(file, out.where.line, "", "dates and times have no meaning here");
  }
  return out;
}

std::string chain_text(const std::vector<std::string>& chain, const std::string& last) {
  std::string text;
  for (const std::string& name : chain) text += name + " -> ";
  return text + last;
}

DocumentName relative_to(const DocumentName& including, const std::string& include) {
  namespace fs = std::filesystem;
  if (fs::path(include).is_absolute()) return {false, include};
  return {including.embedded, (fs::path(including.path).parent_path() / include).lexically_normal().string()};
}

std::string identity(const DocumentName& name) {
  if (name.embedded) return ":" + name.path;
  std::error_code error;
  const auto path = std::filesystem::weakly_canonical(name.path, error);
  return error ? name.path : path.string();
}

bool exists(const DocumentName& name) {
  if (name.embedded) return base::embedded_file(name.path) != nullptr;
  std::error_code error;
  return std::filesystem::is_regular_file(name.path, error);
}

std::vector<std::pair<std::string, Where>> take_includes(Node& document) {
  std::vector<std::pair<std::string, Where>> includes;
  const Node* line = document.member("include");
  if (line == nullptr) return includes;
  const std::vector<Node> items = line->kind == Node::Kind::kArray ? line->items : std::vector<Node>{*line};
  for (const Node& item : items) {
    if (item.kind != Node::Kind::kValue || !std::holds_alternative<std::string>(item.value))
      throw UserError(item.where.file, item.where.line, "include",
                      "a file name or a list of them is expected");
    includes.emplace_back(std::get<std::string>(item.value), item.where);
  }
  document.erase("include");
  return includes;
}

struct Walk {
  const IncludeFinder& find;
  std::vector<std::string> chain;       // paths, for messages
  std::vector<std::string> identities;  // the same files, comparable
  std::vector<Document> documents;
};

void load(Walk& walk, const DocumentName& name, const Where& where) {
  const std::string id = identity(name);
  if (std::find(walk.identities.begin(), walk.identities.end(), id) != walk.identities.end())
    throw UserError(where.file, where.line, "include",
                    "the file includes itself: " + chain_text(walk.chain, name.path));
  if (!walk.chain.empty() && !exists(name))
    throw UserError(where.file, where.line, "include",
                    "there is no file " + name.path + ": " + chain_text(walk.chain, name.path));
  Node document = parse_toml(read_text(name, where), name.path);
  walk.chain.push_back(name.path);
  walk.identities.push_back(id);
  for (const auto& [include, at] : take_includes(document)) {
    const auto found = walk.find ? walk.find(include) : std::nullopt;
    load(walk, found ? *found : relative_to(name, include), at);
  }
  walk.chain.pop_back();
  walk.identities.pop_back();
  walk.documents.push_back({name, std::move(document)});
}

bool is_index(const std::string& part) {
  return !part.empty() && part.size() < 7 &&
         std::all_of(part.begin(), part.end(), [](unsigned char c) { return std::isdigit(c); });
}

Node* step_into(Node& node, const std::string& part, const std::string& path) {
  if (node.kind == Node::Kind::kArray) {
    if (!is_index(part) || std::stoul(part) >= node.items.size())
      throw UserError(
          "--set", 0, path,
          fmt::format("`{}` addresses a list of {} items, numbered from 0", part, node.items.size()));
    return &node.items[std::stoul(part)];
  }
  if (node.kind != Node::Kind::kTable)
    throw UserError("--set", 0, path, "`" + part + "` would lie inside a value, not a table");
  if (Node* found = node.member(part)) return found;
  node.members.emplace_back(part, Node{});
  node.members.back().second.where = {"--set", 0};
  return &node.members.back().second;
}

std::string bare_or_quoted(const std::string& key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-';
  });
  return bare ? key : to_text(Value(key));
}

}  // namespace

Node* Node::member(const std::string& key) {
  for (auto& [name, node] : members)
    if (name == key) return &node;
  return nullptr;
}

const Node* Node::member(const std::string& key) const { return const_cast<Node*>(this)->member(key); }

void Node::erase(const std::string& key) {
  members.erase(std::remove_if(members.begin(), members.end(), [&](const auto& m) { return m.first == key; }),
                members.end());
}

Node parse_toml(const std::string& text, const std::string& file) {
  try {
    const toml::table table = toml::parse(text, file);
    Node node = convert(table, file);
    node.where.line = 0;
    return node;
  } catch (const toml::parse_error& error) {
    std::string message(error.description());
    std::replace(message.begin(), message.end(), '\n', ' ');
    throw UserError(file, static_cast<int>(error.source().begin.line), "", "not valid TOML: " + message);
  }
}

std::string read_text(const DocumentName& name, const Where& where) {
  if (name.embedded) {
    const std::string* text = base::embedded_file(name.path);
    if (text == nullptr)
      throw UserError(where.file, where.line, "", "there is no built-in file " + name.path);
    return *text;
  }
  std::error_code error;
  std::ifstream in(name.path, std::ios::binary);
  if (!in || std::filesystem::is_directory(name.path, error))
    throw UserError(name.path, 0, "", "cannot read the file");
  return std::string(std::istreambuf_iterator<char>(in), {});
}

std::vector<Document> load_documents(const DocumentName& name, const IncludeFinder& find,
                                     const Where& where) {
  Walk walk{find, {}, {}, {}};
  load(walk, name, where);
  return std::move(walk.documents);
}

void merge(Node& under, const Node& over) {
  if (under.kind != Node::Kind::kTable || over.kind != Node::Kind::kTable) {
    under = over;
    return;
  }
  for (const auto& [key, node] : over.members) {
    if (Node* found = under.member(key))
      merge(*found, node);
    else
      under.members.emplace_back(key, node);
  }
}

Node parse_setting(const std::string& text) {
  Node value;
  try {
    const Node document = parse_toml("value = " + text, "--set");
    if (document.members.size() != 1) throw UserError("more than one value");
    value = document.members.front().second;
  } catch (const UserError&) {
    value.kind = Node::Kind::kValue;
    value.value = text;
  }
  const std::function<void(Node&)> place = [&](Node& node) {
    node.where = {"--set", 0};
    for (Node& item : node.items) place(item);
    for (auto& [key, child] : node.members) place(child);
  };
  place(value);
  return value;
}

std::pair<std::string, std::string> split_setting(const std::string& text) {
  const auto at = text.find('=');
  const auto strip = [](std::string s) {
    s.erase(0, s.find_first_not_of(" \t"));
    s.erase(s.find_last_not_of(" \t") + 1);
    return s;
  };
  if (at == std::string::npos || strip(text.substr(0, at)).empty())
    throw UserError("--set", 0, text, "the form is key=value, as in image.width=256");
  return {strip(text.substr(0, at)), strip(text.substr(at + 1))};
}

void set_path(Node& root, const std::string& path, const Node& value) {
  std::stringstream parts(path + ".");
  Node* at = &root;
  for (std::string part; std::getline(parts, part, '.');) {
    if (part.empty()) throw UserError("--set", 0, path, "an empty part in the key");
    at = step_into(*at, part, path);
  }
  *at = value;
}

std::string to_toml(const Node& node) {
  std::string text;
  switch (node.kind) {
    case Node::Kind::kValue:
      return to_text(node.value);
    case Node::Kind::kArray:
      for (const Node& item : node.items) text += (text.empty() ? "" : ", ") + to_toml(item);
      return "[" + text + "]";
    case Node::Kind::kTable:
      for (const auto& [key, child] : node.members)
        text += (text.empty() ? " " : ", ") + bare_or_quoted(key) + " = " + to_toml(child);
      return "{" + text + (text.empty() ? "}" : " }");
  }
  return text;
}

}  // namespace dendro::config
