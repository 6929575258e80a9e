#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <variant>
#include <vector>

namespace dendro::scene {

/// Where something was written; `line` 0 means unknown (a --set, say, whose `file` is "--set").
struct Where {
  std::string file;
  int line = 0;
};

/// A value of an algorithm's own table: a scalar or an array of values.
struct OptionValue {
  using Array = std::vector<OptionValue>;
  std::variant<bool, std::int64_t, double, std::string, Array> value;
  Where where;
};

/// The algorithm's own table of a scene. Every getter takes the default for a missing key, marks the key as
/// read, and throws UserError with file:line and key for a wrong type or a value outside the range
/// (inclusive).
class Options {
 public:
  explicit Options(std::string table = {}, Where where = {})
      : table_(std::move(table)), where_(std::move(where)) {}

  void set(const std::string& key, OptionValue value);
  bool has(const std::string& key) const { return values_.count(key) != 0; }

  std::int64_t integer(const std::string& key, std::int64_t otherwise, std::int64_t lowest,
                       std::int64_t highest);
  double real(const std::string& key, double otherwise, double lowest, double highest);
  bool boolean(const std::string& key, bool otherwise);
  std::string text(const std::string& key, const std::string& otherwise);
  /// A word out of `allowed`; `otherwise` must be one of them.
  std::string choice(const std::string& key, const std::string& otherwise,
                     const std::vector<std::string>& allowed);
  /// An array of `otherwise.size()` numbers, each in the range.
  std::vector<double> vector(const std::string& key, const std::vector<double>& otherwise, double lowest,
                             double highest);
  /// An array of vectors of `size` finite numbers each; empty when the key is missing.
  std::vector<std::vector<double>> vectors(const std::string& key, std::size_t size);

  /// Throws UserError for a combination of values that is wrong, blamed on `key` (which may be missing).
  [[noreturn]] void fail(const std::string& key, const std::string& message) const;

  /// Throws UserError for the first key that no getter asked for, naming the nearest known one.
  void finish() const;

  const std::string& table() const { return table_; }
  const std::map<std::string, OptionValue>& values() const { return values_; }

 private:
  const OptionValue* take(const std::string& key);

  std::string table_;
  Where where_;
  std::map<std::string, OptionValue> values_;
  std::set<std::string> known_;
};

}  // namespace dendro::scene
