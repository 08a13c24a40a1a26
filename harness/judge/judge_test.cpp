// Exchange and judge together, over a scripted endpoint: what happened on the line, and the verdict
// that follows.
#include "harness/judge/judge.hpp"

#include <gmock/gmock.h>

#include "harness/exchange/exchange.hpp"
#include "harness/exchange/scripted_endpoint.hpp"
#include "harness/judge/recording.hpp"
#include "harness/test_protocol.hpp"
#include "harness/vectors/loader.hpp"
#include "reports/results/result_json.hpp"

namespace fieldproof::judging {

using results::Verdict;

namespace {

using testing::HasSubstr;
using Pieces = std::vector<exchange::ScriptedEndpoint::Piece>;

class JudgeTest : public testing::Test {
 protected:
  /// Loads a case with these steps and attributes, runs it against `endpoint`, judges it by
  /// `rules`.
  Judgement judged(const std::string& steps, const std::string& level = "must",
                   const std::string& basis = "printed rule", const std::string& more = "") {
    set_ = {};
    vectors::load_vector_text(
        R"j([{"id": "xgt_cnet/a/b", "rev": 1, "title": "what is tested", "level": ")j" + level +
            R"j(", "basis": ")j" + basis + R"j(", "why": "because we say so", )j" + more +
            R"j("statement": "m/1", "source": {"manual": "m", "section": "1", "quote": "as printed"}, "steps": [)j" +
            steps + "]}]",
        "f.json", set_);
    EXPECT_THAT(set_.problems, testing::IsEmpty());
    Result<exchange::PreparedCase> prepared = exchange::prepare(set_.cases.at(0), 1, protocol_);
    EXPECT_TRUE(prepared);
    prepared_ = *prepared;
    for (const std::size_t step : passed_over) prepared_.steps.at(step).passed_over = true;
    exchange::Exchange exchange(endpoint, protocol_, {});
    transcript = exchange.run(prepared_);
    const Judgement judgement = judge(prepared_, transcript, rules, protocol_);
    expect_recording_judged_alike(judgement);
    return judgement;
  }

  /// Whatever is judged live is judged alike from a result file.
  void expect_recording_judged_alike(const Judgement& live) {
    results::CaseResult recorded;
    recorded.id = "xgt_cnet/a/b";
    recorded.exchange = {transcript.events.begin(), transcript.events.end()};
    recorded.recording = make_recording(prepared_, transcript, rules);
    EXPECT_EQ(recorded.recording.stimulus.empty(), transcript.trouble.has_value())
        << "trouble of the bench cannot be judged";
    if (transcript.trouble) return;
    std::string written;
    results::append_json(written, recorded);
    const auto loaded = nlohmann::json::parse(written).get<results::CaseResult>();
    const Result<exchange::Transcript> again = replay(loaded, prepared_, 500ms);
    ASSERT_TRUE(again) << again.error().message;
    const Judgement offline = judge(prepared_, *again, rules, protocol_);
    EXPECT_EQ(offline.verdict, live.verdict) << offline.message;
    EXPECT_EQ(offline.message, live.message);
    EXPECT_EQ(offline.received.bytes, live.received.bytes);
    EXPECT_EQ(offline.response_ms, live.response_ms);
    EXPECT_EQ(offline.readings, live.readings);
  }

  static std::string ask() { return R"({"send": "'<ask>'"}, {"expect": "'<answer>'"})"; }

  exchange::ScriptedEndpoint endpoint;
  JudgeRules rules;
  std::vector<std::size_t> passed_over;  // steps
  exchange::Transcript transcript;
  vectors::VectorSet set_;

 private:
  harness::TestProtocol protocol_;
  exchange::PreparedCase prepared_;
};

TEST_F(JudgeTest, TheExpectedReplyPasses) {
  endpoint.answers["<ask>"] = Pieces{{10ms, "<answer>"}};
  const Judgement result = judged(ask());
  EXPECT_EQ(result.verdict, Verdict::pass) << result.message;
  ASSERT_EQ(result.response_ms.size(), 1u);
  EXPECT_DOUBLE_EQ(result.response_ms[0], 10.0);
}

/// A client asks again before the answer to its first request is complete, and the floor of the
/// link is what can be told apart.
TEST_F(JudgeTest, ARequestBeforeTheAnswerIsCompleteIsPipelining) {
  const std::string client = R"("given": {"config": {"role": "client"}}, )",
                    steps = R"({"send": "'<go>'"}, {"expect": "'<q1>'"}, {"send": "'<answer1>'"},
                               {"expect": "'<q2>'"})";
  endpoint.answers["<go>"] = Pieces{{1ms, "<q1>"}, {6ms, "<q2>"}};
  const Judgement early = judged(steps, "must", "printed rule", client);
  EXPECT_EQ(early.verdict, Verdict::fail);
  EXPECT_EQ(early.message,
            "pipelining: the request came too early: 8.0 ms before the answer to the one before it "
            "was complete");
  rules.timing_floor = 9ms;
  EXPECT_EQ(judged(steps, "must", "printed rule", client).verdict, Verdict::pass);
}

