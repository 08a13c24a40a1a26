#include "harness/bench/moments.hpp"

#include <gmock/gmock.h>

#include "harness/test_protocol.hpp"
#include "harness/vectors/loader.hpp"

namespace fieldproof::bench {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// M2 is of a moment where it is 1 or a range; writing to M1 moves something.
struct Moving : harness::TestProtocol {
  std::vector<bool> of_a_moment(const std::vector<Look>& looks) const override {
    std::vector<bool> passing;
    for (const Look& look : looks)
      passing.push_back(std::ranges::any_of(look, [](const Setting& one) {
        return one.first == "M2" && (one.second.empty() || one.second == "0001");
      }));
    return passing;
  }
  std::string moved_by(std::string_view address) const override {
    return address == "M1" ? "1" : "";
  }
};

class MomentsTest : public testing::Test {
 protected:
  Moments moments(const std::string& steps) {
    set_ = {};
    vectors::load_vector_text(
        R"j([{"id": "xgt_cnet/a/b", "title": "what is tested", "level": "must", "basis": "printed rule",
             "statement": "m/1", "source": {"manual": "m", "section": "1", "quote": "as printed"}, "steps": [)j" +
            steps + "]}]",
        "f.json", set_);
    EXPECT_THAT(set_.problems, IsEmpty());
    const Result<exchange::PreparedCase> prepared =
        exchange::prepare(set_.cases.at(0), 1, protocol_);
    EXPECT_TRUE(prepared);
    return moments_of(*prepared, protocol_);
  }

 private:
  vectors::VectorSet set_;
  Moving protocol_;
};

TEST_F(MomentsTest, ALookOnTheWayIsPassedOver) {
  const Moments found = moments(
      R"({"set": {"M1": "0001"}}, {"wait": "9ms"}, {"check": {"M2": "0001"}}, {"wait": "9ms"}, {"check": {"M2": "0000"}})");
  EXPECT_THAT(found.steps, ElementsAre(2u));
  EXPECT_FALSE(found.acted_in);
  EXPECT_FALSE(found.alone);
}

TEST_F(MomentsTest, ARangeHasNoDigits) {
  EXPECT_THAT(moments(R"j({"check": {"M2": "dec(4..9)"}}, {"check": {"M2": "dec(4)"}})j").steps,
              ElementsAre(0u));
}

TEST_F(MomentsTest, WhatIsDoneOnTheWayDependsOnTheMoment) {
  const std::string before = R"({"check": {"M2": "0001"}}, )",
                    after = R"(, {"check": {"M2": "0000"}})";
  EXPECT_TRUE(moments(before + R"({"set": {"M1": "0000"}})" + after).acted_in);
  EXPECT_TRUE(moments(before + R"({"do": "stop"})" + after).acted_in);
  EXPECT_FALSE(moments(before + R"({"set": {"M9": "0000"}})" + after).acted_in) << "moves nothing";
}

TEST_F(MomentsTest, ACaseMayLookAtNothingElse) {
  EXPECT_TRUE(moments(R"({"set": {"M1": "0001"}}, {"check": {"M2": "0001"}})").alone);
  EXPECT_FALSE(moments(R"({"set": {"M1": "0001"}}, {"wait": "9ms"})").alone) << "at nothing at all";
}

}  // namespace
}  // namespace fieldproof::bench
