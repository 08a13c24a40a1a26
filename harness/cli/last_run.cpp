#include "harness/cli/last_run.hpp"

#include <fmt/format.h>

#include "reports/history/device.hpp"

namespace fieldproof::cli {

using history::History;
using history::Use;

namespace {

Result<History> open_named(const std::string& named, Use use) {
  const Result<std::string> path = history_path(named);
  if (!path) return path.error();
  return History::open(*path, use);
}

}  // namespace

Result<std::string> history_path(const std::string& named) {
  return named.empty() ? history::default_path() : Result<std::string>(named);
}

Use use_of(const run::RunOptions& options) {
  return options.history.empty() ? Use::read : Use::write;
}

Status check_history(const run::RunOptions& options) {
  if (options.history.empty() && options.baseline != last_run) return ok();
  const Result<History> history = open_named(options.history, use_of(options));
  if (!history) return history.error();
  return ok();
}

Result<std::optional<compare::RunSummary>> last_before(const std::string& history,
                                                       const compare::RunSummary& run, Use use) {
  Result<History> opened = open_named(history, use);
  if (!opened) return opened.error();
  return opened->last_before(run);
}

std::string no_run_before(const std::string& history, const compare::RunSummary& run) {
  const Result<std::string> path = history_path(history);
  return fmt::format("no baseline: history {} has no earlier run of {} over the same protocols",
                     path ? *path : history, history::device_of(run.run));
}

}  // namespace fieldproof::cli