/// Nobody has looked into a client that has no second channel: that is no verdict on it.
TEST_F(JudgeTest, WhatNobodyReadsIsNotJudged) {
  const std::string client = R"("given": {"config": {"role": "client"}}, )",
                    look = R"({"wait": "10ms"}, {"check": {"%MW1": "00FF"}})",
                    asks = R"({"send": "'<go>'"}, {"expect": "'<q1>'"}, )";
  for (const char* level : {"must", "should", "info"}) {
    const Judgement alone = judged(look, level, "printed rule", client);
    EXPECT_EQ(alone.verdict, Verdict::inconclusive) << level;
    EXPECT_EQ(alone.message,
              "the line shows nothing wrong, but what the case looks at in the device is not "
              "judged: %MW1 could not be read; give --aux, a second port of it");
  }
  endpoint.answers["<go>"] = Pieces{{1ms, "<q1>"}};
  EXPECT_EQ(judged(asks + look, "must", "printed rule", client).verdict, Verdict::inconclusive);
  EXPECT_THAT(judged(R"({"check": {"@status": "0005"}})", "must", "printed rule", client).message,
              HasSubstr("@status could not be read: no request asks for counters"));
}

TEST_F(JudgeTest, ACaseAboutTheLineIsJudgedByIt) {
  endpoint.answers["<go>"] = Pieces{{1ms, "<q1>"}};
  const Judgement result =
      judged(R"({"send": "'<go>'"}, {"expect": "'<q1>'"}, {"check": {"%MW1": "00FF"}})", "must",
             "printed rule", R"("line_alone": true, "given": {"config": {"role": "client"}}, )");
  EXPECT_EQ(result.verdict, Verdict::pass);
  EXPECT_THAT(result.notes, testing::ElementsAre(HasSubstr("judged on the wire alone: %MW1")));
}

/// What the line shows against it stands.
TEST_F(JudgeTest, AMissOnTheLineIsOneWhateverIsNotRead) {
  endpoint.answers["<go>"] = Pieces{{1ms, "<q2>"}};
  const Judgement wrong =
      judged(R"({"send": "'<go>'"}, {"expect": "'<q1>'"}, {"check": {"%MW1": "00FF"}})", "must",
             "printed rule", R"("given": {"config": {"role": "client"}}, )");
  EXPECT_EQ(wrong.verdict, Verdict::fail);
  EXPECT_THAT(wrong.notes, testing::ElementsAre(HasSubstr("judged on the wire alone: %MW1")));
}

/// Both ends of a turnaround, its guard band and the floor below which it cannot be judged.
TEST_F(JudgeTest, TurnaroundHasALeastTime) {
  rules.turnaround_min = 4ms;
  const auto verdict = [&](Duration after) {
    endpoint.answers["<ask>"] = Pieces{{after, "<answer>"}};
    return judged(ask());
  };
  EXPECT_EQ(verdict(3999us).verdict, Verdict::fail);
  EXPECT_EQ(verdict(3999us).message,
            "early answer: 3.999 ms after the request, the turnaround is 4.000 ms at least");
  EXPECT_EQ(verdict(4ms).verdict, Verdict::marginal);
  EXPECT_EQ(verdict(4399us).verdict, Verdict::marginal);
  EXPECT_EQ(verdict(4400us).verdict, Verdict::pass);
  rules.decisions.all = false;
  EXPECT_EQ(verdict(3999us).verdict, Verdict::non_strict);
  rules.timing_floor = 5ms;
  EXPECT_EQ(verdict(3999us).verdict, Verdict::inconclusive);
}

TEST_F(JudgeTest, TheLimitOfTheProfileBelowTheFloorIsInconclusiveToo) {
  endpoint.answers["<ask>"] = Pieces{{10ms, "<answer>"}};
  rules.timing_floor = 501ms;
  EXPECT_EQ(judged(ask()).verdict, Verdict::inconclusive);
  rules.timing_floor = 500ms;
  EXPECT_EQ(judged(ask()).verdict, Verdict::pass);
}

TEST_F(JudgeTest, NoAnswerFails) {
  const Judgement result = judged(ask());
  EXPECT_EQ(result.verdict, Verdict::fail);
  EXPECT_EQ(result.message, "no answer within 500 ms");
  ASSERT_NE(result.expected, nullptr);
}

