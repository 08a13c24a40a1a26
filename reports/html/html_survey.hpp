// What the HTML report gathers from the results of a run. Cases are rendered as they come, so that
// memory follows the size of the report and not that of the results; what a report
// cannot hold is counted, and said.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "reports/html/html_writer.hpp"
#include "reports/results/response_times.hpp"
#include "reports/results/sink.hpp"
#include "reports/text/failures.hpp"
#include "reports/text/tally.hpp"

namespace fieldproof::html {

/// A section of a manual, in the order in which a person counts: 7.1.2, 7.1.10, Appendix 3.1.
struct SectionName {
  std::string manual, section;
};
bool operator<(const SectionName& a, const SectionName& b);

/// What it is called; empty where that is not known.
std::string section_title(const std::map<std::string, results::SectionTitles>& titles,
                          const std::string& manual, const std::string& section);

/// Where an erratum is listed.
SectionName first_place(const results::ErratumInfo& erratum);

struct SectionReport {
  text::Tally tally;
  HtmlWriter red;         // lines that lead to the blocks at the top
  HtmlWriter remarkable;  // blocks of what was judged and did not plainly pass
  HtmlWriter unjudged;    // lines: SKIP, BLOCKED, INCONCLUSIVE
  HtmlWriter passes;      // lines
  std::size_t unlisted = 0;
};

/// A named alternative that the device took.
struct Reading {
  std::size_t cases = 0;
  std::string example, clause, title;  // of the first case
};

/// Cases that were not judged, for one reason.
struct Unexecuted {
  std::vector<std::string> ids;  // the first of them
  std::size_t cases = 0;
};

/// Cases that turn the gate red alike: the first of them in full.
struct RedGroup {
  HtmlWriter blocks;
  bool always = false;  // turns every gate red: FAIL, XPASS, ERROR
  std::string anchor;   // of its first block
};

struct HtmlSurvey {
  results::RunLog log;
  text::Tally tally;
  text::Failures failures;
  std::map<std::size_t, RedGroup> red;  // by number of the finding
  std::size_t red_unlisted = 0;
  std::map<SectionName, SectionReport> sections;
  std::map<std::string, results::ResponseTimes> response_ms;       // by group: "xgt_cnet/rss"
  std::map<std::string, std::map<std::string, Reading>> readings;  // name: what was taken
  std::map<std::pair<results::Verdict, std::string>, Unexecuted>
      unexecuted;  // by verdict and reason
  std::vector<std::pair<results::ErratumInfo, text::Tally>>
      errata;                  // met by cases that were executed
  std::size_t transposed = 0;  // cases moved to the device's station or addresses
};

/// Blocks and lines that one report holds; more are only counted.
inline constexpr std::size_t html_block_limit = 500;
inline constexpr std::size_t html_line_limit = 20'000;
/// Pictures of lines; blocks have theirs.
inline constexpr std::size_t html_picture_limit = 1000;

/// Gathers it.
class HtmlSurveyor {
 public:
  explicit HtmlSurveyor(const results::Gate& gate,
                        std::map<std::string, results::SectionTitles> titles = {})
      : gate_(gate), titles_(std::move(titles)) {}

  void add(const results::CaseResult& result);
  /// Once, at the end.
  HtmlSurvey finish(const results::RunLog& log);

 private:
  void add_line(SectionReport& section, HtmlWriter& out, const auto& write);
  void add_red(SectionReport& section, const results::CaseResult& result);
  void add_remarkable(SectionReport& section, const results::CaseResult& result);
  void add_facts(const results::CaseResult& result);
  text::Tally executed(const std::string& vector) const;

  results::Gate gate_;
  std::map<std::string, results::SectionTitles> titles_;
  HtmlSurvey survey_;
  std::map<std::string, text::Tally> by_id_;
  std::size_t lines_ = 0, red_blocks_ = 0, open_ = 0, other_blocks_ = 0, pictures_ = 0;
};

}  // namespace fieldproof::html
