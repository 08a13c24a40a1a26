// Traceability: each testable statement of each manual, the vectors that test it, and what a device
// made of them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "reports/results/section_titles.hpp"
#include "reports/text/tally.hpp"

namespace fieldproof::reports {

/// A vector that cites a statement.
struct CoverageVector {
  std::string id, title;
  bool table = false;     // a fact without wire effect: `lint` checks it, no device does
  std::size_t cases = 0;  // that it expands to
  text::Tally verdicts;   // of a run, where its results are given
  std::string why_not;    // why cases of it were not judged there: the first reason
  bool measured = false;  // its cases are of level info: no requirement, none can fail
};

/// What became of a statement. `tested`, without results: it has a vector; with them: at least one
/// case was judged, and none failed (`failed`: FAIL, or XFAIL). `measured`: no case of it can fail.
enum class Traced { tested, failed, unjudged, measured, table, reasoned, open };

struct CoverageStatement {
  std::string id, section, quote;
  std::string reason;                   // why no vector can test it
  std::vector<CoverageVector> vectors;  // that cite it
  bool proved = false;                  // a fault of a device has turned a case red that cites it

  Traced state(bool with_results) const;
  text::Tally verdicts() const;
};

struct CoverageManual {
  std::string id, title;
  std::vector<CoverageStatement> statements;  // by section, in the order in which a person counts
  results::SectionTitles sections;
};

struct Coverage {
  std::string vectors_hash;
  std::string results, endpoint;  // the file of results and what was tested; empty: none
  bool with_faults = false;       // it is known what faults turn red
  std::vector<CoverageManual> manuals;

  bool with_results() const { return !results.empty(); }
};

/// How many statements a fault has proved.
std::size_t count_proved(const Coverage& coverage);

/// How many statements are in each state.
struct CoverageCounts {
  std::map<Traced, std::size_t> of;
  std::size_t total = 0;

  void add(Traced state) { ++of[state], ++total; }
  std::size_t count(Traced state) const;
  std::size_t judged() const { return count(Traced::tested) + count(Traced::failed); }
  std::size_t with_vector() const {
    return judged() + count(Traced::unjudged) + count(Traced::measured) + count(Traced::table);
  }
  /// Judged statements of all, in percent; without results those with a table count too. 100 where
  /// there is none.
  double percent(bool with_results) const;
};
CoverageCounts count_statements(const CoverageManual& manual, bool with_results);
CoverageCounts count_statements(const Coverage& coverage);

/// "1290 statements: 1183 with vectors, 107 with a reason, 0 open"
std::string coverage_summary(const Coverage& coverage);
/// "3 vectors, 12 cases: 12 PASS", or why it is not tested.
std::string trace_text(const CoverageStatement& statement, bool with_results);

std::string coverage_text(const Coverage& coverage);
std::string coverage_json(const Coverage& coverage);
std::string coverage_markdown(const Coverage& coverage);

}  // namespace fieldproof::reports