TEST_F(JudgeTest, AnotherReplyFailsAtTheFieldThatDiffers) {
  endpoint.answers["<ask>"] = Pieces{{10ms, "<ansWer>"}};
  const Judgement result = judged(ask());
  EXPECT_EQ(result.verdict, Verdict::fail);
  EXPECT_EQ(result.message, "byte 4: expected w, got W");
  ASSERT_EQ(result.differences.size(), 1u);
}

TEST_F(JudgeTest, AReplyCutShortFails) {
  endpoint.answers["<ask>"] = Pieces{{10ms, "<answ"}};
  EXPECT_EQ(judged(ask()).message, "byte 5: expected e, got nothing");
}

TEST_F(JudgeTest, BytesAfterTheReplyFailTheSameCase) {
  endpoint.answers["<ask>"] = Pieces{{10ms, "<answer>xy"}};
  EXPECT_EQ(judged(ask()).message, "2 bytes after the complete exchange: 'xy'");
}

TEST_F(JudgeTest, BytesMuchLaterStillBelongToTheCase) {
  endpoint.answers["<ask>"] = Pieces{{10ms, "<answer>"}, {900ms, "<answer>"}};
  EXPECT_THAT(judged(ask()).message, HasSubstr("8 bytes after the complete exchange"));
}

TEST_F(JudgeTest, BytesBeforeTheNextSendBelongToWhatWasOpen) {
  endpoint.answers["<ask>"] = Pieces{{0ms, "<answer>x"}};
  EXPECT_THAT(judged(ask() + ", " + ask()).message, HasSubstr("after the complete exchange"));
}

TEST_F(JudgeTest, TwoRepliesInOneBurstAnswerTwoExpectations) {
  endpoint.answers["<ask><ask>"] = Pieces{{1ms, "<answer><other>"}};
  const Judgement result =
      judged(R"({"send": "'<ask>'*2"}, {"expect": "'<answer>'"}, {"expect": "'<other>'"})");
  EXPECT_EQ(result.verdict, Verdict::pass) << result.message;
}

TEST_F(JudgeTest, OurOwnRequestIsNamedEcho) {
  endpoint.answers["<ask>"] = Pieces{{0ms, "<ask>"}};
  EXPECT_THAT(judged(ask()).message, HasSubstr("our own request came back (echo)"));
}

TEST_F(JudgeTest, ALateAnswerFailsWhereTimingBindsAndIsNeverCreditedToTheNextRequest) {
  endpoint.answers["<ask>"] = Pieces{{600ms, "<answer>"}};
  EXPECT_THAT(judged(ask()).message,
              HasSubstr("late answer: 600.0 ms after the request, the limit is 500 ms"));
  rules.decisions.all = false;
  EXPECT_EQ(judged(ask()).verdict, Verdict::non_strict);
}

/// What the device is told to wait for comes before the time that it needs itself.
TEST_F(JudgeTest, TheLimitOfAReplyBeginsBehindTheDelay) {
  const std::string delay = R"("given": {"config": {"rs485": true, "delay_ms": 400}}, )";
  endpoint.answers["<ask>"] = Pieces{{700ms, "<answer>"}};
  EXPECT_EQ(judged(ask(), "must", "printed rule", delay).verdict, Verdict::pass);
  endpoint.answers["<ask>"] = Pieces{{910ms, "<answer>"}};
  EXPECT_THAT(judged(ask(), "must", "printed rule", delay).message,
              HasSubstr("late answer: 910.0 ms after the request, the limit is 900 ms"));
}

TEST_F(JudgeTest, ALateAnswerToAnEarlierRequestIsSurplusThere) {
  endpoint.answers["<ask>"] = Pieces{{600ms, "<answer>"}};
  endpoint.answers["<next>"] = Pieces{{10ms, "<answer>"}};
  const Judgement result = judged(
      R"({"send": "'<ask>'"}, {"wait": "100ms"}, {"send": "'<next>'"}, {"expect": "'<answer>'"})");
  EXPECT_EQ(result.verdict, Verdict::fail);
}

TEST_F(JudgeTest, TheGuardBandIsMarginal) {
  endpoint.answers["<ask>"] = Pieces{{460ms, "<answer>"}};
  EXPECT_EQ(judged(ask()).verdict, Verdict::marginal);
}

TEST_F(JudgeTest, ALimitOfTheVectorBindsAlways) {
  endpoint.answers["<ask>"] = Pieces{{60ms, "<answer>"}};
  rules.decisions.all = false;
  EXPECT_EQ(judged(R"({"send": "'<ask>'"}, {"expect": "'<answer>'", "within": "50ms"})").verdict,
            Verdict::fail);
}

