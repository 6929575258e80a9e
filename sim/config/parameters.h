#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

namespace dendro::config {

using Value = std::variant<bool, std::int64_t, double, std::string>;

/// Where a key was written; `line` 0 means unknown (a --set, say, whose `file` is "--set").
struct Where {
  std::string file;
  int line = 0;
};

/// How far an assumed parameter may be off: an interval or a list of choices, never both.
struct Spread {
  std::optional<double> low, high;  ///< inclusive
  std::vector<Value> choices;
  bool logarithmic = false;
};

/// One number of a machine with its provenance.
struct Parameter {
  std::string key;  ///< "processor.tick_ns"
  Value value;
  std::optional<Spread> spread;  ///< none: documented
  std::string source;            ///< "FG86 6.1" or "ASSUMED DEV-003"
  std::string follows;           ///< key of the parameter it is tied to, or empty
  Where where;
};

/// The resolved parameters of one machine, in the order of the preset.
class ParameterSet {
 public:
  /// The parameter or nullptr.
  const Parameter* find(const std::string& key) const;
  const std::vector<Parameter>& all() const { return parameters_; }

  void add(Parameter parameter);

  /// Overrides a value. Throws UserError at `where` for an unknown key (with the nearest known one), a value
  /// of another type (an integer serves as a real), or one that is not among a parameter's choices. A value
  /// outside an interval is allowed: that is what a what-if is for. Parameters that follow `key` take the
  /// value too unless they were set themselves.
  void set(const std::string& key, const Value& value, const Where& where);

  /// Sorted DEV ids of all parameters whose source is an assumption.
  std::set<std::string> assumptions() const;

 private:
  std::vector<Parameter> parameters_;
  std::set<std::string> set_keys_;
};

/// Reads parameters into a Spec and finds what nobody read. Every getter throws UserError with file:line and
/// key when the parameter is missing, has another type, or lies outside what is possible at all.
class ParameterReader {
 public:
  explicit ParameterReader(const ParameterSet& set) : set_(set) {}

  std::int64_t integer(const std::string& key, std::int64_t lowest, std::int64_t highest);
  double real(const std::string& key, double lowest, double highest);
  bool boolean(const std::string& key);
  std::string text(const std::string& key, const std::vector<std::string>& allowed);
  /// A choice that may be written as a number or a word: "blanked", 0, 1. Returns it as text.
  std::string choice(const std::string& key, const std::vector<std::string>& allowed);

  /// An error that a combination of parameters makes impossible, blamed on `key`.
  [[noreturn]] void impossible(const std::string& key, const std::string& message) const;

  /// Throws UserError for the first parameter that no getter asked for.
  void finish() const;

 private:
  const Parameter& at(const std::string& key);

  const ParameterSet& set_;
  std::set<std::string> read_;
};

/// A value as it is written in TOML.
std::string to_text(const Value& value);

}  // namespace dendro::config
