#include "harness/run/run_report.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "harness/run/exit_code.hpp"
#include "harness/run/timestamp.hpp"
#include "reports/capture.hpp"
#include "reports/html/html.hpp"
#include "reports/json_report.hpp"
#include "reports/junit.hpp"
#include "reports/text/case_text.hpp"

namespace fieldproof::run {

using results::CaseResult;
using results::Delivery;
using results::RunEnd;
using results::RunInfo;
using results::Sinks;
using results::SoakSample;
using results::SoakSummary;

namespace {

namespace fs = std::filesystem;

}  // namespace

void print(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  if (!text.empty()) std::fflush(stdout);
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
    if (kind == "junit") sinks.attach(reports::junit_report(path));
    if (kind == "html") sinks.attach(html::html_report(path));
    if (kind == "capture") sinks.attach(reports::capture_report(path));
  }
  return sinks;
}

reports::ConsoleOptions console_options(const results::Gate& gate, bool verbose) {
  reports::ConsoleOptions console;
  console.gate = gate;
  console.verbose = verbose;
  console.terminal = isatty(STDOUT_FILENO) != 0;
  console.colour = std::getenv("NO_COLOR") == nullptr;
  winsize size{};
  if (console.terminal && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 20)
    console.width = size.ws_col;
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

bool RunReport::hand_on(const auto& one) {
  if (const Status written = writer_.add(one); !written) {
    write_trouble_ = written.error().message;
    return false;
  }
  [[maybe_unused]] const Status taken = reports_.add(one);
  return true;
}

bool RunReport::add(const CaseResult& result, bool written) {
  console_.count(result);
  if (!written) return true;
  const Delivery one(result);
  [[maybe_unused]] const Status shown = console_.add(one);
  if (!hand_on(one)) return false;
  ++log_.results;
  return true;
}

bool RunReport::add(const SoakSample& sample) { return hand_on(log_.samples.emplace_back(sample)); }

bool RunReport::add(const SoakSummary& soak) { return hand_on(log_.soak.emplace(soak)); }

int RunReport::code(const End& end) const {
  if (end.interrupted) return exit_code::interrupted;
  if (!end.trouble.empty() || !write_trouble_.empty()) return exit_code::trouble;
  // GoogleTest deals the cases out to shards; one of them may get none.
  const bool empty_shard = tally().total() == 0 && std::getenv("GTEST_TOTAL_SHARDS");
  const int code = empty_shard ? exit_code::ok : gate_exit_code(tally(), gate_, false);
  if (end.worse && code != exit_code::trouble) return exit_code::failed;
  return code == exit_code::ok && !end.not_restored.empty() ? exit_code::trouble : code;
}

int RunReport::finish(const End& end) {
  RunEnd& ended = log_.end.emplace();
  ended.finished = timestamp();
  ended.seconds =
      end.seconds >= 0
          ? end.seconds
          : std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  ended.interrupted = end.interrupted;
  ended.trouble = !end.trouble.empty() ? end.trouble : write_trouble_;
  ended.exit_code = code(end);
  console_.erase_progress();
  if (const Status written = writer_.end(log_); !written) complain(written.error().message, 0);
  log_.sha256 = writer_.sha256();
  [[maybe_unused]] const Status reported = reports_.end(log_);
  for (const std::string& trouble : reports_.troubles()) complain(trouble, 0);
  if (!end.trouble.empty()) complain(end.trouble, 0);
  for (const auto& [kind, path] : paths_) console_.add_path(kind, path);
  [[maybe_unused]] const Status told = console_.end(log_);
  if (!end.not_restored.empty()) complain(end.not_restored, 0);
  const int report_code = reports_.troubles().empty() ? exit_code::ok : exit_code::trouble;
  return ended.exit_code == exit_code::ok || ended.exit_code == exit_code::nothing
             ? std::max(ended.exit_code, report_code)
             : ended.exit_code;
}

}  // namespace fieldproof::run