TEST_F(JudgeTest, ALimitBelowTheFloorOfTheLinkIsInconclusive) {
  endpoint.answers["<ask>"] = Pieces{{3ms, "<answer>"}};
  rules.timing_floor = 20ms;
  EXPECT_EQ(judged(R"({"send": "'<ask>'"}, {"expect": "'<answer>'", "within": "5ms"})").verdict,
            Verdict::inconclusive);
}

TEST_F(JudgeTest, ASplitAnswerFailsAtTheGap) {
  endpoint.answers["<ask>"] = Pieces{{1ms, "<ans"}, {25ms, "wer>"}};
  const Judgement result = judged(ask());
  EXPECT_EQ(result.message,
            "split answer: 20.0 ms of silence before byte 4 of the reply, the limit is 4.0 ms");
}

TEST_F(JudgeTest, SilenceThatTheDriverMayMakeIsNoFault) {
  rules.max_gap = 3ms;
  rules.gap_stated = true;
  rules.gap_floor = 5ms;
  endpoint.answers["<ask>"] = Pieces{{1ms, "<ans"}, {11ms, "wer>"}};  // 6 ms of silence
  const Judgement result = judged(ask());
  EXPECT_EQ(result.verdict, Verdict::inconclusive);
  EXPECT_EQ(result.message,
            "split answer: 6.0 ms of silence before byte 4 of the reply, the limit is 3.0 ms: this "
            "link may make 5.0 ms itself");
  endpoint.answers["<ask>"] = Pieces{{1ms, "<ans"}, {14ms, "wer>"}};
  EXPECT_EQ(judged(ask()).verdict, Verdict::fail) << "9 ms";
  endpoint.answers["<ask>"] = Pieces{{1ms, "<answer>"}};
  EXPECT_EQ(judged(ask()).verdict, Verdict::pass) << "nothing speaks against it";
}

TEST_F(JudgeTest, ACaseAboutAGapIsNotPassedWhereTheLinkCannotShowIt) {
  rules.gap_floor = 5ms;
  endpoint.answers["<ask>"] = Pieces{{1ms, "<answer>"}};
  const std::string steps = R"({"send": "'<ask>'"}, {"expect": "'<answer>'", "max_gap": "3ms"})";
  EXPECT_EQ(judged(steps).verdict, Verdict::inconclusive);
  rules.gap_floor = 2ms;
  EXPECT_EQ(judged(steps).verdict, Verdict::pass);
}

TEST_F(JudgeTest, AReplyThatBeginsBeforeItsRequestIsOverIsOfAnotherOne) {
  endpoint.answers["<ask>"] = Pieces{{-4ms, "<answer>"}};
  EXPECT_EQ(judged(ask()).verdict, Verdict::pass) << "no wire";
  rules.earliest = -1ms;
  const Judgement result = judged(ask());
  EXPECT_EQ(result.verdict, Verdict::inconclusive);
  EXPECT_THAT(result.message, HasSubstr("the reply began 4.0 ms before the request was over"));
}

TEST_F(JudgeTest, BytesThatADriverHandsOverOneByOneAreOneLineOfTheExchange) {
  endpoint.answers["<ask>"] = Pieces{{1ms, "<"}, {2ms, "ans"}, {15ms, "wer>"}};
  judged(ask());
  results::CaseResult result;
  take_exchange(transcript, 100, result, 2ms);
  std::vector<std::string> came;
  for (const results::Event& event : result.exchange)
    if (event.kind == results::Event::Kind::received) came.push_back(to_text(event.bytes));
  EXPECT_THAT(came, testing::ElementsAre("<ans", "wer>"));
}

TEST_F(JudgeTest, ABytePerSecondIsNoReply) {
  endpoint.answers["<ask>"] = Pieces{{1s, "<"}, {2s, "a"}, {3s, "n"}};
  EXPECT_EQ(judged(ask()).verdict, Verdict::fail);
}

TEST_F(JudgeTest, AFloodFails) {
  endpoint.answers["<ask>"] = Pieces(50, {1ms, std::string(1000, 'x')});
  const Judgement result = judged(ask());
  EXPECT_THAT(result.message, HasSubstr("floods"));
  EXPECT_TRUE(transcript.flooded);
}

TEST_F(JudgeTest, SilenceIsWaitedOutAndBroken) {
  const std::string steps = R"({"send": "'<bad>'"}, {"silence": true})";
  EXPECT_EQ(judged(steps).verdict, Verdict::pass);
  endpoint.answers["<bad>"] = Pieces{{900ms, "<answer>"}};
  EXPECT_EQ(judged(steps).message, "8 bytes came where silence is due: '<answer>'");
}

