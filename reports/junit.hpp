// JUnit for Jenkins and GitLab, from a file of results.
#pragma once

#include <string>

#include "reports/results/case_result.hpp"
#include "reports/text/tally.hpp"
#include "src/base/result.hpp"

namespace fieldproof::reports {

/// Where a case stands in the tree of a JUnit reader: "xgt_cnet/rss/two_words" is `two_words` of
/// `fieldproof.xgt_cnet.rss`; repetitions are `two_words #2`, `two_words #3`.
struct JunitName {
  std::string classname;
  std::string name;
};
JunitName junit_name(const results::CaseResult& result);

/// Reads the results in `ndjson` (of a killed run too) and writes `path`: one <testsuite> a
/// protocol, in the order in which they first appear. Memory does not grow with the number of
/// cases; the file is read once to count and once a suite to write. Valid under the strict
/// junit-10.xsd of Jenkins' xunit plugin. `path` appears whole or not at all. Returns the counts of
/// what was written.
Result<text::Tally> write_junit(const std::string& ndjson, const std::string& path,
                                const results::Gate& gate);

}  // namespace fieldproof::reports
