#include "harness/cli/case_lines.hpp"

#include <gtest/gtest.h>

namespace fieldproof::cli {
namespace {

vectors::Case one(const std::string& id, const std::string& title) {
  vectors::Case result;
  result.id = id;
  result.title = title;
  result.level = "must";
  result.basis = "derived";
  return result;
}

const vectors::Case short_one = one("a/b", "Read one word from M20 and one from P001");
const vectors::Case long_one = one("a/" + std::string(50, 'x'), "Nothing");

TEST(CaseLines, OfAFileAreWhole) {
  EXPECT_EQ(case_lines({&short_one}, 0), "a/b" + std::string(55, ' ') +
                                             " must   derived       Read one word from M20 and one "
                                             "from P001\n");
}

TEST(CaseLines, OfATerminalAreCutInTheTitle) {
  EXPECT_EQ(case_lines({&short_one}, 30), "a/b  Read one word from M20...\n");
  EXPECT_EQ(case_lines({&short_one, &long_one}, 40),
            "a/b                       Read one wo...\n" + long_one.id + "\n")
      << "an id is never cut";
}

}  // namespace
}  // namespace fieldproof::cli
