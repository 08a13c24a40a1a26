#include "reports/history/storage/history_file.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>

#include "reports/results/file_error.hpp"

namespace fieldproof::history {

namespace fs = std::filesystem;

namespace {

constexpr std::int64_t our_application = 0x46505248;  // "FPRH", in the header of the file
constexpr std::int64_t newest_version = 1;

/// `list`: numbers as packed_list.hpp has them. `selection`: the list of its cases, found by the
/// names alone. Lists of a run are described in packed_run.hpp.
constexpr const char* schema = R"sql(
CREATE TABLE device (id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE) STRICT;
CREATE TABLE test_case (id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE, title TEXT NOT NULL,
  manual TEXT NOT NULL, section TEXT NOT NULL) STRICT;
CREATE TABLE text (id INTEGER PRIMARY KEY, text TEXT NOT NULL UNIQUE) STRICT;
CREATE TABLE list (id INTEGER PRIMARY KEY, hash TEXT NOT NULL UNIQUE, bytes BLOB NOT NULL) STRICT;
CREATE TABLE selection (hash TEXT PRIMARY KEY, cases INTEGER NOT NULL REFERENCES list) STRICT;
CREATE TABLE run (
  number INTEGER PRIMARY KEY, hash TEXT NOT NULL UNIQUE,
  device INTEGER NOT NULL REFERENCES device, firmware TEXT NOT NULL, protocols TEXT NOT NULL,
  vectors TEXT NOT NULL, tool TEXT NOT NULL, started TEXT NOT NULL, started_s INTEGER NOT NULL,
  complete INTEGER NOT NULL, exit_code INTEGER, seconds REAL NOT NULL, red INTEGER NOT NULL,
  counts BLOB NOT NULL, cases INTEGER NOT NULL REFERENCES list,
  verdicts INTEGER NOT NULL REFERENCES list, repetitions INTEGER NOT NULL REFERENCES list,
  with_verdict INTEGER NOT NULL REFERENCES list, topics INTEGER NOT NULL REFERENCES list,
  revs INTEGER NOT NULL REFERENCES list, messages INTEGER NOT NULL REFERENCES list,
  floors INTEGER NOT NULL REFERENCES list, replies INTEGER NOT NULL REFERENCES list,
  times INTEGER NOT NULL REFERENCES list, info TEXT NOT NULL, ending TEXT) STRICT;
CREATE INDEX run_by_time ON run (device, started_s, number);
)sql";

/// What is no matter of SQLite: told as it is.
struct Refusal : std::runtime_error {
  using runtime_error::runtime_error;
};

const char* verb_of(Use use) { return use == Use::write ? "write" : "read"; }

bool is_empty(Database& database) {
  return database.pragma("application_id") == 0 && database.pragma("user_version") == 0 &&
         database.pragma("schema_version") == 0;
}

void make_tables(Database& database) {
  Transaction transaction(database);
  if (is_empty(database)) {  // still: nobody else has made them meanwhile
    database.execute(schema);
    database.execute(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}",
                                 our_application, newest_version));
  }
  transaction.commit();
}

void check_version(Database& database) {
  if (database.pragma("application_id") != our_application)
    throw Refusal("it is no history of fieldproof; name another with --history");
  if (const std::int64_t version = database.pragma("user_version"); version > newest_version)
    throw Refusal(
        fmt::format("its version is {}, this tool knows {}; use the fieldproof that wrote "
                    "it, or a newer one",
                    version, newest_version));
}

std::unique_ptr<Database> open_checked(const std::string& path, Use use) {
  auto database = std::make_unique<Database>(path, use == Use::write);
  if (use == Use::write && is_empty(*database)) make_tables(*database);
  check_version(*database);
  database->execute("PRAGMA foreign_keys = ON; PRAGMA cell_size_check = ON");
  // A journal that is rolled back (the default) and not WAL: one file to copy or mail, on a share
  // of a network and on a medium that is read-only, too; writes are rare and short.
  // Whoever reads sees one state, and locks it once.
  if (use == Use::read) database->execute("PRAGMA query_only = ON; BEGIN");
  return database;
}

}  // namespace

Result<std::string> default_path() {
  const char* data = std::getenv("XDG_DATA_HOME");
  const char* home = std::getenv("HOME");
  if (data && *data == '/') return (fs::path(data) / "fieldproof/history.sqlite").string();
  if (home && *home == '/')
    return (fs::path(home) / ".local/share/fieldproof/history.sqlite").string();
  return fail(
      "there is no place for a history: neither XDG_DATA_HOME nor HOME is set; name a file "
      "with --history");
}

Result<std::unique_ptr<Database>> open_history(const std::string& path, Use use) {
  std::error_code failed;
  if (fs::is_directory(path, failed))
    return results::file_error(fmt::format("{} history", verb_of(use)), path, EISDIR);
  if (use == Use::read && !fs::exists(path, failed))
    return fail(
        fmt::format("cannot read history {}: there is none; `fieldproof history add RESULT` "
                    "makes it, or name another with --history",
                    path));
  if (use == Use::write && fs::path(path).has_parent_path())
    fs::create_directories(fs::path(path).parent_path(), failed);  // opening tells what failed
  try {
    return open_checked(path, use);
  } catch (const SqliteError& error) {
    return error_of(use, path, error);
  } catch (const Refusal& error) {
    return fail(fmt::format("cannot {} history {}: {}", verb_of(use), path, error.what()));
  }
}

Error error_of(Use use, const std::string& path, const SqliteError& error) {
  const char* verb = verb_of(use);
  const auto told = [&](const std::string& cause) {
    return fail(fmt::format("cannot {} history {}: {}", verb, path, cause));
  };
  switch (error.code) {
    case SQLITE_NOTADB: return told("it is no SQLite file; name another with --history");
    case SQLITE_CORRUPT:
      return told(
          fmt::format("it is damaged ({}); nothing was written to it; take a copy that you "
                      "kept, or save what can be read: sqlite3 FILE .recover",
                      error.what()));
    case SQLITE_READONLY:
      return told("it, or its folder, is read-only; choose a place that this user may write to");
    case SQLITE_FULL: return told("the disk is full; free some space; what it held before is kept");
    case SQLITE_BUSY:
      return told("another program has been writing to it for half a minute; try again");
    default: break;
  }
  if (error.system_error != 0)
    return results::file_error(fmt::format("{} history", verb), path, error.system_error);
  return told(error.what());
}

void damaged(const std::string& what) { throw SqliteError(SQLITE_CORRUPT, 0, what); }

}  // namespace fieldproof::history
