#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <string>

#include "sim/base/error.h"
#include "sim/trace/trace_file.h"

namespace dendro::trace {

/// The unit did something else than the trace says; ends a replay.
struct Difference {
  int line = 0;
  std::string text;
};

/// What the replayers of all units share: the reader, the time that `+` counts from, and the comparisons.
class Replayer {
 public:
  /// Times lie in 0 .. `longest` ticks.
  Replayer(Reader& trace, std::int64_t longest) : trace_(trace), longest_(longest) {}

  /// Calls drive(record) for every record until the unit differs, then finish(). Fills in everything but `cycles`.
  template <class Drive, class Finish>
  ReplayResult run(const Drive& drive, const Finish& finish) {
    ReplayResult result;
    Record record;
    try {
      while (trace_.next(record)) {
        drive(record);
        ++result.transactions;
      }
      finish();
    } catch (const Difference& difference) {
      result.difference = fmt::format("{}:{}: {}", trace_.name(), difference.line, difference.text);
    }
    return result;
  }

  template <class Drive>
  ReplayResult run(const Drive& drive) {
    return run(drive, [] {});
  }

  /// The next record, which `by` cannot do without. Throws UserError at the end of the trace.
  void need_next(Record& record, const Record& by) {
    if (!trace_.next(record)) fail(by, fmt::format("the trace ends in the middle of this `{}`", by.op));
  }

  /// The tick before the arrow; completed() is what `+` counts from.
  std::int64_t tick_of(const Record& record) const { return checked(record, record.at.from(completed_)); }
  std::int64_t completed() const { return completed_; }
  void complete(std::int64_t tick) { completed_ = tick; }

  std::int64_t checked(const Record& record, std::int64_t tick) const {
    if (tick < 0 || tick > longest_) fail(record, fmt::format("tick {} is beyond the {} that can be replayed", tick, longest_));
    return tick;
  }
  /// A value before the arrow that must lie within bounds.
  std::int64_t within(const Record& record, const char* what, std::int64_t value, std::int64_t low, std::int64_t high) const {
    if (value < low || value > high) fail(record, fmt::format("{} {} is not within {} to {}", what, value, low, high));
    return value;
  }

  void expect_tick(const Record& record, std::int64_t at, std::int64_t got, const std::string& what) const {
    if (!record.answer_at.given()) return;
    const std::int64_t said = record.answer_at.from(at);
    if (got != said) differ(record, fmt::format("{} at tick {}, the trace says {}", what, got, said));
  }
  void expect_data(const Record& record, std::uint64_t got, const std::string& what) const {
    if (record.answer && record.answer->value != got)
      differ(record, fmt::format("{} is 0x{:x}, the trace says 0x{:x}", what, got, record.answer->value));
  }
  void expect_key(const Record& record, const char* key, std::int64_t got, const std::string& what) const {
    const std::optional<std::int64_t> said = record.expected(key);
    if (said && *said != got) differ(record, fmt::format("{} {}, the trace says {}", what, got, *said));
  }
  void expect_word(const Record& record, const char* key, std::uint64_t got) const {
    const std::optional<std::int64_t> said = record.expected(key);
    if (said && static_cast<std::uint64_t>(*said) != got)
      differ(record, fmt::format("{} is 0x{:x}, the trace says 0x{:x}", key, got, static_cast<std::uint64_t>(*said)));
  }

  [[noreturn]] void differ(const Record& record, const std::string& text) const {
    throw Difference{record.line, text};
  }
  [[noreturn]] void fail(const Record& record, const std::string& message) const {
    throw UserError(trace_.name(), record.line, "", message);
  }

 private:
  Reader& trace_;
  std::int64_t longest_, completed_ = 0;
};

}  // namespace dendro::trace