TEST_F(JudgeTest, InRealTimeAProbeProvesSilence) {
  endpoint.can.simulated = false;
  endpoint.answers["<probe>"] = Pieces{{1ms, "<alive>"}};
  const std::string steps = R"({"send": "'<bad>'"}, {"silence": true})";
  EXPECT_EQ(judged(steps).verdict, Verdict::pass);
  EXPECT_LT(endpoint.now(), 200ms) << "no wait longer than the proof needs";
  endpoint.answers["<bad>"] = Pieces{{1ms, "<answer>"}};
  EXPECT_EQ(judged(steps).message, "8 bytes came where silence is due: '<answer>'");
}

TEST_F(JudgeTest, InRealTimeWhatComesBeforeTheClosingProbesReplyBelongsToTheCase) {
  endpoint.can.simulated = false;
  endpoint.answers["<probe>"] = Pieces{{1ms, "<alive>"}};
  endpoint.answers["<ask>"] = Pieces{{1ms, "<answer>"}, {5ms, "<answer>"}};
  EXPECT_THAT(judged(ask()).message, HasSubstr("8 bytes after the complete exchange"));
}

TEST_F(JudgeTest, ALinkThatDiesIsBlamedOnTheFrame) {
  endpoint.can.simulated = false;
  endpoint.answers["<ask>"] = Pieces{{1ms, "<answer>"}};
  EXPECT_EQ(judged(ask()).message, "link dead after this frame: nothing answers any more");
}

TEST_F(JudgeTest, ALinkThatDiesIsNotedBesideTheMissThatShowsIt) {
  endpoint.can.simulated = false;
  const auto found = judged(ask());
  EXPECT_EQ(found.message, "no answer within 500 ms");
  EXPECT_THAT(found.notes,
              Contains(HasSubstr("link dead after this frame: nothing answers any more")));
}

TEST_F(JudgeTest, ADeviceThatAnswersProbesItsOwnWayIsAlive) {
  endpoint.can.simulated = false;
  endpoint.answers["<probe>"] = Pieces{{1ms, "<what?>"}};
  endpoint.answers["<ask>"] = Pieces{{1ms, "<answer>"}};
  EXPECT_EQ(judged(ask()).verdict, Verdict::pass);
}

TEST_F(JudgeTest, MemoryIsComparedWhateverTheCase) {
  endpoint.can.back_door = true;
  endpoint.memory["%MW1"] = "00ff";
  EXPECT_EQ(judged(R"({"check": {"%MW1": "00FF"}})").verdict, Verdict::pass);
  endpoint.memory["%MW1"] = "00FE";
  EXPECT_EQ(judged(R"({"check": {"%MW1": "00FF"}})").message, "%MW1 holds 00FE, 00FF is due");
}

/// Of a device whose moments nobody can see, what comes out in the end is judged.
TEST_F(JudgeTest, ALookThatIsPassedOverIsNoVerdict) {
  endpoint.can.back_door = true;
  endpoint.memory["%MW1"] = "00FF";
  passed_over = {0};
  const auto ends_with = [this](const std::string& due) {
    return judged(R"({"check": {"%MW1": "0001"}}, {"check": {"%MW1": ")" + due + "\"}}");
  };
  const Judgement right = ends_with("00FF");
  EXPECT_EQ(right.verdict, Verdict::inconclusive);
  EXPECT_EQ(right.message,
            "what is seen at rest is right; not judged: 1 of 2 looks, at what is so for "
            "milliseconds, which no request that is sent here hits");
  const Judgement wrong = ends_with("00FE");
  EXPECT_EQ(wrong.verdict, Verdict::fail);
  EXPECT_EQ(wrong.message, "%MW1 holds 00FF, 00FE is due");
  EXPECT_THAT(wrong.notes, testing::Contains(HasSubstr("not judged: 1 of 2 looks")));
}

/// Nor is an allowed reading of what is seen at rest one.
TEST_F(JudgeTest, ALookThatIsPassedOverLeavesAReadingOpen) {
  endpoint.can.back_door = true;
  endpoint.memory["%MW1"] = "0002";
  passed_over = {0};
  const Judgement other = judged(
      R"({"check": {"%MW1": "0009"}}, {"check": {"reading": "r", "a": {"%MW1": "0001"}, "b": {"%MW1": "0002"}}})");
  EXPECT_EQ(other.verdict, Verdict::inconclusive) << other.message;
  EXPECT_EQ(other.readings.at("r"), "b");
}

TEST_F(JudgeTest, NumbersAreToldAsTheyWereWritten) {
  endpoint.can.back_door = true;
  endpoint.memory["SD8"] = "3A9B0000";
  const auto checked = [this](const std::string& due) {
    return judged("{\"check\": {\"SD8\": \"" + due + "\"}}");
  };
  EXPECT_EQ(checked("dec32(15003)").verdict, Verdict::pass);
  EXPECT_EQ(checked("dec32(15000..15003)").verdict, Verdict::pass);
  EXPECT_EQ(checked("dec32(14990..15002)").message, "SD8 holds 15003, 14990 to 15002 is due");
}

