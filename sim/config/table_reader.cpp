#include "sim/config/table_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "sim/base/error.h"
#include "sim/config/nearest.h"

namespace dendro::config {
namespace {

std::optional<double> number_of(const Node& node) {
  if (node.kind != Node::Kind::kValue) return std::nullopt;
  if (const auto* i = std::get_if<std::int64_t>(&node.value)) return static_cast<double>(*i);
  if (const auto* d = std::get_if<double>(&node.value))
    if (std::isfinite(*d)) return *d;
  return std::nullopt;
}

std::string bound(double v) { return std::isinf(v) ? "any" : fmt::format("{}", v); }

}  // namespace

TableReader::TableReader(const Node& table, std::string path) : table_(table), path_(std::move(path)) {
  if (table_.kind != Node::Kind::kTable)
    throw UserError(table_.where.file, table_.where.line, path_, "must be a table");
}

const Node* TableReader::node(const std::string& key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
  return table_.member(key);
}

const Node* TableReader::table(const std::string& key) {
  const Node* found = node(key);
  if (found != nullptr && found->kind != Node::Kind::kTable) fail(key, "must be a table");
  return found;
}

std::int64_t TableReader::integer(const std::string& key, std::int64_t otherwise, std::int64_t lowest,
                                  std::int64_t highest) {
  const Node* found = node(key);
  if (found == nullptr) return otherwise;
  const auto* value = found->kind == Node::Kind::kValue ? std::get_if<std::int64_t>(&found->value) : nullptr;
  if (value == nullptr) fail(key, fmt::format("must be an integer in {}..{}", lowest, highest));
  if (*value < lowest || *value > highest)
    fail(key, fmt::format("{} is impossible, allowed are {}..{}", *value, lowest, highest));
  return *value;
}

double TableReader::real(const std::string& key, double otherwise, double lowest, double highest) {
  const Node* found = node(key);
  if (found == nullptr) return otherwise;
  const auto value = number_of(*found);
  if (!value) fail(key, fmt::format("must be a finite number from {} to {}", bound(lowest), bound(highest)));
  if (*value < lowest || *value > highest)
    fail(key, fmt::format("{} is impossible, allowed are {} to {}", *value, bound(lowest), bound(highest)));
  return *value;
}

std::string TableReader::text(const std::string& key, const std::string& otherwise) {
  const Node* found = node(key);
  if (found == nullptr) return otherwise;
  const auto* value = found->kind == Node::Kind::kValue ? std::get_if<std::string>(&found->value) : nullptr;
  if (value == nullptr || value->empty()) fail(key, "must be a string and not empty");
  return *value;
}

std::string TableReader::choice(const std::string& key, const std::string& otherwise,
                                const std::vector<std::string>& allowed) {
  const std::string value = text(key, otherwise);
  if (value != otherwise && std::find(allowed.begin(), allowed.end(), value) == allowed.end())
    fail(key, fmt::format("\"{}\" is not known, allowed are {}", value, fmt::join(allowed, ", ")));
  return value;
}

std::vector<double> TableReader::numbers(const std::string& key, const std::vector<double>& otherwise,
                                         std::size_t count) {
  const Node* found = node(key);
  if (found == nullptr) return otherwise;
  std::vector<double> values;
  for (const Node& item : found->items)
    if (const auto value = number_of(item)) values.push_back(*value);
  if (found->kind != Node::Kind::kArray || found->items.size() != count || values.size() != count)
    fail(key, fmt::format("must be a list of {} finite numbers", count));
  return values;
}

Where TableReader::where(const std::string& key) const {
  const Node* found = table_.member(key);
  return found ? found->where : table_.where;
}

std::string TableReader::full_key(const std::string& key) const {
  return path_.empty() ? key : path_ + "." + key;
}

void TableReader::fail(const std::string& key, const std::string& message) const {
  const Where at = where(key);
  throw UserError(at.file, at.line, full_key(key), message);
}

void TableReader::finish() const {
  for (const auto& [key, node] : table_.members)
    if (std::find(known_.begin(), known_.end(), key) == known_.end())
      fail(key, "unknown key" + did_you_mean(key, known_));
}

}  // namespace dendro::config
