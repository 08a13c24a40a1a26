#include "harness/exchange/exchange.hpp"

#include <gmock/gmock.h>

#include "harness/exchange/scripted_endpoint.hpp"
#include "harness/test_protocol.hpp"
#include "harness/vectors/loader.hpp"

namespace fieldproof::exchange {

using harness::TestProtocol;

namespace {

using testing::ElementsAre;
using Pieces = std::vector<ScriptedEndpoint::Piece>;

/// Frames end by 4 ms of silence.
struct GapProtocol : TestProtocol {
  Duration frame_gap(Duration) const override { return 4ms; }
};
struct MuteProtocol : TestProtocol {
  Bytes probing_request(int, ByteView) const override { return {}; }
};

class ExchangeTest : public testing::Test {
 protected:
  ExchangeTest() {
    endpoint.answers["<probe>"] = Pieces{{1ms, "<alive>"}};
    endpoint.answers["<ask>"] = Pieces{{1ms, "<answer>"}};
  }

  /// What was sent, with the silence before it in ms: "<ask>", "4 <ask>".
  std::vector<std::string> exchange(const harness::Protocol& protocol, const std::string& steps,
                                    const std::string& config = "{}") {
    const std::string text =
        R"j({"id": "xgt_cnet/a/b", "rev": 1, "title": "what is tested", "level": "must", "basis": "printed rule",
      "statement": "m/1", "source": {"manual": "m", "section": "1", "quote": "as printed"}, "given": {"config": )j" +
        config + R"j(}, "steps": [)j" + steps + "]}";
    vectors::load_vector_text(text, "f.json", set_);
    const Result<PreparedCase> prepared = prepare(set_.cases.at(0), 1, protocol);
    EXPECT_TRUE(prepared);
    Exchange exchange(endpoint, protocol, {});
    const Transcript transcript = exchange.run(*prepared);
    std::vector<std::string> sent;
    Time quiet_since{};
    for (const results::Event& event : transcript.events) {
      if (event.kind == results::Event::Kind::note) continue;
      const auto gap = static_cast<int>(to_ms(event.start - quiet_since));
      if (event.kind == results::Event::Kind::sent)
        sent.push_back((gap ? std::to_string(gap) + ' ' : "") + to_text(event.bytes));
      quiet_since = event.end;
    }
    return sent;
  }

  ScriptedEndpoint endpoint;

