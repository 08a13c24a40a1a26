#include "reports/json_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "reports/results/ndjson.hpp"
#include "reports/text/report_file.hpp"
#include "reports/text/timing_table.hpp"

namespace fieldproof::reports {

using text::Tally;

namespace {

using nlohmann::json;

std::string print(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// Total first, then in the order of the design's table (a json object would sort them).
std::string counts(const Tally& tally) {
  std::string text = fmt::format("{{\"total\":{}", tally.total());
  for (results::Verdict verdict : Tally::verdicts)
    text += fmt::format(",\"{}\":{}", results::to_string(verdict), tally.of(verdict));
  return text + '}';
}

}  // namespace

Result<Tally> write_json(const std::string& ndjson, const std::string& path) {
  Tally tally;
  text::TimingTable timing;
  auto log = results::read_ndjson(ndjson, [&](const results::CaseResult& result) {
    tally.add(result.verdict);
    timing.add(result);
  });
  if (!log) return log.error();
  auto file = text::ReportFile::create(path);
  if (!file) return file.error();

  std::ostream& out = file->out();
  out << "{\"schema\":1,\n\"run\":" << print(log->run) << ",\n\"counts\":" << counts(tally)
      << ",\n\"timing\":" << print(timing.json());
  if (log->soak) out << ",\n\"soak\":" << print(*log->soak);
  if (!log->samples.empty()) out << ",\n\"samples\":" << print(log->samples);
  out << ",\n\"cases\":[";
  Tally written;
  auto again = results::read_ndjson(ndjson, [&](const results::CaseResult& result) {
    out << (written.total() == 0 ? "\n" : ",\n") << print(result);
    written.add(result.verdict);
  });
  if (!again) return again.error();
  if (written != tally) {
    return fail(fmt::format(
        "cannot report {}: it changed while it was read; wait for the run to end, then repeat",
        ndjson));
  }
  out << "\n],\n\"end\":" << (log->end ? print(*log->end) : "null") << "}\n";
  if (Status done = file->commit(); !done) return done.error();
  return tally;
}

}  // namespace fieldproof::reports
