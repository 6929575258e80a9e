#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/config/document.h"

namespace dendro::config {

/// Reads a TOML table key by key and finds what nobody read. Every getter takes the default for a missing key
/// and throws UserError with file:line and the whole key for a wrong type or an impossible value.
class TableReader {
 public:
  /// `path` is the table's own key ("camera", "object.0"), empty for the root.
  TableReader(const Node& table, std::string path);

  bool has(const std::string& key) const { return table_.member(key) != nullptr; }
  /// The node as it is, marked as read; nullptr when missing.
  const Node* node(const std::string& key);
  /// A member that must be a table, or nullptr.
  const Node* table(const std::string& key);

  std::int64_t integer(const std::string& key, std::int64_t otherwise, std::int64_t lowest,
                       std::int64_t highest);
  /// Inclusive bounds; never nan or infinite.
  double real(const std::string& key, double otherwise, double lowest, double highest);
  std::string text(const std::string& key, const std::string& otherwise);
  std::string choice(const std::string& key, const std::string& otherwise,
                     const std::vector<std::string>& allowed);
  /// `count` finite numbers.
  std::vector<double> numbers(const std::string& key, const std::vector<double>& otherwise,
                              std::size_t count);

  /// Throws UserError blamed on `key` (or on the table, if it is not there).
  [[noreturn]] void fail(const std::string& key, const std::string& message) const;
  Where where(const std::string& key) const;
  std::string full_key(const std::string& key) const;

  /// Throws UserError for the first key that no getter asked for, naming the nearest known one.
  void finish() const;

 private:
  const Node& table_;
  std::string path_;
  std::vector<std::string> known_;
};

}  // namespace dendro::config
