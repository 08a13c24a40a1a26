#include "reports/text/timing_table.hpp"

#include <fmt/format.h>
#include <algorithm>

#include "reports/results/result_json.hpp"
#include "reports/text/case_text.hpp"

namespace fieldproof::text {

namespace {

using Times = std::map<std::string, results::ResponseTimes>;

std::string to_object(const Times& times) {
  std::map<std::string, results::ResponseFigures> figures;
  for (const auto& [name, one] : times) figures[name] = figures_of(one);
  std::string text;
  results::append_json(text, figures);
  return text;
}

void add(Times& all, const std::string& name, const results::CaseResult& result) {
  results::ResponseTimes& times = all[name];
  for (const double ms : result.response_ms) times.add(ms);
}

}  // namespace

void TimingTable::add(const results::CaseResult& result) {
  if (result.response_ms.empty()) return;
  const std::string line = result.line.empty() ? "" : " [" + result.line + "]";
  fieldproof::text::add(protocols_, result.id.substr(0, result.id.find('/')), result);
  fieldproof::text::add(groups_, group_of(result.id) + line, result);
  if (too_many_) return;
  fieldproof::text::add(cases_, case_name(result), result);
  too_many_ = cases_.size() > case_limit_;
  if (too_many_) cases_.clear();
}

TimingTable::Rows TimingTable::rows(std::size_t limit) const {
  const bool by_case = !too_many_ && cases_.size() <= limit;
  const Times& chosen = by_case ? cases_ : groups_.size() <= limit ? groups_ : protocols_;
  Rows rows;
  for (const auto& [name, times] : chosen) rows.emplace_back(name, results::figures_of(times));
  return rows;
}

std::string TimingTable::json() const {
  const std::string cases = too_many_ ? "" : "\"cases\":" + to_object(cases_) + ',';
  return '{' + cases + "\"groups\":" + to_object(groups_) + '}';
}

std::string timing_text(const TimingTable::Rows& rows) {
  if (rows.empty()) return "";
  std::size_t width = 0;
  for (const auto& [name, figures] : rows) width = std::max(width, name.size());
  const std::string head = "reply times in ms";
  width = std::max(width + 2, head.size());
  std::string text = fmt::format("{:<{}}  {:>8} {:>10} {:>10} {:>10} {:>10}\n", head, width,
                                 "replies", "min", "median", "p99", "max");
  for (const auto& [name, figures] : rows)
    text +=
        fmt::format("  {:<{}}  {:>8} {:>10.3f} {:>10.3f} {:>10.3f} {:>10.3f}\n", name, width - 2,
                    figures.count, figures.least, figures.median, figures.p99, figures.greatest);
  return text;
}

}  // namespace fieldproof::text
