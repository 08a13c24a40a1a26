// The file behind a history: its kind, its version, and what to say when it cannot be used.
#pragma once

#include <memory>
#include <string>

#include "reports/history/storage/sqlite.hpp"
#include "src/base/result.hpp"

namespace fieldproof::history {

enum class Use { read, write };

/// Where a history is when nobody names a file: fieldproof/history.sqlite in XDG_DATA_HOME, else in
/// ~/.local/share. An error where there is no home.
Result<std::string> default_path();

/// Writing makes the file, and the folder that it lies in; reading never writes. A file that is
/// damaged, of a newer version, or no history is refused before anything is written to it. Errors
/// name the file, what is wrong and what to do.
Result<std::unique_ptr<Database>> open_history(const std::string& path, Use use);

/// What SQLite says, in words about the file.
Error error_of(Use use, const std::string& path, const SqliteError& error);
[[noreturn]] void damaged(const std::string& what);

/// The outcome of work on the file.
template <typename Work>
auto guarded(Use use, const std::string& path, const Work& work) -> Result<decltype(work())> {
  try {
    return work();
  } catch (const SqliteError& error) {
    return error_of(use, path, error);
  }
}

}  // namespace fieldproof::history
