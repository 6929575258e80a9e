#include "sim/stats/database.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include "sim/base/error.h"

namespace dendro::stats {
namespace {

std::int64_t pragma(sqlite3* handle, const char* name, int& code) {
  sqlite3_stmt* statement = nullptr;
  std::int64_t value = 0;
  code = sqlite3_prepare_v2(handle, fmt::format("PRAGMA {}", name).c_str(), -1, &statement, nullptr);
  if (code == SQLITE_OK) code = sqlite3_step(statement);
  if (code == SQLITE_ROW) value = sqlite3_column_int64(statement, 0);
  sqlite3_finalize(statement);
  if (code == SQLITE_ROW || code == SQLITE_DONE) code = SQLITE_OK;
  return value;
}

}  // namespace

Database::Database(const std::string& path, std::int32_t application, int version, const std::string& schema,
                   bool read_only)
    : path_(path) {
  try {
    open(read_only);
    int code = SQLITE_OK;
    const std::int64_t tables = pragma(handle_, "schema_version", code);
    if (code != SQLITE_OK) fail(code);
    if (tables != 0 || read_only) {
      check_marks(application, version);
      return;
    }
    Transaction transaction(*this);
    execute(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}", application, version));
    execute(schema);
    transaction.commit();
  } catch (...) {
    sqlite3_close(handle_);
    throw;
  }
}

void Database::open(bool read_only) {
  const int flags = read_only ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  const int code = sqlite3_open_v2(path_.c_str(), &handle_, flags, nullptr);
  if (code != SQLITE_OK) fail(code);
  if (read_only) return;
  // Held from here to the end, so that two writers cannot make the same runs.
  execute("PRAGMA locking_mode = EXCLUSIVE; BEGIN EXCLUSIVE; COMMIT");
}

void Database::check_marks(std::int32_t application, int version) const {
  int code = SQLITE_OK;
  if (pragma(handle_, "application_id", code) != application) {
    if (code != SQLITE_OK) fail(code);
    throw UserError(path_, 0, "", "this database was not made by this command of dendro");
  }
  const std::int64_t found = pragma(handle_, "user_version", code);
  if (code != SQLITE_OK) fail(code);
  if (found != version)
    throw UserError(path_, 0, "",
                    fmt::format("its results are of version {}, this dendro reads and writes version {}; use another "
                                "folder",
                                found, version));
}

Database::~Database() { sqlite3_close(handle_); }

void Database::fail(int code) const {
  const int kind = code & 0xFF;
  if (kind == SQLITE_BUSY || kind == SQLITE_LOCKED)
    throw UserError(path_, 0, "", "the database is locked: another program is using it");
  if (kind == SQLITE_NOTADB || kind == SQLITE_CORRUPT)
    throw UserError(path_, 0, "", "this is no SQLite database, or it is damaged");
  if (kind == SQLITE_FULL) throw UserError(path_, 0, "", "cannot write here: the disk is full");
  if (kind == SQLITE_IOERR) throw UserError(path_, 0, "", "cannot write here: the disk is full or fails");
  if (kind == SQLITE_READONLY || kind == SQLITE_CANTOPEN || kind == SQLITE_PERM)
    throw UserError(path_, 0, "", "cannot write here: permission denied, or no such folder");
  throw std::runtime_error(fmt::format("{}: {}", path_, handle_ ? sqlite3_errmsg(handle_) : sqlite3_errstr(code)));
}

void Database::execute(const std::string& sql) {
  const int code = sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(sqlite3_extended_errcode(handle_));
}

Statement::Statement(Database& database, const std::string& sql) : database_(database) {
  check(sqlite3_prepare_v2(database_.handle_, sql.c_str(), -1, &handle_, nullptr));
}

Statement::~Statement() { sqlite3_finalize(handle_); }

void Statement::check(int code) const {
  if (code != SQLITE_OK) database_.fail(sqlite3_extended_errcode(database_.handle_));
}

Statement& Statement::bind(const std::string& text) {
  check(sqlite3_bind_text(handle_, ++bound_, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT));
  return *this;
}

Statement& Statement::bind(std::int64_t number) {
  check(sqlite3_bind_int64(handle_, ++bound_, number));
  return *this;
}

Statement& Statement::bind(double number) {
  check(sqlite3_bind_double(handle_, ++bound_, number));
  return *this;
}

Statement& Statement::bind_null() {
  check(sqlite3_bind_null(handle_, ++bound_));
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(handle_);
  if (code != SQLITE_ROW && code != SQLITE_DONE) database_.fail(sqlite3_extended_errcode(database_.handle_));
  return code == SQLITE_ROW;
}

void Statement::run() {
  while (step()) {
  }
  reset();
}

void Statement::reset() {
  sqlite3_reset(handle_);
  bound_ = 0;
}

std::string Statement::text(int column) const {
  const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(handle_, column));
  return bytes ? std::string(bytes, static_cast<std::size_t>(sqlite3_column_bytes(handle_, column))) : std::string();
}

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(handle_, column); }

std::optional<double> Statement::real(int column) const {
  if (sqlite3_column_type(handle_, column) == SQLITE_NULL) return std::nullopt;
  return sqlite3_column_double(handle_, column);
}

Transaction::~Transaction() {
  if (!open_) return;
  try {
    database_.execute("ROLLBACK");
  } catch (...) {
    // SQLite has rolled back by itself after the error that brought us here.
  }
}

void Transaction::commit() {
  database_.execute("COMMIT");
  open_ = false;
}

}  // namespace dendro::stats