TEST_F(JudgeTest, WithoutABackDoorMemoryGoesThroughTheProtocol) {
  endpoint.answers["<w%MW1=1234>"] = Pieces{{1ms, "<ok>"}};
  endpoint.answers["<r%MW1>"] = Pieces{{1ms, "<1234>"}};
  EXPECT_EQ(judged(R"({"set": {"%MW1": "1234"}}, {"check": {"%MW1": "1234"}})").verdict,
            Verdict::pass);
}

TEST_F(JudgeTest, AWriteThatTheDeviceRefusesIsNotTheFaultOfWhatIsTested) {
  endpoint.answers["<w%MW1=1234>"] = Pieces{{1ms, "<no>"}};
  const Judgement result = judged(R"({"set": {"%MW1": "1234"}})");
  EXPECT_EQ(result.verdict, Verdict::blocked);
  EXPECT_EQ(result.message, "set-up: cannot set %MW1: not <ok>");
}

TEST_F(JudgeTest, WhatTheEndpointCannotDoIsBlocked) {
  EXPECT_EQ(judged(R"({"do": "dance"})").verdict, Verdict::blocked);
}

TEST_F(JudgeTest, AnAllowedAlternativeIsNonStrictAndItsReadingIsNoted) {
  const std::string steps =
      R"({"send": "'<ask>'"}, {"expect": {"reading": "echo", "as_sent": "'<ss>'", "upper": "'<SS>'"}})";
  endpoint.answers["<ask>"] = Pieces{{1ms, "<ss>"}};
  EXPECT_EQ(judged(steps).verdict, Verdict::pass);
  endpoint.answers["<ask>"] = Pieces{{1ms, "<SS>"}};
  const Judgement result = judged(steps);
  EXPECT_EQ(result.verdict, Verdict::non_strict);
  EXPECT_EQ(result.readings.at("echo"), "upper");
  endpoint.answers["<ask>"] = Pieces{{1ms, "<sS>"}};
  EXPECT_EQ(judged(steps).verdict, Verdict::fail);
}

/// Where the manual says two things of what is in memory, either is allowed, and no third.
TEST_F(JudgeTest, MemoryMayHaveNamedAlternatives) {
  const std::string check =
      R"j({"check": {"reading": "stop", "back": {"%MW1": "0001", "%MW2": "0002"}, "past": {"%MW1": "dec(9)", "%MW2": "dec(7..8)"}}})j";
  const auto holding = [&](const std::string& one, const std::string& two) {
    endpoint.answers["<r%MW1>"] = Pieces{{1ms, "<" + one + ">"}};
    endpoint.answers["<r%MW2>"] = Pieces{{1ms, "<" + two + ">"}};
    return judged(check + "," + check);
  };
  EXPECT_EQ(holding("0001", "0002").verdict, Verdict::pass);
  const Judgement other = holding("0009", "0008");
  EXPECT_EQ(other.verdict, Verdict::non_strict);
  EXPECT_EQ(other.message, "allowed alternative: stop = past");
  EXPECT_EQ(other.readings.at("stop"), "past");
  const Judgement neither = holding("0001", "0008");
  EXPECT_EQ(neither.verdict, Verdict::fail);
  EXPECT_EQ(neither.message, "%MW2 holds 0008, 0002 is due; it is no alternative of stop either");
}

TEST_F(JudgeTest, ACaseThatMixesItsReadingsIsNonStrict) {
  endpoint.answers["<r%MW1>"] = Pieces{{1ms, "<0001>"}};
  endpoint.answers["<r%MW2>"] = Pieces{{1ms, "<0002>"}};
  const Judgement result = judged(
      R"({"check": {"reading": "stop", "back": {"%MW1": "0001"}, "past": {"%MW1": "0002"}}},
         {"check": {"reading": "stop", "back": {"%MW2": "0001"}, "past": {"%MW2": "0002"}}})");
  EXPECT_EQ(result.verdict, Verdict::non_strict);
  EXPECT_EQ(result.message, "mixes readings: stop = past, and back before");
}

TEST_F(JudgeTest, CapturesTieStepsTogether) {
  endpoint.answers["<ask>"] = Pieces{{1ms, "<1234>"}};
  endpoint.answers["<1234!>"] = Pieces{{1ms, "<1234>"}};
  EXPECT_EQ(
      judged(
          R"({"send": "'<ask>'"}, {"expect": "'<' {id:4} '>'"}, {"send": "'<' {id} '!>'"}, {"expect": "'<' {id} '>'"})")
          .verdict,
      Verdict::pass);
}

