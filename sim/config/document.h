#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/config/parameters.h"

namespace dendro::config {

/// A TOML value with the place where it was written.
struct Node {
  enum class Kind { kValue, kArray, kTable };
  Kind kind = Kind::kTable;
  Value value;                                        ///< kValue
  std::vector<Node> items;                            ///< kArray
  std::vector<std::pair<std::string, Node>> members;  ///< kTable, in the order of the file
  bool inline_table = false;
  Where where;

  Node* member(const std::string& key);
  const Node* member(const std::string& key) const;
  void erase(const std::string& key);
};

/// Name of a text: a file on disk, or one that was compiled in.
struct DocumentName {
  bool embedded = false;
  std::string path;
};

/// One file's content and the name it was found by.
struct Document {
  DocumentName name;
  Node root;
};

/// Parses TOML. `file` is the name for messages. Throws UserError with file:line.
Node parse_toml(const std::string& text, const std::string& file);

/// The text of a file. Throws UserError at `where` when there is none.
std::string read_text(const DocumentName& name, const Where& where);

/// Finds the document that an include line (or the command line) means; nullopt: it is a path relative to the
/// including document.
using IncludeFinder = std::function<std::optional<DocumentName>(const std::string& include)>;

/// The document and all that it includes with `include = "x"` or `include = ["x", "y"]`, included ones first,
/// each without its include line. Throws UserError for a file that is missing or includes itself, naming the
/// chain.
std::vector<Document> load_documents(const DocumentName& name, const IncludeFinder& find, const Where& where);

/// Puts `over` on top of `under`: tables key by key, everything else as a whole.
void merge(Node& under, const Node& over);

/// Reads the value of `--set key=VALUE`: TOML where it is TOML, else a string.
Node parse_setting(const std::string& text);

/// Splits "a.b=value" of a --set. Throws UserError when there is no key or no `=`.
std::pair<std::string, std::string> split_setting(const std::string& text);

/// Sets the value at a dotted path, making tables on the way; a number as a path part addresses an array's
/// item. Throws UserError when the path leads through something that is no table.
void set_path(Node& root, const std::string& path, const Node& value);

/// The node as TOML on one line: an inline table, an array or a value.
std::string to_toml(const Node& node);

}  // namespace dendro::config