 private:
  vectors::VectorSet set_;
};

constexpr const char* two_requests =
    R"({"send": "'<ask>'"}, {"expect": "'<answer>'"}, {"send": "'<ask>'"}, {"expect": "'<answer>'"})";

TEST_F(ExchangeTest, ProbesAreTimed) {
  endpoint.answers["<probe>"] = Pieces{{3ms, "<alive>"}};
  const TestProtocol protocol;
  Exchange exchange(endpoint, protocol, {});
  const Result<results::ResponseTimes> times = exchange.time_probes(1, 20, 2s);
  ASSERT_TRUE(times) << times.error().message;
  EXPECT_EQ(times->count(), 20u);
  EXPECT_DOUBLE_EQ(times->least(), 3);
  EXPECT_DOUBLE_EQ(times->greatest(), 3);
}

TEST_F(ExchangeTest, TimingProbesIsBounded) {
  endpoint.answers.clear();
  const TestProtocol protocol;
  Exchange exchange(endpoint, protocol, {});
  const Result<results::ResponseTimes> times = exchange.time_probes(1, 20, 2s);
  ASSERT_TRUE(times) << times.error().message;
  EXPECT_EQ(times->count(), 0u);
  EXPECT_LE(endpoint.sent.size(), 5u) << "nothing answers: half a second each, two seconds in all";
  const MuteProtocol mute;
  EXPECT_EQ(Exchange(endpoint, mute, {}).time_probes(1, 20, 2s)->count(), 0u);
}

TEST_F(ExchangeTest, ALineThatEchoesIsToldFromADeviceThatAnswers) {
  const TestProtocol protocol;
  std::size_t asked = 0;
  const auto sign = [&](Pieces pieces, const std::string& forgets = "") {
    ScriptedEndpoint line;
    line.answers["<probe>"] = std::move(pieces);
    line.forgets = forgets;
    const Result<Sign> first = Exchange(line, protocol, {}).first_sign(1, 2s);
    asked = line.sent.size();
    return *first;
  };
  EXPECT_EQ(sign({{1ms, "<alive>"}}), Sign::alive);
  EXPECT_EQ(asked, 1u) << "nothing is asked twice where nothing comes back";
  EXPECT_EQ(sign({{0ms, "<pro"}, {0ms, "be>"}}), Sign::echo);
  EXPECT_EQ(sign({{0ms, "<probe>"}, {1ms, "<alive>"}}), Sign::echo);
  EXPECT_EQ(sign({{0ms, "x"}, {0ms, "<probe><alive>"}}), Sign::echo) << "behind what was there";
  EXPECT_EQ(sign({}), Sign::silent);
  EXPECT_EQ(sign({{0ms, "<probe>"}}, "<probe>"), Sign::alive) << "once is no echo";
}

TEST_F(ExchangeTest, NothingIsWaitedForWhereFramesHaveAnEnd) {
  EXPECT_THAT(exchange(TestProtocol(), two_requests), ElementsAre("<ask>", "<ask>"));
}

TEST_F(ExchangeTest, ARequestComesAfterTheSilenceThatEndsAFrame) {
  EXPECT_THAT(exchange(GapProtocol(), two_requests), ElementsAre("4 <ask>", "4 <ask>"));
}

TEST_F(ExchangeTest, UnansweredRequestsAreKeptApart) {
  EXPECT_THAT(exchange(GapProtocol(), R"({"send": "'<a>'"}, {"send": "'<b>'"})"),
              ElementsAre("4 <a>", "4 <b>"));
}

TEST_F(ExchangeTest, TheProbeOfASilenceIsNoPartOfTheFrameBefore) {
  endpoint.can = {.wire = true, .real_device = true};
  EXPECT_THAT(exchange(GapProtocol(), R"({"send": "'<a>'"}, {"silence": true})"),
              ElementsAre("4 <a>", "4 <probe>", "4 <probe>"));
}

TEST_F(ExchangeTest, WithoutAWireAnAnswerSaysThatTheFrameHasEnded) {
  endpoint.can = {.back_door = true};
  EXPECT_THAT(exchange(GapProtocol(), two_requests), ElementsAre("<ask>", "<ask>", "<probe>"));
}

TEST_F(ExchangeTest, WithoutAWireNeighboursNeedToSeeTheEndOfAnAnswer) {
  endpoint.can = {.back_door = true};
  EXPECT_THAT(exchange(GapProtocol(), two_requests, R"({"neighbours": [2]})"),
              ElementsAre("100 <ask>", "100 <ask>", "100 <probe>"));
}

TEST_F(ExchangeTest, WithoutAWireAnUnansweredFrameEndsLater) {
  endpoint.can = {.back_door = true};
  EXPECT_THAT(exchange(GapProtocol(), R"({"send": "'<a>'"}, {"silence": true})"),
              ElementsAre("<a>", "100 <probe>", "<probe>"));
}

TEST_F(ExchangeTest, WithoutAProbeASilenceIsWaitedOut) {
  endpoint.can = {.wire = true, .real_device = true};
  EXPECT_THAT(exchange(MuteProtocol(), R"({"send": "'<a>'"}, {"silence": true})"),
              ElementsAre("<a>"));
  EXPECT_GE(endpoint.now(), Time(500ms));
}

TEST_F(ExchangeTest, WhereTheProbeIsLostTheNextRequestIsThatOfTheCase) {
  endpoint.can = {.wire = true, .real_device = true};
  endpoint.answers.erase("<probe>");
  EXPECT_THAT(
      exchange(GapProtocol(), R"({"send": "'<a>'"}, {"silence": true}, {"send": "'<ask>'"})"),
      ElementsAre("4 <a>", "4 <probe>", "500 <a>", "500 <ask>", "4 <probe>"));
}

TEST_F(ExchangeTest, WhereNothingFollowsALostProbeNothingIsRepeated) {
  endpoint.can = {.wire = true, .real_device = true};
  endpoint.answers.erase("<probe>");
  EXPECT_THAT(exchange(GapProtocol(), R"({"send": "'<a>'"}, {"silence": true})"),
              ElementsAre("4 <a>", "4 <probe>", "500 <probe>"));
}

TEST_F(ExchangeTest, NoProbeFallsIntoAFrameThatGoesOn) {
  endpoint.can = {.wire = true, .real_device = true};
  endpoint.answers["<probe>"] = Pieces{{1ms, "<alive>"}};
  EXPECT_THAT(exchange(TestProtocol(), R"({"send": "'<as'"}, {"silence": true}, {"send": "'k>'"})"),
              ElementsAre("<as", "500 k>", "<probe>"));
}

TEST_F(ExchangeTest, AProbeFallsBeforeAFrameThatBeginsAnew) {
  endpoint.can = {.wire = true, .real_device = true};
  endpoint.answers["<probe>"] = Pieces{{1ms, "<alive>"}};
  EXPECT_THAT(
      exchange(TestProtocol(), R"({"send": "'<as'"}, {"silence": true}, {"send": "'<ask>'"})"),
      ElementsAre("<as", "100 <probe>", "<ask>", "<probe>"));
}

TEST_F(ExchangeTest, ASilenceOfAGivenTimeIsWaitedOut) {
  endpoint.can = {.wire = true, .real_device = true};
  EXPECT_THAT(exchange(GapProtocol(), R"({"silence": true, "within": "2s"})"),
              ElementsAre("2000 <probe>"));
}

}  // namespace

}  // namespace fieldproof::exchange
