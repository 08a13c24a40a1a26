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

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_red = 1000;  // ids that are kept for the summary

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

int derive_reports(const std::string& ndjson, const ReportPaths& reports,
                   const results::Gate& gate) {
  int code = exit_code::ok;
  for (const auto& [kind, path] : reports) {
    if (kind == "results") continue;
    const Result<text::Tally> written = kind == "junit"  ? reports::write_junit(ndjson, path, gate)
                                        : kind == "html" ? html::write_html(ndjson, path, gate)
                                        : kind == "capture" ? reports::write_capture(ndjson, path)
                                                            : reports::write_json(ndjson, path);
    if (!written) code = complain(written.error().message, exit_code::trouble);
  }
  return code;
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

Status RunReport::begin(const results::RunInfo& info) {
  if (Status written = writer_.write(info); !written) return written;
  print(reports::run_head(info));
  return ok();
}

bool RunReport::add(const results::CaseResult& result, bool written) {
  tally_.add(result.verdict);
  timing_.add(result);
  if (results::gates(result.verdict, console_.gate) && red_.size() < most_red)
    red_.push_back(text::case_label(result));
  if (!written) return true;
  if (const std::string text = reports::case_report(result, console_); !text.empty())
    print(progress_.erase() + text);
  return keep(writer_.write(result));
}

bool RunReport::add(const results::SoakSample& sample) { return keep(writer_.write(sample)); }

bool RunReport::add(const results::SoakSummary& soak) {
  soak_ = soak;
  return keep(writer_.write(soak));
}

bool RunReport::keep(const Status& written) {
  if (!written) write_trouble_ = written.error().message;
  return bool(written);
}

int RunReport::code(const End& end) const {
  if (end.interrupted) return exit_code::interrupted;
  if (!end.trouble.empty() || !write_trouble_.empty()) return exit_code::trouble;
  // GoogleTest deals the cases out to shards; one of them may get none.
  const bool empty_shard = tally_.total() == 0 && std::getenv("GTEST_TOTAL_SHARDS");
  const int code = empty_shard ? exit_code::ok : text::gate_exit_code(tally_, console_.gate, false);
  if (end.worse && code != exit_code::trouble) return exit_code::failed;
  return code == exit_code::ok && !end.not_restored.empty() ? exit_code::trouble : code;
}

int RunReport::finish(const End& end) {
  reports::Summary summary;
  summary.tally = tally_;
  summary.end.finished = timestamp();
  summary.end.seconds =
      end.seconds >= 0
          ? end.seconds
          : std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  summary.end.interrupted = end.interrupted;
  summary.end.trouble = !end.trouble.empty() ? end.trouble : write_trouble_;
  summary.end.exit_code = code(end);
  summary.timing = timing_.rows();
  summary.soak = soak_;
  summary.red = red_;
  summary.reports = paths_;
  summary.reports.insert(summary.reports.end(), other_paths_.begin(), other_paths_.end());
  print(progress_.erase());
  if (const Status written = writer_.write(summary.end); !written)
    complain(written.error().message, 0);
  const int report_code = derive_reports(paths_.front().second, paths_, console_.gate);
  if (!end.trouble.empty()) complain(end.trouble, 0);
  print(reports::run_summary(summary, console_));
  if (!end.not_restored.empty()) complain(end.not_restored, 0);
  const int run_code = summary.end.exit_code;
  return run_code == exit_code::ok || run_code == exit_code::nothing
             ? std::max(run_code, report_code)
             : run_code;
}

}  // namespace fieldproof::run
