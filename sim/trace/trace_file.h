#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/trace/boundary.h"
#include "sim/trace/record.h"

namespace dendro::trace {

constexpr int kFormatVersion = 1;

/// A line `set KEY VALUE` or `parameter KEY ENTRY` of a header, with its place.
struct HeaderSetting {
  std::string key, text;
  int line = 0;
};

/// The text at the head of a trace. docs/formats.md has its grammar.
struct Header {
  std::string machine;                    ///< "rds3000:fg86"
  std::string boundary;                   ///< "rds3000.frame_memory"
  std::string source;                     ///< what was recorded, or empty
  double clock_hz = 0;                    ///< 0: not said
  std::int64_t from = 0;                  ///< first tick of the recorded window
  std::vector<HeaderSetting> parameters;  ///< the whole Spec, an entry each; empty: that of the preset
  std::vector<HeaderSetting> settings;    ///< on top of it
  int machine_line = 0, boundary_line = 0;
};

/// Gathers the records of one boundary within a window of time. Compresses as it goes.
class Writer {
 public:
  /// Records of ticks [from, to).
  Writer(std::string boundary, std::int64_t from, std::int64_t to, bool as_text);
  ~Writer();

  const std::string& boundary() const { return boundary_; }
  std::int64_t from() const { return from_; }
  std::int64_t to() const { return to_; }

  void add(const Record& record);
  std::int64_t records() const { return records_; }

  /// The bytes of the file. Call once, at the end.
  std::string file(const Header& header);

 private:
  struct Compressor;
  std::string boundary_;
  std::int64_t from_, to_;
  bool as_text_;
  std::int64_t records_ = 0;
  std::string lines_;
  std::unique_ptr<Compressor> compressor_;
};

/// Reads a trace in either form, record by record.
class Reader {
 public:
  /// `name` is for messages. Throws UserError for what is no trace, truncated, corrupt, or of a newer format.
  Reader(std::string bytes, std::string name);
  ~Reader();

  const Header& header() const { return header_; }
  const std::string& name() const { return name_; }
  bool is_text() const { return decompressor_ == nullptr; }

  /// The operations that next() admits; without, all.
  void expect(const Boundary& boundary) { boundary_ = boundary; }

  /// Reads the next record; false at the end. Throws UserError for a line that is none.
  bool next(Record& record);
  /// Makes next() begin with the first record again.
  void rewind();

 private:
  struct Decompressor;
  bool next_line(std::string_view& line);
  bool header_line(std::string_view line);
  void read_header();
  bool signed_off() const;  ///< the last line is a checksum
  void check_envelope();
  void check(const Record& record) const;
  void check_singles(const Record& record, const std::vector<std::string>& allowed) const;
  void check_keys(const Record& record, const Keys& keys, const std::vector<std::string>& known) const;
  [[noreturn]] void fail(int line, const std::string& message) const;

  std::string name_, bytes_;
  Header header_;
  std::optional<Boundary> boundary_;
  std::int64_t records_ = -1;   ///< promised by the header; -1: hand-written
  std::int64_t read_ = 0;
  std::size_t body_ = 0, body_end_ = 0, at_ = 0;
  int header_lines_ = 0, line_ = 0;
  std::int64_t packed_ = -1;    ///< compressed bytes; -1: text
  std::unique_ptr<Decompressor> decompressor_;
};

/// The header as its lines.
std::string header_text(const Header& header);

}  // namespace dendro::trace
