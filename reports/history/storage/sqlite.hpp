// SQLite's C interface with owners and exceptions. What fails is an SqliteError: the history turns
// it into words about its file, once.
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace fieldproof::history {

struct SqliteError : std::runtime_error {
  SqliteError(int code_, int system_error_, const std::string& message)
      : std::runtime_error(message), code(code_), system_error(system_error_) {}
  int code;          // SQLITE_CORRUPT, ...: the primary one
  int system_error;  // errno behind it; 0: none
};

/// Bytes that are no text.
struct Blob {
  std::string_view bytes;
};

/// One prepared statement; its parameters are bound in their order.
class Statement {
 public:
  /// Starts anew with these parameters: std::int64_t, double, std::string_view, Blob, nullptr. What
  /// they view outlives the last row.
  Statement& with(const auto&... values) {
    reset();
    int at = 0;
    (bind(++at, values), ...);
    return *this;
  }
  /// The next row; false: there is none.
  bool next();
  /// For a statement without rows.
  void run() {
    while (next()) {
    }
  }

  /// Columns of the row, from 0. Views hold until the next row.
  std::int64_t integer(int column) const;
  double real(int column) const;
  std::string_view text(int column) const;
  std::string_view blob(int column) const;
  bool is_null(int column) const;

 private:
  friend class Database;
  struct Close {
    void operator()(sqlite3_stmt* statement) const;
  };

  Statement(sqlite3* database, std::string_view sql);
  void reset();
  void bind(int at, std::int64_t value);
  void bind(int at, double value);
  void bind(int at, std::string_view value);
  void bind(int at, Blob value);
  void bind(int at, std::nullptr_t);

  sqlite3* database_;
  std::unique_ptr<sqlite3_stmt, Close> statement_;
};

class Database {
 public:
  /// A file that is there, or, with `make`, may be made. Nothing is read yet.
  Database(const std::string& path, bool make);

  Statement prepare(std::string_view sql) { return Statement(database_.get(), sql); }
  /// Several statements without parameters and rows.
  void execute(const std::string& sql);
  std::int64_t pragma(std::string_view name);
  std::int64_t last_id() const;

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  std::unique_ptr<sqlite3, Close> database_;
};

/// The only writer from its beginning on; undone unless it is committed.
class Transaction {
 public:
  explicit Transaction(Database& database);
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  ~Transaction();
  void commit();

 private:
  Database* database_;  // nullptr: committed
};

}  // namespace fieldproof::history