TEST_F(JudgeTest, LevelAndBasisDecideWhatAMissMeans) {
  endpoint.answers["<ask>"] = Pieces{{1ms, "<no>"}};
  EXPECT_EQ(judged(ask(), "must").verdict, Verdict::fail);
  EXPECT_EQ(judged(ask(), "should").verdict, Verdict::non_strict);
  EXPECT_EQ(judged(ask(), "info").verdict, Verdict::info);
  EXPECT_EQ(judged(ask(), "must", "decision").verdict, Verdict::fail);
  rules.decisions.all = false;
  EXPECT_EQ(judged(ask(), "must", "decision").verdict, Verdict::non_strict);
}

TEST_F(JudgeTest, WhatIsDerivedFromADecisionBindsAsThatDoes) {
  endpoint.answers["<ask>"] = Pieces{{1ms, "<no>"}};
  rules.decisions.all = false;
  EXPECT_EQ(judged(ask(), "must", "derived").verdict, Verdict::fail);
  const std::string resting = R"(derived", "decision": ["cnet/bcc"], "rev": 1, "level": "must)";
  EXPECT_EQ(judged(ask(), "must", resting).verdict, Verdict::non_strict);
  EXPECT_THAT(judged(ask(), "must", resting).notes, testing::Contains("decision cnet/bcc"));
  rules.decisions.named = {"cnet/bcc"};
  EXPECT_EQ(judged(ask(), "must", resting).verdict, Verdict::fail);
  const std::string two =
      R"(decision", "decision": ["cnet/bcc", "cnet/other"], "rev": 1, "level": "must)";
  EXPECT_EQ(judged(ask(), "must", two).verdict, Verdict::non_strict) << "one does not bind";
  rules.decisions.all = true;
  EXPECT_THAT(judged(ask(), "must", resting).notes, testing::Contains("decision cnet/bcc"));
  EXPECT_EQ(judged(ask(), "must", resting).verdict, Verdict::fail);
}

/// The clause that is told is that of the step.
TEST_F(JudgeTest, AStepThatFailsIsToldUnderItsOwnClause) {
  const auto clause = [&](const std::string& steps, std::size_t own) {
    Judgement judgement = judged(steps);
    set_.cases.at(0).steps.at(own).source = {"m", "7.1.5 (1)(c)", "ACK carries the data", {}};
    results::CaseResult result = result_of(set_.cases.at(0));
    take_judgement(std::move(judgement), result);
    return result.section + ": " + result.quote;
  };
  endpoint.answers["<ask>"] = Pieces{{1ms, "<no>"}};
  EXPECT_EQ(clause(ask(), 1), "7.1.5 (1)(c): ACK carries the data");
  EXPECT_EQ(clause(ask(), 0), "1: as printed") << "another step failed";
  endpoint.answers["<ask>"] = Pieces{{1ms, "<yes>"}};
  EXPECT_EQ(clause(R"({"send": "'<ask>'"}, {"expect": "'<yes>'"})", 1), "1: as printed");
}

TEST_F(JudgeTest, AFailureSaysWhenTheAnswerWasDue) {
  const auto due = [&](const std::string& steps) {
    results::CaseResult result;
    take_judgement(judged(steps), result);
    return result.due;
  };
  endpoint.answers["<ask>"] = Pieces{{1ms, "<no>"}};
  const results::Due failed = due(ask());
  EXPECT_EQ(to_ms(failed.until - failed.from), 500);
  endpoint.answers["<ask>"] = Pieces{{1ms, "<yes>"}};
  EXPECT_TRUE(due(R"({"send": "'<ask>'"}, {"expect": "'<yes>'"})").empty());
}

/// A refusal is due, and the device does what was asked: no wiring is to blame.
TEST_F(JudgeTest, ANormalReplyThatRepeatsTheRequestIsNoEcho) {
  endpoint.answers["<write>"] = Pieces{{1ms, "<write>"}};
  endpoint.answers["<ask>"] = Pieces{{1ms, "<ask>"}};
  EXPECT_THAT(judged(R"({"send": "'<write>'"}, {"expect": "'<no>'"})").message,
              HasSubstr("the request came back, which is its normal reply"));
  EXPECT_THAT(judged(R"({"send": "'<ask>'"}, {"expect": "'<no>'"})").message,
              HasSubstr("our own request came back (echo)"));
}

TEST_F(JudgeTest, AFailingPortIsAnErrorNotAFailure) {
  endpoint.fails_after = 0;
  const Judgement result = judged(ask());
  EXPECT_EQ(result.verdict, Verdict::error);
  EXPECT_EQ(result.message, "the port is gone");
}

TEST_F(JudgeTest, NothingPassesByDefault) {
  exchange::PreparedCase nothing;
  vectors::Case source;
  nothing.source = &source;
  EXPECT_EQ(judge(nothing, {}, {}, harness::TestProtocol{}).verdict, Verdict::error);
}

