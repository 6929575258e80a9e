#pragma once

#include <cstdint>
#include <fstream>
#include <string>

namespace dendro::trace {

/// A pipeline log in the Kanata format, version 0004, as the viewer Konata reads it: words, the stages they
/// are in, lanes over one another. `at` first, then what happens at that time.
class KanataWriter {
 public:
  /// Creates the file. Throws UserError when it cannot be written.
  explicit KanataWriter(const std::string& path);

  /// The clock of the following calls; never goes back.
  void at(std::int64_t clock);
  /// A new word; `id` counts from 0 in the order of these calls, `number` is the machine's own.
  void begin(std::uint64_t id, std::uint64_t number);
  /// `kind` 0: beside the word; 1: under the mouse.
  void text(std::uint64_t id, unsigned kind, const std::string& text);
  void stage(std::uint64_t id, unsigned lane, const char* name);  ///< begins
  void end(std::uint64_t id, unsigned lane, const char* name);
  /// The last that is said of a word. `order` counts the words that were not flushed.
  void retire(std::uint64_t id, std::uint64_t order, bool flushed);
  /// Flushes and closes. Throws UserError when the disk did not take everything.
  void close();

 private:
  void pass();

  std::string path_;
  std::ofstream file_;
  std::int64_t clock_ = 0, written_ = -1;
};

}  // namespace dendro::trace
