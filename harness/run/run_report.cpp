#include "harness/run/run_report.hpp"

#include <fmt/format.h>
#include <unistd.h>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "harness/run/exit_code.hpp"
#include "harness/run/timestamp.hpp"
#include "harness/system/terminal.hpp"
#include "reports/capture.hpp"
#include "reports/csv.hpp"
#include "reports/html/html.hpp"
#include "reports/json_report.hpp"
#include "reports/junit.hpp"
#include "reports/results/shard.hpp"
#include "reports/text/fold.hpp"

namespace fieldproof::run {

using results::CaseResult;
using results::Delivery;
using results::RunEnd;
using results::RunInfo;
using results::Sinks;

namespace fs = std::filesystem;

void print(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  if (!text.empty()) std::fflush(stdout);
}

void tell(const std::string& text) {
  print(text::fold(text, static_cast<std::size_t>(os::terminal_columns(STDOUT_FILENO))));
}

Result<ReportPaths> make_report_paths(const std::string& out, const std::string& json,
                                      const std::string& junit, const std::string& html) {
  std::error_code failed;
  fs::create_directories(out, failed);
  if (failed)
    return fail(fmt::format("cannot make the folder {}: {}; name another with --out", out,
                            failed.message()));
  const auto path = [&](const std::string& given, const char* name) {
    return given.empty() ? (fs::path(out) / name).string() : given;
  };
  return ReportPaths{{"results", path("", "results.ndjson")},
                     {"json", path(json, "results.json")},
                     {"junit", path(junit, "junit.xml")},
                     {"html", path(html, "report.html")}};
}

Sinks sinks_for(const ReportPaths& paths) {
  Sinks sinks;
  for (const auto& [kind, path] : paths) {
    if (kind == "json") sinks.attach(reports::json_report(path));
    if (kind == "html") sinks.attach(html::html_report(path));
    if (kind == "capture") sinks.attach(reports::capture_report(path));
    if (kind == "csv") sinks.attach(reports::csv_report(path));
  }
  // The last, so that it tells which of the others could not be written: CI reads it as the gate.
  for (const auto& [kind, path] : paths)
    if (kind == "junit") sinks.attach(reports::junit_report(path));
  return sinks;
}

reports::ConsoleOptions console_options(const results::Gate& gate, bool verbose) {
  reports::ConsoleOptions console;
  console.gate = gate;
  console.verbose = verbose;
  console.terminal = isatty(STDOUT_FILENO) != 0;
  console.colour = std::getenv("NO_COLOR") == nullptr;
  console.width = os::terminal_columns(STDOUT_FILENO);
  return console;
}

Result<RunReport> RunReport::create(ReportPaths paths, const reports::ConsoleOptions& console) {
  Result<results::NdjsonWriter> writer = results::NdjsonWriter::create(paths.front().second);
  if (!writer) return writer.error();
  return RunReport(std::move(paths), console, std::move(*writer));
}

Status RunReport::begin(const RunInfo& info) {
  log_.run = info;
  if (Status written = writer_.begin(info); !written) return written;
  if (Status begun = reports_.begin(info); !begun) return begun;
  return console_.begin(info);
}

bool RunReport::kept(const Status& written) {
  if (!written && write_trouble_.empty()) write_trouble_ = written.error().message;
  return bool(written);
}

bool RunReport::add(const CaseResult& result, bool written) {
  if (!written) {
    console_.count(result);
    return true;
  }
  const Delivery one(result);
  [[maybe_unused]] const Status shown = console_.add(one);
  if (!kept(writer_.add(one))) return false;
  // The other reports tell of no more than the file of results does.
  [[maybe_unused]] const Status taken = reports_.add(one);
  ++log_.results;
  return true;
}

RunEnd RunReport::ended(const End& end) const {
  RunEnd ended;
  ended.finished = timestamp();
  ended.seconds =
      end.seconds >= 0
          ? end.seconds
          : std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  ended.interrupted = end.interrupted;
  ended.hint = end.hint;
  ended.trouble = !end.trouble.empty() ? end.trouble : write_trouble_;
  if (end.interrupted) ended.add({exit_code::interrupted, "interrupted", "interrupted"});
  for (const std::string& trouble : {end.trouble, write_trouble_})
    if (!trouble.empty()) ended.add({exit_code::trouble, "trouble", "bench trouble: " + trouble});
  for (const std::string& trouble : reports_.troubles())
    ended.add({exit_code::trouble, "report", trouble});
  if (!end.not_restored.empty()) ended.add({exit_code::trouble, "not-restored", end.not_restored});
  if (!end.worse.empty()) ended.add({exit_code::failed, "baseline", end.worse});
  // GoogleTest deals the cases out to shards; one of them may get none. A run that ended early is
  // not measured by how little it judged.
  const bool empty_shard = tally().total() == 0 && results::shard_of_environment();
  if (!empty_shard)
    for (results::Reason& reason : text::reasons_of(tally(), gate())) ended.add(std::move(reason));
  return ended;
}

int RunReport::finish(const End& end) {
  console_.erase_progress();
  log_.end = ended(end);
  if (!kept(writer_.end(log_))) log_.end = ended(end);
  log_.sha256 = writer_.sha256();
  [[maybe_unused]] const Status reported = reports_.end(log_);
  log_.end = ended(end);  // with what could not be reported
  for (const auto& [kind, path] : paths_) console_.add_path(kind, path);
  [[maybe_unused]] const Status told = console_.end(log_);
  for (const std::string& trouble : reports_.troubles()) complain(trouble, 0);
  for (const std::string& trouble : {end.trouble, write_trouble_, end.not_restored})
    if (!trouble.empty()) complain(trouble, 0);
  return log_.end->exit_code;
}

}  // namespace fieldproof::run