TEST_F(JudgeTest, ACadenceIsMeasured) {
  endpoint.answers["<go>"] = Pieces{{100ms, "<tick>"}, {300ms, "<tick>"}, {500ms, "<tick>"}};
  const std::string steps =
      R"({"send": "'<go>'"}, {"expect": "'<tick>'", "times": 3, "every": "200ms"})";
  EXPECT_EQ(judged(steps).verdict, Verdict::pass);
  endpoint.answers["<go>"][2].after = 450ms;
  EXPECT_THAT(judged(steps).message, HasSubstr("came after 150.0 ms instead of every 200.0 ms"));
}

/// A link that can be 20 ms off, and a reply around the end of a wait.
TEST_F(JudgeTest, WhatComesJustBeforeTheEndOfASilenceIsInconclusive) {
  const std::string steps = R"({"send": "'<ask>'"}, {"wait": "100ms"}, {"expect": "'<answer>'"})";
  rules.timing_floor = 20ms;
  endpoint.answers["<ask>"] = Pieces{{90ms, "<answer>"}};
  EXPECT_EQ(judged(steps).verdict, Verdict::inconclusive);
  EXPECT_THAT(judged(steps).message, HasSubstr("8 bytes came 10.0 ms before the end of the "
                                               "silence: this link may make 20.0 ms itself"));
  endpoint.answers["<ask>"] = Pieces{{79ms, "<answer>"}};
  EXPECT_EQ(judged(steps).verdict, Verdict::fail);
  endpoint.answers["<ask>"] = Pieces{{101ms, "<answer>"}};
  EXPECT_EQ(judged(steps).verdict, Verdict::pass);
  rules.timing_floor = 0ns;
  endpoint.answers["<ask>"] = Pieces{{90ms, "<answer>"}};
  EXPECT_EQ(judged(steps).verdict, Verdict::fail);
}

/// The edge of a fast clock is seen by the scan behind it.
TEST_F(JudgeTest, AFastClockMayBeShiftedByAScan) {
  const std::string steps =
      R"({"send": "'<go>'"}, {"expect": "'<tick>'", "times": 2, "every": "20ms"})";
  endpoint.answers["<go>"] = Pieces{{20ms, "<tick>"}, {42400us, "<tick>"}};
  EXPECT_EQ(judged(steps).verdict, Verdict::marginal);
  endpoint.answers["<go>"][1].after = 41900us;
  EXPECT_EQ(judged(steps).verdict, Verdict::pass) << judged(steps).message;
  endpoint.answers["<go>"][1].after = 42600us;
  EXPECT_THAT(judged(steps).message, HasSubstr("came after 22.6 ms instead of every 20.0 ms"));
}

/// The period of a frame goes on over the steps between, and past other frames.
TEST_F(JudgeTest, ACadenceGoesOnOverOtherSteps) {
  endpoint.answers["<go>"] = Pieces{{100ms, "<tick>"}, {110ms, "<tock>"}, {300ms, "<tick>"}};
  const std::string steps =
      R"({"send": "'<go>'"}, {"expect": "'<tick>'", "every": "200ms"}, {"expect": "'<tock>'"},
         {"wait": "20ms"}, {"expect": "'<tick>'", "every": "200ms"})";
  EXPECT_EQ(judged(steps).verdict, Verdict::pass) << judged(steps).message;
  endpoint.answers["<go>"][2].after = 350ms;
  EXPECT_THAT(judged(steps).message, HasSubstr("came after 250.0 ms instead of every 200.0 ms"));
}

/// A clock of 200 ms over a link that can be 20 ms late.
TEST_F(JudgeTest, PastALimitByLessThanTheFloorIsInconclusive) {
  const std::string steps = R"({"send": "'<ask>'"}, {"expect": "'<answer>'", "within": "200ms"})";
  const auto verdict = [&](Duration after) {
    endpoint.answers["<ask>"] = Pieces{{after, "<answer>"}};
    return judged(steps).verdict;
  };
  EXPECT_EQ(verdict(200400us), Verdict::fail);
  rules.timing_floor = 20ms;
  EXPECT_EQ(verdict(200400us), Verdict::inconclusive);
  EXPECT_EQ(verdict(220ms), Verdict::inconclusive);
  EXPECT_EQ(verdict(220001us), Verdict::fail);
}

TEST_F(JudgeTest, PausesStandWhereTheNotationHasThem) {
  (void)judged(R"({"send": "'<a' ~50ms 'b' ~2c 'c>'"})");
  const std::vector<results::Event> events(transcript.events.begin(), transcript.events.end());
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[1].start - events[0].end, 50ms);
  EXPECT_EQ(events[2].start - events[1].end, 2ms);
}

}  // namespace
}  // namespace fieldproof::judging
