// A comparison for a CI server: what got worse is a failure.
#pragma once

#include <string>

#include "reports/compare/compare.hpp"
#include "src/base/result.hpp"

namespace fieldproof::compare {

/// One <testsuite> a comparison, one <testcase> a case; each slower case has one more. What cannot
/// be compared (added, removed, revised) is skipped. Valid under junit-10.xsd. `path` appears whole
/// or not at all.
Status write_compare_junit(const ComparisonSet& set, const std::string& path);

}  // namespace fieldproof::compare
