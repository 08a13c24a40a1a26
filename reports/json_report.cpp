#include "reports/json_report.hpp"

#include <fmt/format.h>

#include "reports/results/result_json.hpp"
#include "reports/text/report_file.hpp"
#include "reports/text/spill.hpp"
#include "reports/text/tally.hpp"
#include "reports/text/timing_table.hpp"

namespace fieldproof::reports {

using results::Delivery;
using results::RunInfo;
using results::RunLog;
using results::Sink;
using results::Verdict;
using text::ReportFile;
using text::Spill;
using text::Tally;
using text::TimingTable;

namespace {

std::string print(const auto& value) {
  std::string text;
  append_json(text, value);
  return text;
}

/// Total first, then in the order of the design's table.
std::string counts(const Tally& tally) {
  std::string text = fmt::format("{{\"total\":{}", tally.total());
  for (results::Verdict verdict : Tally::verdicts)
    text += fmt::format(",\"{}\":{}", results::to_string(verdict), tally.of(verdict));
  return text + '}';
}

class JsonReport final : public Sink {
 public:
  explicit JsonReport(const std::string& path) : path_(path), cases_(path) {}

  Status begin(const RunInfo&) override { return ok(); }

  Status add(const Delivery& one) override {
    if (Status kept = cases_.append(tally_.total() == 0 ? "\n" : ",\n"); !kept) return kept;
    tally_.add(*one);
    timing_.add(*one);
    return cases_.append(one.json());
  }

  Status end(const RunLog& log) override {
    auto file = ReportFile::create(path_);
    if (!file) return file.error();
    std::ostream& out = file->out();
    out << "{\"schema\":1,\n\"run\":" << print(log.run) << ",\n\"counts\":" << counts(tally_)
        << ",\n\"timing\":" << timing_.json();
    if (log.soak) out << ",\n\"soak\":" << print(*log.soak);
    if (!log.samples.empty()) out << ",\n\"samples\":" << print(log.samples);
    out << ",\n\"cases\":[";
    if (Status copied = cases_.copy_to(out); !copied) return copied;
    out << "\n],\n\"end\":" << (log.end ? print(*log.end) : "null") << "}\n";
    return file->commit();
  }

 private:
  std::string path_;
  Tally tally_;
  TimingTable timing_{10'000};
  Spill cases_;
};

}  // namespace

std::unique_ptr<Sink> json_report(const std::string& path) {
  return std::make_unique<JsonReport>(path);
}

}  // namespace fieldproof::reports
