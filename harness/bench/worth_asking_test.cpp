#include "harness/bench/worth_asking.hpp"

#include <gmock/gmock.h>

#include "harness/test_protocol.hpp"

namespace fieldproof::bench {
namespace {

using results::CaseResult;
using results::Event;
using testing::HasSubstr;

CaseResult with(const std::string& received) {
  CaseResult result;
  result.id = "p/a/b";
  result.message = "what failed";
  result.exchange = {{Event::Kind::sent, 0ns, 0ns, to_bytes("<ask>"), ""}};
  if (!received.empty())
    result.exchange.push_back({Event::Kind::received, 0ns, 0ns, to_bytes(received), ""});
  return result;
}

class WorthAskingTest : public testing::Test {
 protected:
  int cases_until_the_end(const CaseResult& result, bool set_up = true) {
    for (int i = 1; i < 100; ++i)
      if (!worth_.after(result, protocol_, set_up).empty()) return i;
    return 0;
  }
  WorthAsking worth_{2};
  harness::TestProtocol protocol_;
};

TEST_F(WorthAskingTest, ADeviceThatSendsFramesIs) {
  EXPECT_EQ(cases_until_the_end(with("<x>")), 0);
}

TEST_F(WorthAskingTest, OneThatSendsHalvesIsNot) {
  EXPECT_EQ(cases_until_the_end(with("<x")), 20);
  EXPECT_THAT(worth_.after(with("<x"), protocol_, true),
              HasSubstr("no whole frame came from the device in the last cases, up to p/a/b: what "
                        "failed"));
}

/// As in XGT: the head of the next frame ends one that breaks off.
struct EndedByHeads : harness::TestProtocol {
  std::optional<std::size_t> frame_length(ByteView bytes) const override {
    const std::size_t end = to_text(bytes).find_first_of("<>", 1);
    if (end == std::string::npos) return std::nullopt;
    return bytes[end] == '>' ? end + 1 : end;
  }
};

/// The case is answered by one half and the closing probe by another.
TEST_F(WorthAskingTest, TwoHalvesAreNoFrame) {
  const EndedByHeads protocol;
  const auto cases_until_the_end = [&](const CaseResult& result) {
    int count = 1;
    while (count < 100 && worth_.after(result, protocol, true).empty()) ++count;
    return count;
  };
  CaseResult halves = with("<x");
  halves.exchange.push_back({Event::Kind::sent, 0ns, 0ns, to_bytes("<probe>"), ""});
  halves.exchange.push_back({Event::Kind::received, 0ns, 0ns, to_bytes("<y"), ""});
  EXPECT_EQ(cases_until_the_end(halves), 20);
  halves.exchange.back().bytes = to_bytes("<y>");
  EXPECT_EQ(cases_until_the_end(halves), 100);
}

TEST_F(WorthAskingTest, AFrameWipesTheDoubt) {
  for (int i = 0; i < 50; ++i)
    EXPECT_EQ(worth_.after(with(i % 5 == 4 ? "<x>" : "<"), protocol_, true), "");
}

TEST_F(WorthAskingTest, WhatTakesLongCountsForMore) {
  CaseResult endless = with("<xxxxx");
  endless.recording.flooded = true;
  EXPECT_EQ(cases_until_the_end(endless), 4);
}

TEST_F(WorthAskingTest, ASetUpThatNobodyAnswersCountsForMore) {
  EXPECT_EQ(cases_until_the_end(with(""), false), 4);
}

TEST_F(WorthAskingTest, ADeviceIsStartedAgainSoOften) {
  EXPECT_EQ(worth_.restart(with(""), true), "");
  EXPECT_EQ(worth_.restart(with(""), false), "");
  EXPECT_THAT(worth_.restart(with(""), true),
              HasSubstr("was lost 3 times (it ended, fell mute or sent without end), the last time "
                        "in p/a/b; it is not started again (--max-restarts 2)"));
}

class RestartTest : public WorthAskingTest {
 protected:
  void pass(WorthAsking& worth, int count) {
    CaseResult passed = with("<x>");
    passed.verdict = results::Verdict::pass;
    for (int i = 0; i < count; ++i) EXPECT_EQ(worth.after(passed, protocol_, true), "");
  }
};

TEST_F(RestartTest, NotWhereItFallsMuteAgainBeforeTenCasesHavePassed) {
  WorthAsking worth(20);
  EXPECT_EQ(worth.restart(with(""), false), "") << "what was before it counts for nothing";
  for (int i = 0; i < 2; ++i) {
    pass(worth, 9);
    EXPECT_EQ(worth.restart(with(""), false), "");
  }
  pass(worth, 9);
  EXPECT_THAT(worth.restart(with(""), false),
              HasSubstr("started again 3 times, and fell mute or sent without end in ordinary "
                        "requests each time before 10 cases had passed"));
}

TEST_F(RestartTest, TenCasesThatPassMakeItWorthWhile) {
  WorthAsking worth(20);
  for (int i = 0; i < 20; ++i) {
    pass(worth, i % 3 == 2 ? 10 : 9);
    EXPECT_EQ(worth.restart(with(""), false), "") << i;
  }
}

/// One frame after another kills it: each is named.
TEST_F(RestartTest, OneThatIsLostByOddFramesIsStartedAgainAsOftenAsIsAllowed) {
  WorthAsking worth(20);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(worth.restart(with(""), true), "") << i;
  EXPECT_NE(worth.restart(with(""), true), "");
}

}  // namespace
}  // namespace fieldproof::bench
