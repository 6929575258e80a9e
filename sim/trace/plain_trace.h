#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace dendro::trace {

/// One access of a memory trace from elsewhere.
struct PlainAccess {
  enum Kind : std::uint8_t { kRead, kWrite, kFetch };
  std::uint64_t time = 0;  ///< never less than that of the access before
  Kind kind = kRead;
  std::uint64_t address = 0;
  unsigned size = 4;  ///< bytes: 1, 2 or 4
};

/// Reads a memory trace of another program, a line at a time: `time op address [size]`, or Dinero's `label address`, where
/// every instruction fetch begins a new unit of time. docs/formats.md has the grammar.
class PlainReader {
 public:
  /// `name` is for messages. Throws UserError when nothing stands in it.
  PlainReader(std::string bytes, std::string name);

  /// The next access; false at the end. Throws UserError with file:line for a line that is none.
  bool next(PlainAccess& access);
  const std::string& name() const { return name_; }

 private:
  bool next_line(std::string_view& line);
  std::string_view word(std::string_view& line) const;
  PlainAccess::Kind kind_of(std::string_view word) const;
  std::uint64_t number(std::string_view word, const char* what, bool always_hex) const;
  [[noreturn]] void fail(const std::string& message) const;

  std::string bytes_, name_;
  std::size_t at_ = 0;
  int line_ = 0;
  unsigned columns_ = 0;  ///< of the first line: 2 is Dinero's
  std::uint64_t time_ = 0;
};

}  // namespace dendro::trace
