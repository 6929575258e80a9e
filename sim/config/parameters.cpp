#include "sim/config/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "sim/base/check.h"
#include "sim/base/error.h"
#include "sim/config/nearest.h"

namespace dendro::config {
namespace {

const char* type_name(const Value& value) {
  static const char* const kNames[] = {"true or false", "an integer", "a number", "a string"};
  return kNames[value.index()];
}

/// `value` in the type of `like`, where that loses nothing.
std::optional<Value> as_type_of(const Value& like, const Value& value) {
  if (like.index() == value.index()) return value;
  if (std::holds_alternative<double>(like) && std::holds_alternative<std::int64_t>(value))
    return Value(static_cast<double>(std::get<std::int64_t>(value)));
  return std::nullopt;
}

std::string list_of(const std::vector<Value>& values) {
  std::string text;
  for (const Value& v : values) text += (text.empty() ? "" : ", ") + to_text(v);
  return text;
}

std::string list_of(const std::vector<std::string>& values) {
  std::string text;
  for (const auto& v : values) text += (text.empty() ? "" : ", ") + v;
  return text;
}

std::string bare_text(const Value& value) {
  return std::holds_alternative<std::string>(value) ? std::get<std::string>(value) : to_text(value);
}

bool is_assumption(const Parameter& p) { return p.source.compare(0, 7, "ASSUMED") == 0; }

std::string what_if_source(const Where& where) {
  if (where.line == 0) return "what-if: " + where.file;
  const auto slash = where.file.rfind('/');
  return fmt::format("what-if: {}:{}", slash == std::string::npos ? where.file : where.file.substr(slash + 1),
                     where.line);
}

Value checked_value(const Parameter& p, const Value& value, const Where& where) {
  const bool from_choices = p.spread && !p.spread->choices.empty();
  if (from_choices) {
    for (const Value& choice : p.spread->choices) {
      const auto same = as_type_of(choice, value);
      if (same && *same == choice) return choice;
    }
    throw UserError(where.file, where.line, p.key,
                    fmt::format("{} is none of its choices: {}", to_text(value), list_of(p.spread->choices)));
  }
  const auto converted = as_type_of(p.value, value);
  if (!converted)
    throw UserError(where.file, where.line, p.key,
                    fmt::format("{} is not {}, as this parameter is", to_text(value), type_name(p.value)));
  return *converted;
}

}  // namespace

const Parameter* ParameterSet::find(const std::string& key) const {
  for (const Parameter& p : parameters_)
    if (p.key == key) return &p;
  return nullptr;
}

void ParameterSet::add(Parameter parameter) {
  DENDRO_CHECK(find(parameter.key) == nullptr, "{} is there already", parameter.key);
  parameters_.push_back(std::move(parameter));
}

void ParameterSet::set(const std::string& key, const Value& value, const Where& where) {
  const auto found =
      std::find_if(parameters_.begin(), parameters_.end(), [&](const Parameter& p) { return p.key == key; });
  if (found == parameters_.end()) {
    std::vector<std::string> keys;
    for (const Parameter& p : parameters_) keys.push_back(p.key);
    throw UserError(where.file, where.line, key,
                    "the machine has no such parameter" + did_you_mean(key, keys));
  }
  found->value = checked_value(*found, value, where);
  found->where = where;
  found->source = what_if_source(where);
  found->follows.clear();
  set_keys_.insert(key);
  std::set<std::string> moved = {key};
  for (bool again = true; again;) {
    again = false;
    for (Parameter& p : parameters_) {
      if (set_keys_.count(p.key) || !moved.count(p.follows) || moved.count(p.key)) continue;
      p.value = checked_value(p, value, where);
      p.where = where;
      again = moved.insert(p.key).second || again;
    }
  }
}

std::set<std::string> ParameterSet::assumptions() const {
  std::set<std::string> ids;
  for (const Parameter& p : parameters_) {
    if (!is_assumption(p)) continue;
    for (std::size_t at = p.source.find("DEV-"); at != std::string::npos;
         at = p.source.find("DEV-", at + 4)) {
      std::size_t end = at + 4;
      while (end < p.source.size() && std::isdigit(static_cast<unsigned char>(p.source[end]))) ++end;
      ids.insert(p.source.substr(at, end - at));
    }
  }
  return ids;
}

const Parameter& ParameterReader::at(const std::string& key) {
  read_.insert(key);
  const Parameter* p = set_.find(key);
  if (p == nullptr) {
    const Where where = set_.all().empty() ? Where{} : set_.all().front().where;
    throw UserError(where.file, 0, key, "this parameter of the machine is missing");
  }
  return *p;
}

std::int64_t ParameterReader::integer(const std::string& key, std::int64_t lowest, std::int64_t highest) {
  const Parameter& p = at(key);
  if (!std::holds_alternative<std::int64_t>(p.value))
    throw UserError(p.where.file, p.where.line, key, to_text(p.value) + " is not an integer");
  const std::int64_t v = std::get<std::int64_t>(p.value);
  if (v < lowest || v > highest)
    throw UserError(p.where.file, p.where.line, key,
                    fmt::format("{} is impossible, allowed are {} to {}", v, lowest, highest));
  return v;
}

double ParameterReader::real(const std::string& key, double lowest, double highest) {
  const Parameter& p = at(key);
  const auto converted = as_type_of(Value(0.0), p.value);
  if (!converted) throw UserError(p.where.file, p.where.line, key, to_text(p.value) + " is not a number");
  const double v = std::get<double>(*converted);
  if (!(v >= lowest && v <= highest))
    throw UserError(p.where.file, p.where.line, key,
                    fmt::format("{} is impossible, allowed are {} to {}", v, lowest, highest));
  return v;
}

bool ParameterReader::boolean(const std::string& key) {
  const Parameter& p = at(key);
  if (!std::holds_alternative<bool>(p.value))
    throw UserError(p.where.file, p.where.line, key, to_text(p.value) + " is not true or false");
  return std::get<bool>(p.value);
}

std::string ParameterReader::text(const std::string& key, const std::vector<std::string>& allowed) {
  const Parameter& p = at(key);
  if (!std::holds_alternative<std::string>(p.value))
    throw UserError(p.where.file, p.where.line, key, to_text(p.value) + " is not a string");
  return choice(key, allowed);
}

std::string ParameterReader::choice(const std::string& key, const std::vector<std::string>& allowed) {
  const Parameter& p = at(key);
  const std::string v = bare_text(p.value);
  if (std::find(allowed.begin(), allowed.end(), v) == allowed.end())
    throw UserError(p.where.file, p.where.line, key,
                    fmt::format("{} is impossible, allowed are {}", to_text(p.value), list_of(allowed)));
  return v;
}

void ParameterReader::impossible(const std::string& key, const std::string& message) const {
  const Parameter* p = set_.find(key);
  const Where where = p ? p->where : Where{};
  throw UserError(where.file, where.line, key, message);
}

void ParameterReader::finish() const {
  const std::vector<std::string> known(read_.begin(), read_.end());
  for (const Parameter& p : set_.all())
    if (!read_.count(p.key))
      throw UserError(p.where.file, p.where.line, p.key,
                      "the machine has no such parameter" + did_you_mean(p.key, known));
}

std::string to_text(const Value& value) {
  if (const auto* b = std::get_if<bool>(&value)) return *b ? "true" : "false";
  if (const auto* i = std::get_if<std::int64_t>(&value)) return std::to_string(*i);
  if (const auto* d = std::get_if<double>(&value)) {
    if (std::isnan(*d)) return "nan";
    if (std::isinf(*d)) return *d < 0 ? "-inf" : "inf";
    std::string text = fmt::format("{}", *d);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return text;
  }
  std::string text = "\"";
  for (const char c : std::get<std::string>(value)) {
    if (c == '"' || c == '\\')
      text += std::string("\\") + c;
    else if (static_cast<unsigned char>(c) < 0x20)
      text += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      text += c;
  }
  return text + '"';
}

}  // namespace dendro::config
