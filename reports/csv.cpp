#include "reports/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "reports/text/case_text.hpp"
#include "reports/text/report_file.hpp"
#include "src/base/csv.hpp"

namespace fieldproof::reports {

using results::CaseResult;
using results::Delivery;

namespace {

std::string file_name(const CaseResult& result) {
  std::string name = text::case_label(result);
  if (!result.dut.empty()) name += "@" + result.dut;
  for (char& c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_' || c == '.';
    if (!plain) c = c == '/' ? '.' : '_';
  }
  return name;
}

struct Row {
  Time time{};
  std::string text;
};

std::string motion_table(const std::vector<AxisTrace>& axes, Time zero) {
  std::vector<Row> rows;
  for (const AxisTrace& axis : axes) {
    const auto row = [&](Time time, const std::string& rest) {
      rows.push_back(
          {time, fmt::format("{:.3f},{},{}\r\n", to_ms(time - zero), csv_field(axis.axis), rest)});
    };
    for (const AxisTrace::Sample& one : axis.samples)
      row(one.time, fmt::format("{},{},", one.position, one.speed));
    for (const AxisTrace::Event& one : axis.events) row(one.time, ",," + csv_field(one.what));
  }
  std::ranges::stable_sort(rows, {}, &Row::time);
  std::string table = "time_ms,axis,position,speed,event\r\n";
  for (const Row& row : rows) table += row.text;
  return table;
}

std::string token_table(const std::vector<NetTrace>& nets, Time zero) {
  std::string table = "net,station,from_ms,to_ms,busy_ms\r\n";
  for (const NetTrace& net : nets)
    for (const TokenTurn& turn : net.turns)
      table += fmt::format("{},{},{:.3f},{:.3f},{:.3f}\r\n", net.net, turn.station,
                           to_ms(turn.from - zero), to_ms(turn.to - zero), to_ms(turn.busy));
  return table;
}

class CsvReport final : public results::Sink {
 public:
  explicit CsvReport(std::string folder) : folder_(std::move(folder)) {}

  Status begin(const results::RunInfo&) override {
    std::error_code failed;
    std::filesystem::create_directories(folder_, failed);
    if (!failed) return ok();
    return fail(fmt::format("cannot make the folder {}: {}; name another with --csv", folder_,
                            failed.message()));
  }

  Status add(const Delivery& one) override {
    const Time zero = results::shown_from(*one);
    if (!one->trace.axes.empty())
      if (const Status done = write(*one, ".csv", motion_table(one->trace.axes, zero)); !done)
        return done;
    if (one->trace.nets.empty()) return ok();
    return write(*one, ".token.csv", token_table(one->trace.nets, zero));
  }

  Status end(const results::RunLog&) override { return ok(); }

 private:
  Status write(const CaseResult& result, const char* kind, const std::string& table) const {
    const std::filesystem::path path = std::filesystem::path(folder_) / (file_name(result) + kind);
    auto file = text::ReportFile::create(path.string());
    if (!file) return file.error();
    file->out() << table;
    return file->commit();
  }

  std::string folder_;
};

}  // namespace

std::unique_ptr<results::Sink> csv_report(const std::string& folder) {
  return std::make_unique<CsvReport>(folder);
}

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  return in_csv_quotes(text);
}

}  // namespace fieldproof::reports
