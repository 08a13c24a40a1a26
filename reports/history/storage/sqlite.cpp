#include "reports/history/storage/sqlite.hpp"

#include <sqlite3.h>

#include <cerrno>

namespace fieldproof::history {

namespace {

/// Longer than any of our own transactions, a first `add` on a slow disk too.
constexpr int patience_ms = 30'000;

[[noreturn]] void raise(sqlite3* database, int code) {
  if (!database) throw SqliteError(SQLITE_NOMEM, 0, sqlite3_errstr(SQLITE_NOMEM));
  const int primary = code & 0xFF;
  const bool of_the_system = primary == SQLITE_IOERR || primary == SQLITE_CANTOPEN;
  int system_error = sqlite3_system_errno(database);
  if (of_the_system && system_error == 0) system_error = errno;  // a commit does not hand it on
  throw SqliteError(primary, of_the_system ? system_error : 0, sqlite3_errmsg(database));
}

void check(sqlite3* database, int code) {
  if (code != SQLITE_OK) raise(database, code);
}

}  // namespace

Statement::Statement(sqlite3* database, std::string_view sql) : database_(database) {
  sqlite3_stmt* statement = nullptr;
  check(database, sqlite3_prepare_v2(database, sql.data(), static_cast<int>(sql.size()), &statement,
                                     nullptr));
  statement_.reset(statement);
}

void Statement::Close::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

bool Statement::next() {
  errno = 0;
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  raise(database_, code);
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

double Statement::real(int column) const { return sqlite3_column_double(statement_.get(), column); }

std::string_view Statement::text(int column) const {
  const unsigned char* text = sqlite3_column_text(statement_.get(), column);
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
  return text ? std::string_view(reinterpret_cast<const char*>(text), size) : std::string_view();
}

std::string_view Statement::blob(int column) const {
  const void* bytes = sqlite3_column_blob(statement_.get(), column);
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
  return bytes ? std::string_view(static_cast<const char*>(bytes), size) : std::string_view();
}

bool Statement::is_null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

void Statement::reset() {
  sqlite3_reset(statement_.get());  // it repeats the error of the last step, which was told
}

void Statement::bind(int at, std::int64_t value) {
  check(database_, sqlite3_bind_int64(statement_.get(), at, value));
}

void Statement::bind(int at, double value) {
  check(database_, sqlite3_bind_double(statement_.get(), at, value));
}

void Statement::bind(int at, std::string_view value) {
  check(database_, sqlite3_bind_text64(statement_.get(), at, value.empty() ? "" : value.data(),
                                       value.size(), SQLITE_STATIC, SQLITE_UTF8));
}

void Statement::bind(int at, Blob value) {
  check(database_,
        sqlite3_bind_blob64(statement_.get(), at, value.bytes.empty() ? "" : value.bytes.data(),
                            value.bytes.size(), SQLITE_STATIC));
}

void Statement::bind(int at, std::nullptr_t) {
  check(database_, sqlite3_bind_null(statement_.get(), at));
}

Database::Database(const std::string& path, bool make) {
  sqlite3* database = nullptr;
  const int flags = SQLITE_OPEN_READWRITE | (make ? SQLITE_OPEN_CREATE : 0);
  const int code = sqlite3_open_v2(path.c_str(), &database, flags, nullptr);
  database_.reset(database);  // also after an error, which it holds
  check(database, code);
  check(database, sqlite3_busy_timeout(database, patience_ms));
}

void Database::Close::operator()(sqlite3* database) const { sqlite3_close(database); }

void Database::execute(const std::string& sql) {
  errno = 0;
  check(database_.get(), sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr));
}

std::int64_t Database::pragma(std::string_view name) {
  Statement statement = prepare("PRAGMA " + std::string(name));
  return statement.next() ? statement.integer(0) : 0;
}

std::int64_t Database::last_id() const { return sqlite3_last_insert_rowid(database_.get()); }

Transaction::Transaction(Database& database) : database_(&database) {
  database.execute("BEGIN IMMEDIATE");
}

Transaction::~Transaction() {
  if (!database_) return;
  try {
    database_->execute("ROLLBACK");
  } catch (const SqliteError&) {  // it was rolled back by what failed
  }
}

void Transaction::commit() {
  database_->execute("COMMIT");
  database_ = nullptr;
}

}  // namespace fieldproof::history
