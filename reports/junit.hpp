// JUnit for Jenkins and GitLab.
#pragma once

#include <memory>
#include <string>

#include "reports/results/sink.hpp"

namespace fieldproof::reports {

/// Where a case stands in the tree of a JUnit reader: "xgt_cnet/rss/two_words" is `two_words` of
/// `fieldproof.xgt_cnet.rss`; repetitions are `two_words #2`, `two_words #3`.
struct JunitName {
  std::string classname;
  std::string name;
};
JunitName junit_name(const results::CaseResult& result);

/// Writes `path`: one <testsuite> a protocol, in the order in which they first appear, judged by
/// the gate of the run. Valid under the strict junit-10.xsd of Jenkins' xunit plugin. `path`
/// appears at the end, whole or not at all.
std::unique_ptr<results::Sink> junit_report(const std::string& path);

}  // namespace fieldproof::reports
