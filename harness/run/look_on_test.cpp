#include "harness/run/look_on.hpp"

#include <gmock/gmock.h>

#include "harness/test_protocol.hpp"

namespace fieldproof::run {
namespace {

using testing::ElementsAre;

TEST(LookOn, StationsAreShortened) {
  EXPECT_EQ(ranges_of({}), "");
  EXPECT_EQ(ranges_of({3}), "3");
  EXPECT_EQ(ranges_of({7, 0, 2, 1, 3}), "0 to 3, 7");
}

TEST(LookOn, TheLikelyFirstAndNothingTwice) {
  const harness::TestProtocol asked, other;
  std::vector<std::string> said;
  for (const probe::Trial& one : trials_instead_of(asked, 20, {&other}, {}))
    said.push_back((one.protocol == &asked ? "asked " : "other ") + std::to_string(one.station));
  EXPECT_EQ(said.size(), 1u + 31 + 32)
      << "0 to 31 of both, but what was silent; 32 is 20 hex, and 20 is 14 hex";
  said.resize(6);
  EXPECT_THAT(said,
              ElementsAre("asked 32", "asked 14", "other 20", "asked 1", "other 1", "asked 0"));
}

}  // namespace
}  // namespace fieldproof::run
