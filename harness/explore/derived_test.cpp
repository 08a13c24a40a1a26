// What follows by rule from the requests of the vectors.
#include "harness/explore/derived.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "harness/vectors/test_own_vectors.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::explore {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using vectors::Case;
using vectors::Step;

std::vector<Case> derived_of(const std::string& filter, const std::string& wanted,
                             std::size_t at_most = 0) {
  const std::vector<Case>& cases = vectors::test::own_vectors(suites::protocols(), filter).cases;
  Result<std::vector<Case>> derived =
      derived_cases(cases, suites::protocols(), at_most, 1,
                    [&](const std::string& id) { return id.find(wanted) != std::string::npos; });
  EXPECT_TRUE(derived);
  return derived ? std::move(*derived) : std::vector<Case>();
}

std::ptrdiff_t count(const Case& one, Step::Kind kind) {
  return std::ranges::count(one.steps, kind, &Step::kind);
}

const harness::Protocol& rtu() { return *suites::protocols().find("modbus-rtu"); }

std::vector<Request> all_of(const std::string& derivation, std::size_t at_most = 0) {
  const Request read{"", "", *notation::parse_notation("[st 03 00 63 00 01 CRC]")};
  return derived_from(read, derivation, rtu(), 1, at_most, 1);
}

TEST(DerivedFrom, CoversEachPlace) {
  EXPECT_EQ(all_of("flipped").size(), 64u);
  EXPECT_EQ(all_of("dropped").size(), 8u);
  EXPECT_EQ(all_of("doubled").size(), 8u);
  EXPECT_EQ(all_of("cut").size(), 7u);
  EXPECT_EQ(all_of("paused").size(), 28u);
  EXPECT_EQ(all_of("noise").size(), 6u);
  EXPECT_EQ(all_of("joined").size(), 1u);
  EXPECT_EQ(all_of("flipped").front().change, "bit 0 of byte 0 flipped");
}

TEST(DerivedFrom, ASampleIsTheSameBySeed) {
  const std::vector<Request> some = all_of("flipped", 6);
  ASSERT_EQ(some.size(), 6u);
  EXPECT_EQ(some.back().change, all_of("flipped", 6).back().change);
}

/// The CRC sees each single bit, and each byte too few or too many: nobody answers.
TEST(DerivedCases, OfAFrameWithACrcDrawSilence) {
  for (const char* derivation : {"flipped", "dropped", "doubled", "cut"}) {
    const std::vector<Case> cases =
        derived_of("modbus_rtu/examples/*", "/derived/" + std::string(derivation));
    ASSERT_FALSE(cases.empty());
    for (const Case& one : cases) {
      EXPECT_EQ(count(one, Step::Kind::expect), 1) << one.id;  // the right request, at the end
      EXPECT_EQ(one.steps.back().kind, Step::Kind::expect) << one.id;
      EXPECT_GT(count(one, Step::Kind::silence), 4) << one.id;
    }
  }
}

/// A connection carries bytes, not segments: each half is part of the same request.
TEST(DerivedCases, OfASplitRequestAreAnswered) {
  const std::vector<Case> cases = derived_of("xgt_fenet/read/*", "/derived/split");
  ASSERT_FALSE(cases.empty());
  for (const Case& one : cases) EXPECT_EQ(count(one, Step::Kind::silence), 0) << one.id;
}

TEST(DerivedCases, RestOnTheDecision) {
  for (const Case& one : derived_of("modbus_rtu/examples/*", "/derived/cut")) {
    EXPECT_TRUE(one.by_rule);
    EXPECT_EQ(one.basis, "decision");
    EXPECT_EQ(one.decisions.front().id, "explore/own-model");
    EXPECT_LE(one.title.size(), 80u);
  }
}

/// A request without an answer, or of a client, has nothing that follows.
TEST(DerivedCases, AreOfAnsweredRequestsAlone) {
  EXPECT_THAT(derived_of("modbus_rtu/line/wrong_check/*", "/derived/"), IsEmpty());
  EXPECT_THAT(derived_of("modbus_rtu/client/*", "/derived/"), IsEmpty());
}

}  // namespace
}  // namespace fieldproof::explore
