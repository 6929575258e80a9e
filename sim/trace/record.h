#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace dendro::trace {

/// A number of a record; how it was written decides how it is written again.
struct Number {
  std::uint64_t value = 0;  ///< negative ones in two's complement; of a single, its 32 bits
  bool hex = false;
  bool single = false;  ///< written with a point: IEEE single precision
};

inline Number decimal(std::int64_t value) { return {static_cast<std::uint64_t>(value), false}; }
inline Number hex(std::uint64_t value) { return {value, true}; }
/// The bits of an IEEE single; written with a point unless it is not finite.
Number single(std::uint32_t bits);

/// `@T`, `+T`, or nothing.
struct When {
  enum class Kind : std::uint8_t { kNone, kAbsolute, kRelative };
  Kind kind = Kind::kNone;
  std::int64_t ticks = 0;

  static When at(std::int64_t tick) { return {Kind::kAbsolute, tick}; }
  static When after(std::int64_t ticks) { return {Kind::kRelative, ticks}; }
  bool given() const { return kind != Kind::kNone; }
  /// The tick meant, counted from `origin` where it is relative.
  std::int64_t from(std::int64_t origin) const { return kind == Kind::kRelative ? origin + ticks : ticks; }
};

using Keys = std::vector<std::pair<std::string, Number>>;

/// One line of a trace: `@T|+T op value ... [key=value ...] [-> [@T|+T] [data] [key=value ...]]`. What stands
/// before the arrow is done to the unit, what stands after it is expected of it.
struct Record {
  int line = 0;  ///< in the text form of the trace, 1 is the first
  When at;
  std::string op;
  std::vector<Number> values;
  Keys keys;
  When answer_at;  ///< relative: after `at`
  std::optional<Number> answer;
  Keys answer_keys;

  std::int64_t value(std::size_t i, std::int64_t otherwise = 0) const {
    return i < values.size() ? static_cast<std::int64_t>(values[i].value) : otherwise;
  }
  std::int64_t key(std::string_view name, std::int64_t otherwise = 0) const;
  /// The expected value of a key; nullopt: not checked.
  std::optional<std::int64_t> expected(std::string_view name) const;
  bool has(std::string_view name) const;
};

/// The record as its line, without a line's end.
std::string to_text(const Record& record);
void append_text(const Record& record, std::string& text);

/// Reads a line into `record`; `#` starts a comment. Returns false when nothing stands in it. Throws UserError with
/// file:line.
bool parse_record(std::string_view text, const std::string& file, int line, Record& record);

}  // namespace dendro::trace
