#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace dendro::trace {

/// What to write of a waveform: times [from, to) in the file's time unit; only the named top scopes, or all
/// if empty.
struct VcdWindow {
  std::int64_t from = 0, to = INT64_MAX;
  std::vector<std::string> units;
};

/// A value change dump (IEEE 1364). Declare all signals, call `start`, then for each time inside the window
/// `at` and `set`. Only changes are written; the first time in the window writes every signal that has a
/// value. Signals outside the window's units cost a branch.
class VcdWriter {
 public:
  using Signal = int;  ///< negative: not in the window's units

  /// Creates the file. Throws UserError when it cannot be written or the window is empty.
  VcdWriter(const std::string& path, VcdWindow window);
  ~VcdWriter();
  VcdWriter(const VcdWriter&) = delete;
  VcdWriter& operator=(const VcdWriter&) = delete;

  /// `unit` is a top scope; `name` may contain dots for scopes below it. width is 1 or more bits.
  Signal add(const std::string& unit, const std::string& name, unsigned width);
  /// Writes the header; `timescale` as in the standard ("1 ps", "100 ns"). Throws UserError for a unit that
  /// has no signal: the message lists those there are.
  void start(const std::string& timescale);

  bool wants(std::int64_t time) const { return time >= window_.from && time < window_.to; }
  /// The time of the following `set` calls; never goes back, inside the window.
  void at(std::int64_t time);
  void set(Signal signal, std::uint64_t value);              ///< up to 64 bits; higher ones are 0
  void set_wide(Signal signal, const std::uint64_t* words);  ///< ceil(width / 64) words, the lowest first
  /// Flushes and closes. Throws UserError when the disk did not take everything.
  void close();

 private:
  struct Declared {
    std::string unit, name, code;
    unsigned width;
    std::size_t first;  ///< index of the value's first word
    bool known = false;
  };
  void emit(Declared& signal);

  std::string path_;
  VcdWindow window_;
  std::ofstream file_;
  std::vector<std::string> seen_units_;
  std::vector<Declared> signals_;
  std::vector<std::uint64_t> values_;
  std::string line_;
  std::int64_t time_ = -1;
  bool started_ = false, time_written_ = false;
};

}  // namespace dendro::trace
