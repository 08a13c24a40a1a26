#include "harness/run/case_length.hpp"

#include <gtest/gtest.h>

namespace fieldproof::run {
namespace {

TEST(CaseLength, IsWhatItsStepsWait) {
  vectors::Case one;
  EXPECT_EQ(least_length(one, 500ms), 0ns);
  one.steps.resize(4);
  one.steps[1].kind = vectors::Step::Kind::wait;
  one.steps[1].duration = 3s;
  one.steps[1].times = 2;
  one.steps[2].kind = vectors::Step::Kind::silence;
  one.steps[3].kind = vectors::Step::Kind::expect;
  one.steps[3].every = 200ms;
  one.steps[3].times = 5;
  EXPECT_EQ(least_length(one, 500ms), 7500ms);
}

}  // namespace
}  // namespace fieldproof::run
