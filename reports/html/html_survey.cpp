#include "reports/html/html_survey.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reports/html/html_case.hpp"
#include "reports/text/case_text.hpp"

namespace fieldproof::html {

using results::CaseResult;
using results::ErratumInfo;
using results::Gate;
using results::ResponseTimes;
using results::RunLog;
using results::Verdict;
using text::Tally;

namespace {

constexpr std::size_t open_blocks = 10;  // red cases that need no click
constexpr std::size_t ids_of_a_reason = 100;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The number at `at`, without leading zeros; moves behind it.
std::string_view take_number(std::string_view text, std::size_t& at) {
  const std::size_t start = at;
  while (at < text.size() && is_digit(text[at])) ++at;
  std::string_view digits = text.substr(start, at - start);
  while (digits.size() > 1 && digits.front() == '0') digits.remove_prefix(1);
  return digits;
}

/// Numbers as numbers, all else byte by byte; below 0, 0 or above 0.
int compare_naturally(std::string_view a, std::string_view b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string_view x = take_number(a, i), y = take_number(b, j);
      if (x.size() != y.size()) return x.size() < y.size() ? -1 : 1;
      if (const int order = x.compare(y); order != 0) return order;
    } else {
      if (a[i] != b[j])
        return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]) ? -1 : 1;
      ++i, ++j;
    }
  }
  return a.size() - i == b.size() - j ? a.compare(b) : a.size() - i < b.size() - j ? -1 : 1;
}

bool unexecuted(Verdict verdict) { return verdict == Verdict::skip || verdict == Verdict::blocked; }
bool unjudged(Verdict verdict) { return unexecuted(verdict) || verdict == Verdict::inconclusive; }

/// Whether the report has room for one more.
bool fits(std::size_t& used, std::size_t limit) { return used < limit && ++used > 0; }

}  // namespace

bool operator<(const SectionName& a, const SectionName& b) {
  const int manuals = a.manual.compare(b.manual);
  return manuals != 0 ? manuals < 0 : compare_naturally(a.section, b.section) < 0;
}

std::string section_title(const std::map<std::string, results::SectionTitles>& titles,
                          const std::string& manual, const std::string& section) {
  const auto found = titles.find(manual);
  return found == titles.end() ? "" : std::string(results::title_of(found->second, section));
}

SectionName first_place(const ErratumInfo& erratum) {
  if (erratum.places.empty()) return {};
  return {erratum.places.front().manual, erratum.places.front().section};
}

void HtmlSurveyor::add(const CaseResult& result) {
  survey_.tally.add(result);
  by_id_[result.id].add(result.verdict);
  SectionReport& section = survey_.sections[{result.manual, result.section}];
  section.tally.add(result.verdict);
  if (result.verdict == Verdict::pass)
    add_line(section, section.passes, [&](HtmlWriter& out) {
      write_pass_line(out, result, result.trace.empty() || fits(pictures_, html_picture_limit));
    });
  else if (unexecuted(result.verdict))
    add_line(section, section.unjudged, [&](HtmlWriter& out) { write_case_line(out, result); });
  else if (gates(result.verdict, gate_) && !unjudged(result.verdict))
    add_red(section, result);
  else
    add_remarkable(section, result);
  add_facts(result);
}

HtmlSurvey HtmlSurveyor::finish(const RunLog& log) {
  for (const ErratumInfo& erratum : log.run.errata) {
    Tally met;
    for (const std::string& vector : erratum.vectors) met.add(executed(vector));
    if (met.total() > 0) survey_.errata.emplace_back(erratum, met);
  }
  std::ranges::stable_sort(survey_.errata, std::less<>{},
                           [](const auto& one) { return first_place(one.first); });
  survey_.log = log;
  return std::move(survey_);
}

void HtmlSurveyor::add_line(SectionReport& section, HtmlWriter& out, const auto& write) {
  if (!fits(lines_, html_line_limit)) {
    ++section.unlisted;
    return;
  }
  write(out);
  out.markup("\n");
}

void HtmlSurveyor::add_red(SectionReport& section, const CaseResult& result) {
  const text::Finding& finding = survey_.failures.add(result);
  RedGroup& group = survey_.red[finding.number];
  std::string anchor = group.anchor;
  if (!finding.is_again() && fits(red_blocks_, html_block_limit)) {
    const bool is_first = anchor.empty();
    anchor = fmt::format("red-{}", red_blocks_);
    write_case_block(group.blocks, result,
                     {is_first && fits(open_, open_blocks), anchor,
                      section_title(titles_, result.manual, result.section), true});
    if (is_first) group.anchor = anchor;
    group.always = gates(result.verdict, Gate{});
  } else if (!finding.is_again()) {
    ++survey_.red_unlisted;
  }
  add_line(section, section.red, [&](HtmlWriter& out) { write_case_line(out, result, anchor); });
}

void HtmlSurveyor::add_remarkable(SectionReport& section, const CaseResult& result) {
  if (fits(other_blocks_, html_block_limit))
    write_case_block(section.remarkable, result,
                     {.section_title = section_title(titles_, result.manual, result.section)});
  else
    add_line(section, section.unjudged, [&](HtmlWriter& out) { write_case_line(out, result); });
}

void HtmlSurveyor::add_facts(const CaseResult& result) {
  if (!result.response_ms.empty()) {
    ResponseTimes& times = survey_.response_ms[text::group_of(result.id)];
    for (const double ms : result.response_ms) times.add(ms);
  }
  for (const auto& [name, taken] : result.readings) {
    Reading& reading = survey_.readings[name][taken];
    if (++reading.cases == 1)
      reading = {1, result.id, fmt::format("{}, {}", result.manual, result.section), result.title};
  }
  if (unjudged(result.verdict)) {
    Unexecuted& reason = survey_.unexecuted[{result.verdict, result.message}];
    if (++reason.cases <= ids_of_a_reason) reason.ids.push_back(text::case_label(result));
  }
  const auto moved = [](const std::string& note) { return note.starts_with("transposed"); };
  survey_.transposed += std::ranges::any_of(result.notes, moved) ? 1 : 0;
}

/// Verdicts of the cases of a vector that were judged: "a/b" itself, and "a/b/..." that it expands
/// to.
Tally HtmlSurveyor::executed(const std::string& vector) const {
  Tally tally;
  for (auto at = by_id_.lower_bound(vector); at != by_id_.end() && at->first.starts_with(vector);
       ++at) {
    if (at->first.size() > vector.size() && at->first[vector.size()] != '/') continue;
    for (Verdict verdict : Tally::verdicts) {
      if (!unexecuted(verdict)) tally.add(verdict, at->second.of(verdict));
    }
  }
  return tally;
}

}  // namespace fieldproof::html
