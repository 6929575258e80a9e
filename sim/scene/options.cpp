#include "sim/scene/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/base/check.h"
#include "sim/base/error.h"

namespace dendro::scene {
namespace {

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replaced}));
    }
  }
  return row[b.size()];
}

const double* as_double(const OptionValue& value, double& storage) {
  if (const auto* i = std::get_if<std::int64_t>(&value.value))
    storage = static_cast<double>(*i);
  else if (const auto* d = std::get_if<double>(&value.value))
    storage = *d;
  else
    return nullptr;
  return &storage;
}

}  // namespace

void Options::set(const std::string& key, OptionValue value) { values_[key] = std::move(value); }

const OptionValue* Options::take(const std::string& key) {
  known_.insert(key);
  const auto found = values_.find(key);
  return found == values_.end() ? nullptr : &found->second;
}

void Options::fail(const std::string& key, const std::string& message) const {
  const auto found = values_.find(key);
  const Where& where = found == values_.end() ? where_ : found->second.where;
  throw UserError(where.file, where.line, table_.empty() ? key : table_ + "." + key, message);
}

std::int64_t Options::integer(const std::string& key, std::int64_t otherwise, std::int64_t lowest,
                              std::int64_t highest) {
  const OptionValue* value = take(key);
  if (value == nullptr) return otherwise;
  const auto* number = std::get_if<std::int64_t>(&value->value);
  if (number == nullptr) fail(key, fmt::format("must be an integer in {}..{}", lowest, highest));
  if (*number < lowest || *number > highest)
    fail(key, fmt::format("{} is outside the allowed {}..{}", *number, lowest, highest));
  return *number;
}

double Options::real(const std::string& key, double otherwise, double lowest, double highest) {
  const OptionValue* value = take(key);
  if (value == nullptr) return otherwise;
  double number = 0;
  if (as_double(*value, number) == nullptr)
    fail(key, fmt::format("must be a number in {}..{}", lowest, highest));
  if (!(number >= lowest && number <= highest))
    fail(key, fmt::format("{} is outside the allowed {}..{}", number, lowest, highest));
  return number;
}

bool Options::boolean(const std::string& key, bool otherwise) {
  const OptionValue* value = take(key);
  if (value == nullptr) return otherwise;
  const auto* flag = std::get_if<bool>(&value->value);
  if (flag == nullptr) fail(key, "must be true or false");
  return *flag;
}

std::string Options::text(const std::string& key, const std::string& otherwise) {
  const OptionValue* value = take(key);
  if (value == nullptr) return otherwise;
  const auto* word = std::get_if<std::string>(&value->value);
  if (word == nullptr) fail(key, "must be a string");
  return *word;
}

std::string Options::choice(const std::string& key, const std::string& otherwise,
                            const std::vector<std::string>& allowed) {
  DENDRO_CHECK(std::find(allowed.begin(), allowed.end(), otherwise) != allowed.end(), "key {}", key);
  const OptionValue* value = take(key);
  if (value == nullptr) return otherwise;
  const auto* word = std::get_if<std::string>(&value->value);
  if (word == nullptr || std::find(allowed.begin(), allowed.end(), *word) == allowed.end())
    fail(key, fmt::format("{}must be one of {}", word ? "\"" + *word + "\" is not known; " : "",
                          fmt::join(allowed, ", ")));
  return *word;
}

std::vector<double> Options::vector(const std::string& key, const std::vector<double>& otherwise,
                                    double lowest, double highest) {
  const OptionValue* value = take(key);
  if (value == nullptr) return otherwise;
  const std::string allowed =
      fmt::format("must be an array of {} numbers in {}..{}", otherwise.size(), lowest, highest);
  const auto* items = std::get_if<OptionValue::Array>(&value->value);
  if (items == nullptr || items->size() != otherwise.size()) fail(key, allowed);
  std::vector<double> numbers;
  for (const OptionValue& item : *items) {
    double number = 0;
    if (as_double(item, number) == nullptr || !(number >= lowest && number <= highest)) fail(key, allowed);
    numbers.push_back(number);
  }
  return numbers;
}

std::vector<std::vector<double>> Options::vectors(const std::string& key, std::size_t size) {
  const OptionValue* value = take(key);
  std::vector<std::vector<double>> result;
  if (value == nullptr) return result;
  const std::string allowed = fmt::format("must be an array of arrays of {} finite numbers", size);
  const auto* rows = std::get_if<OptionValue::Array>(&value->value);
  if (rows == nullptr) fail(key, allowed);
  for (const OptionValue& row : *rows) {
    const auto* items = std::get_if<OptionValue::Array>(&row.value);
    if (items == nullptr || items->size() != size) fail(key, allowed);
    std::vector<double> numbers;
    for (const OptionValue& item : *items) {
      double number = 0;
      if (as_double(item, number) == nullptr || !std::isfinite(number)) fail(key, allowed);
      numbers.push_back(number);
    }
    result.push_back(std::move(numbers));
  }
  return result;
}

void Options::finish() const {
  for (const auto& entry : values_) {
    if (known_.count(entry.first) != 0) continue;
    std::string nearest;
    std::size_t best = entry.first.size() / 2 + 2;
    for (const std::string& known : known_) {
      const std::size_t distance = edit_distance(entry.first, known);
      if (distance < best) best = distance, nearest = known;
    }
    fail(entry.first, nearest.empty() ? fmt::format("unknown key; allowed: {}", fmt::join(known_, ", "))
                                      : fmt::format("unknown key; did you mean {}?", nearest));
  }
}

}  // namespace dendro::scene
