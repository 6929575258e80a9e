#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

struct sqlite3;
struct sqlite3_stmt;

namespace dendro::stats {

/// An SQLite file that belongs to this process while it is open. Everything that goes wrong with the file (another
/// kind or version, locked, full disk, not writable, damaged) is a UserError with the file's name; what was
/// committed before stays.
class Database {
 public:
  /// Opens or makes the file. A new one gets `schema` and is marked with `application` and `version`; one with other
  /// marks is refused. At `read_only` the file must exist and others may have it open.
  Database(const std::string& path, std::int32_t application, int version, const std::string& schema,
           bool read_only = false);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  /// Runs SQL without parameters or results.
  void execute(const std::string& sql);
  const std::string& path() const { return path_; }

 private:
  friend class Statement;
  [[noreturn]] void fail(int code) const;
  void open(bool read_only);
  void check_marks(std::int32_t application, int version) const;

  std::string path_;
  sqlite3* handle_ = nullptr;
};

/// One prepared statement; parameters are bound in their order, columns read in theirs.
class Statement {
 public:
  Statement(Database& database, const std::string& sql);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  Statement& bind(const std::string& text);
  Statement& bind(std::int64_t number);
  Statement& bind(double number);
  Statement& bind_null();

  /// True while there is a row.
  bool step();
  /// Steps to the end and makes the statement ready for other parameters.
  void run();
  void reset();

  std::string text(int column) const;
  std::int64_t integer(int column) const;
  /// Nothing for NULL.
  std::optional<double> real(int column) const;

 private:
  void check(int code) const;

  Database& database_;
  sqlite3_stmt* handle_ = nullptr;
  int bound_ = 0;
};

/// begin ... commit; what is not committed is taken back.
class Transaction {
 public:
  explicit Transaction(Database& database) : database_(database) { database_.execute("BEGIN IMMEDIATE"); }
  ~Transaction();
  void commit();

 private:
  Database& database_;
  bool open_ = true;
};

}  // namespace dendro::stats
