// Cases over the links of a network, from the exchange to the verdict, and judged again from what
// was recorded.
#include <gmock/gmock.h>

#include "harness/exchange/exchange.hpp"
#include "harness/exchange/scripted_network.hpp"
#include "harness/judge/judge.hpp"
#include "harness/judge/recording.hpp"
#include "harness/test_protocol.hpp"
#include "harness/vectors/loader.hpp"
#include "reports/results/result_json.hpp"

namespace fieldproof::judging {
namespace {

using exchange::ScriptedNetwork;
using results::Event;
using results::Verdict;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using Acts = std::vector<ScriptedNetwork::Act>;

struct NetworkProtocol : harness::TestProtocol {
  std::uint16_t default_port() const override { return 502; }
};

class LinksTest : public testing::Test {
 protected:
  LinksTest() {
    network.answers["<ask>"] = Acts{{10ms, "<answer>"}};
    network.answers["<probe>"] = Acts{{1ms, "<alive>"}};
  }

  Judgement judged(const std::string& steps, const std::string& config = "{}") {
    set_ = {};
    vectors::load_vector_text(
        R"j([{"id": "xgt_cnet/a/b", "rev": 1, "title": "what is tested", "level": "must", "basis": "printed rule",
      "statement": "m/1", "source": {"manual": "m", "section": "1", "quote": "as printed"}, "given": {"config": )j" +
            config + R"j(}, "steps": [)j" + steps + "]}]",
        "f.json", set_);
    EXPECT_THAT(set_.problems, testing::IsEmpty());
    Result<exchange::PreparedCase> prepared = exchange::prepare(set_.cases.at(0), 1, protocol_);
    EXPECT_TRUE(prepared) << prepared.error().message;
    transcript = exchange::Exchange(network, protocol_, {}).run(*prepared);
    Judgement judgement = judge(*prepared, transcript, rules, protocol_);
    expect_recording_judged_alike(*prepared, judgement);
    return judgement;
  }

  void expect_recording_judged_alike(const exchange::PreparedCase& prepared,
                                     const Judgement& live) {
    results::CaseResult recorded;
    recorded.id = "xgt_cnet/a/b";
    recorded.exchange = {transcript.events.begin(), transcript.events.end()};
    recorded.recording = make_recording(prepared, transcript, rules);
    std::string written;
    results::append_json(written, recorded);
    const auto loaded = nlohmann::json::parse(written).get<results::CaseResult>();
    const Result<exchange::Transcript> again = replay(loaded, prepared, 500ms);
    ASSERT_TRUE(again) << again.error().message;
    const Judgement offline = judge(prepared, *again, rules, protocol_);
    EXPECT_EQ(offline.verdict, live.verdict) << offline.message;
    EXPECT_EQ(offline.message, live.message);
    EXPECT_EQ(offline.notes, live.notes);
  }

  /// "sent a: <ask>", "opened a", "closed by the device a".
  std::vector<std::string> events() const {
    std::vector<std::string> texts;
    for (const Event& event : transcript.events) {
      if (event.kind == Event::Kind::note) continue;
      const bool bytes = event.kind == Event::Kind::sent || event.kind == Event::Kind::received;
      texts.push_back((event.kind == Event::Kind::sent       ? "sent"
                       : event.kind == Event::Kind::received ? "came"
                                                             : event.text) +
                      (event.link.empty() ? "" : ' ' + event.link) +
                      (bytes ? ": " + to_text(event.bytes) : ""));
    }
    return texts;
  }

  ScriptedNetwork network;
  JudgeRules rules;
  exchange::Transcript transcript;

 private:
  NetworkProtocol protocol_;
  vectors::VectorSet set_;
};

constexpr const char* ask = R"({"send": "'<ask>'"}, {"expect": "'<answer>'"})";

TEST_F(LinksTest, TheImplicitConnectionIsOpenedAndClosed) {
  EXPECT_EQ(judged(ask).verdict, Verdict::pass);
  EXPECT_THAT(events(),
              ElementsAre("opened TCP 502", "sent: <ask>", "came: <answer>", "closed (FIN)"));
  EXPECT_THAT(network.done, ElementsAre("open tcp 502", "1 <ask>", "close 1 fin"));
}

TEST_F(LinksTest, AnswersAreWaitedForOnTheirOwnConnection) {
  const std::string steps =
      R"({"open": "a"}, {"open": "b"}, {"send": "'<ask>'", "on": "a"}, {"send": "'<ask>'", "on": "b"},
         {"expect": "'<answer>'", "on": "b"}, {"expect": "'<answer>'", "on": "a"})";
  EXPECT_EQ(judged(steps).verdict, Verdict::pass);
  network.answers["<ask>"][0].instead = 1;
  const Judgement crossed = judged(
      R"({"open": "a"}, {"open": "b"}, {"send": "'<ask>'", "on": "b"}, {"expect": "'<answer>'", "on": "b"})");
  EXPECT_EQ(crossed.verdict, Verdict::fail);
  EXPECT_EQ(crossed.message, "no answer within 500 ms on b; 8 bytes came on a");
}

TEST_F(LinksTest, WhatNobodyExpectsOnAnotherConnectionFails) {
  network.answers["<ask>"].push_back({20ms, "<more>", LinkEvent::data, 1});
  const Judgement result = judged(
      R"({"open": "a"}, {"open": "b"}, {"send": "'<ask>'", "on": "b"}, {"expect": "'<answer>'", "on": "b"})");
  EXPECT_EQ(result.verdict, Verdict::fail);
  EXPECT_THAT(result.message, HasSubstr("6 bytes after the complete exchange on a"));
}

TEST_F(LinksTest, TheDevicesFinIsNamed) {
  network.answers["<ask>"] = Acts{{3ms, {}, LinkEvent::closed}};
  EXPECT_EQ(judged(ask).message,
            "no answer: the device closed the connection (FIN) after 0 bytes from it, 3.0 ms after "
            "the request");
  network.answers["<ask>"] = Acts{{3ms, "<ans"}, {4ms, {}, LinkEvent::reset}};
  EXPECT_THAT(judged(ask).message,
              HasSubstr("the device reset the connection (RST) after 4 bytes from it, 4.0 ms"));
  network.answers["<ask>"] = Acts{{3ms, "<answer>"}, {4ms, {}, LinkEvent::closed}};
  EXPECT_EQ(judged(ask).message,
            "the device closed the connection (FIN) after 8 bytes from it, which nothing in the "
            "case asks for");
}

TEST_F(LinksTest, AnEndThatIsExpectedPasses) {
  network.answers["<bad>"] = Acts{{5ms, {}, LinkEvent::reset}};
  const std::string steps = R"({"open": "a"}, {"send": "'<bad>'"}, {"expect_close": "rst"})";
  const Judgement result = judged(steps);
  EXPECT_EQ(result.verdict, Verdict::pass) << result.message;
  EXPECT_THAT(result.notes, ElementsAre("the device reset connection a (RST) after 0 bytes from "
                                        "it, 5.0 ms after what it follows"));
  EXPECT_THAT(events(),
              ElementsAre("opened TCP 502 a", "sent a: <bad>", "reset by the device (RST) a"));
  EXPECT_EQ(judged(R"({"send": "'<bad>'"}, {"expect_close": "any"})").verdict, Verdict::pass);
}

TEST_F(LinksTest, AnotherEndThanTheExpectedOneFails) {
  network.answers["<bad>"] = Acts{{5ms, {}, LinkEvent::reset}};
  EXPECT_THAT(judged(R"({"send": "'<bad>'"}, {"expect_close": "fin"})").message,
              HasSubstr("the device reset the connection (RST) after 0 bytes from it, 5.0 ms after "
                        "what it follows; FIN is due"));
  EXPECT_EQ(judged(R"({"send": "'<good>'"}, {"expect_close": "any", "within": "50ms"})").message,
            "the device did not close the connection within 50 ms");
  EXPECT_THAT(
      judged(R"({"send": "'<bad>'"}, {"expect_close": "rst", "within": "4ms"})").message,
      HasSubstr("late end of the connection: 5.0 ms after what it follows, the limit is 4 ms"));
  network.answers["<bad>"].insert(network.answers["<bad>"].begin(), {1ms, "<err>"});
  EXPECT_THAT(judged(R"({"send": "'<bad>'"}, {"expect_close": "rst"})").message,
              HasSubstr("5 bytes after the complete exchange"));
}

TEST_F(LinksTest, AnEndInASilenceIsForTheStepThatExpectsIt) {
  network.answers["<bad>"] = Acts{{5ms, {}, LinkEvent::closed}};
  EXPECT_EQ(judged(R"({"send": "'<bad>'"}, {"wait": "10ms"}, {"expect_close": "fin"})").verdict,
            Verdict::pass);
  EXPECT_THAT(judged(R"({"send": "'<bad>'"}, {"silence": true})").message,
              HasSubstr("the device closed the connection (FIN)"));
}

TEST_F(LinksTest, AfterTheBenchsFinAnswersAreHeardAndTheDevicesEndIsDue) {
  network.when_closed = Acts{{20ms, {}, LinkEvent::closed}};
  const std::string closing = R"({"send": "'<ask>'"}, {"close": "fin"}, )";
  EXPECT_EQ(judged(closing + R"({"expect": "'<answer>'"}, {"expect_close": "fin"})").verdict,
            Verdict::pass);
  EXPECT_EQ(judged(closing + R"({"expect": "'<answer>'"})").verdict, Verdict::pass)
      << "its end follows from ours";
  EXPECT_THAT(judged(closing + R"({"wait": "1ms"})").message, HasSubstr("8 bytes after"))
      << "an answer that comes late on a closed link is surplus";
}

TEST_F(LinksTest, NothingIsHeardBehindARst) {
  EXPECT_EQ(judged(R"({"open": "a"}, {"send": "'<ask>'"}, {"close": "rst"}, {"open": "b"},
                      {"send": "'<ask>'"}, {"expect": "'<answer>'"})")
                .verdict,
            Verdict::pass);
  EXPECT_THAT(network.done, ElementsAre("open tcp 502", "1 <ask>", "close 1 rst", "open tcp 502",
                                        "2 <ask>", "close 2 fin"));
}

TEST_F(LinksTest, ALateAnswerIsNotCreditedToTheNextRequest) {
  network.answers["<slow>"] = Acts{{1100ms, "<answer>"}};
  const Judgement result = judged(
      R"({"send": "'<slow>'"}, {"wait": "1s"}, {"send": "'<other>'"}, {"expect": "'<answer>'"})");
  EXPECT_EQ(result.verdict, Verdict::pass) << "nobody can tell on one connection";
  EXPECT_THAT(judged(R"({"open": "a"}, {"send": "'<slow>'"}, {"close": "fin"}, {"wait": "1s"},
                        {"open": "b"}, {"send": "'<other>'", "on": "b"},
                        {"expect": "'<answer>'", "on": "b"})")
                  .message,
              HasSubstr("no answer within 500 ms on b; 8 bytes came on a"));
}

TEST_F(LinksTest, ARefusedConnectionIsAnEnd) {
  network.refused_from = 2;
  const std::string fifth = R"({"open": "a"}, {"open": "b"}, {"expect_close": "rst", "on": "b"})";
  EXPECT_EQ(judged(fifth).verdict, Verdict::pass);
  network = {};
  network.refused_from = 1;
  const Judgement result = judged(ask);
  EXPECT_THAT(result.message,
              HasSubstr("no answer: the connection was refused, or reset (RST) before"));
}

TEST_F(LinksTest, APauseEndsASegment) {
  network.answers["k>"] = Acts{{10ms, "<answer>"}};
  EXPECT_EQ(judged(R"({"send": "'<a' ~20ms 's' ~0ms 'k>'"}, {"expect": "'<answer>'"})").verdict,
            Verdict::pass);
  EXPECT_THAT(network.done, ElementsAre("open tcp 502", "1 <a", "1 s", "1 k>", "close 1 fin"));
}

TEST_F(LinksTest, TwoFramesInOneSegmentHaveTwoAnswers) {
  network.answers["<a><b>"] = Acts{{10ms, "<1><2>"}};
  EXPECT_EQ(
      judged(R"({"send": "['<a>']['<b>']"}, {"expect": "'<1>'"}, {"expect": "'<2>'"})").verdict,
      Verdict::pass);
}

TEST_F(LinksTest, ADatagramIsAFrame) {
  network.answers["<ask>"] = Acts{{10ms, "<answer>"}, {11ms, "<answer>"}};
  const std::string open = R"({"open": {"name": "a", "transport": "udp", "port": 2005}}, )";
  const std::string answer = R"({"expect": "'<answer>'"})";
  EXPECT_EQ(judged(open + ask + ", " + answer).verdict, Verdict::pass);
  EXPECT_THAT(network.done, Contains("open udp 2005"));
  EXPECT_THAT(judged(open + ask).message, HasSubstr("8 bytes after the complete exchange"));
  network.answers["<ask>"] = Acts{{10ms, "<ans"}, {11ms, "wer>"}};
  EXPECT_THAT(judged(open + ask).message, HasSubstr("byte 4: expected w, got nothing"))
      << "two datagrams are not one frame";
  network.answers["<ask>"] = Acts{{10ms, ""}};
  EXPECT_THAT(judged(open + ask).message, HasSubstr("byte 0: expected <, got nothing"));
}

TEST_F(LinksTest, TheDevicesConnectionIsTheImplicitLinkOfAClient) {
  const auto from_device = [](Time when, LinkEvent event, const std::string& text = {},
                              LinkId number = 0) {
    return Burst{to_bytes(text), when, {}, first_own_link + number, event, 502, "192.0.2.1:4711"};
  };
  network.of_device = {
      from_device(1ms, LinkEvent::opened), from_device(2ms, LinkEvent::data, "<q>"),
      from_device(5ms, LinkEvent::closed), from_device(6ms, LinkEvent::opened, {}, 1),
      from_device(7ms, LinkEvent::data, "<r>", 1)};
  const Judgement result = judged(R"({"expect": "'<q>'"}, {"expect": "'<r>'"}, {"send": "'<s>'"})",
                                  R"({"role": "client"})");
  EXPECT_EQ(result.verdict, Verdict::pass) << result.message;
  EXPECT_THAT(network.done, ElementsAre("101 <s>", "close 2147483648 fin", "close 2147483649 fin"));
}

TEST_F(LinksTest, AConnectionOfTheDeviceIsNamed) {
  const auto from_device = [](Time when, LinkEvent event, const std::string& text = {},
                              LinkId number = 0) {
    return Burst{to_bytes(text), when, {}, first_own_link + number, event, 502, "192.0.2.1:4711"};
  };
  const std::string client = R"({"role": "client"})";
  network.of_device = {
      from_device(1ms, LinkEvent::opened), from_device(1ms, LinkEvent::data, "<q>"),
      from_device(6ms, LinkEvent::opened, {}, 1), from_device(7ms, LinkEvent::data, "<r>", 1)};
  const Judgement result = judged(
      R"({"expect_open": "a"}, {"expect_open": "b"}, {"expect": "'<r>'", "on": "b"},
         {"expect": "'<q>'", "on": "a"}, {"send": "'<s>'", "on": "a"})",
      client);
  EXPECT_EQ(result.verdict, Verdict::pass) << result.message;
  EXPECT_THAT(network.done, Contains("100 <s>"));
  EXPECT_EQ(judged(R"({"expect_open": "a", "within": "20ms"})", client).message,
            "the device did not open a connection within 20 ms");
}

TEST_F(LinksTest, WhereTheDeviceNeverCameNothingIsSaid) {
  const Judgement result =
      judged(R"({"expect": "'<q>'"}, {"send": "'<s>'"})", R"({"role": "client"})");
  EXPECT_EQ(result.verdict, Verdict::fail);
  EXPECT_THAT(result.message, HasSubstr("no request within"));
  EXPECT_THAT(network.done, Not(Contains(HasSubstr("<s>"))));
}

TEST_F(LinksTest, AConnectionOfTheDeviceDuringAWaitHasNoReason) {
  network.of_device = {{{}, 1ms, {}, first_own_link, LinkEvent::opened, 502, "192.0.2.1:4711"}};
  EXPECT_EQ(judged(R"({"wait": "201ms"}, {"expect_open": "a"})", R"({"role": "client"})").message,
            "the device opened the connection 200.0 ms before it had a reason to");
}

TEST_F(LinksTest, AnEndDuringAWaitHasNoReason) {
  network.answers["<bad>"] = Acts{{300ms, {}, LinkEvent::closed}};
  const std::string begin = R"({"open": "a"}, {"send": "'<bad>'", "on": "a"}, {"wait": "450ms"},)";
  EXPECT_THAT(judged(begin + R"({"expect_close": "fin", "within": "500ms"})").message,
              HasSubstr("it had no reason to before the end of the wait"));
  EXPECT_EQ(judged(begin + R"({"expect_close": "may"})").verdict, Verdict::pass);
  EXPECT_EQ(judged(begin + R"({"expect_close": "fin", "within": "400ms"})").verdict, Verdict::pass)
      << "by now";
  network.answers["<bad>"] = Acts{{480ms, {}, LinkEvent::closed}};
  const Judgement due = judged(begin + R"({"expect_close": "fin", "within": "600ms"})");
  EXPECT_EQ(due.verdict, Verdict::pass) << due.message;
}

TEST_F(LinksTest, AnEndThatMayComeMayStayAway) {
  const std::string may = R"({"send": "'<bad>'"}, {"silence": true}, {"expect_close": "may"})";
  EXPECT_EQ(judged(may).verdict, Verdict::pass);
  network.answers["<bad>"] = Acts{{5ms, {}, LinkEvent::reset}};
  EXPECT_EQ(judged(may).verdict, Verdict::pass);
}

TEST_F(LinksTest, AnAnswerThatIsQuickerThanTheBenchsRSTIsNobodys) {
  network.answers["<ask>"] = Acts{{0ms, "<answer>"}};
  EXPECT_EQ(judged(R"({"send": "'<ask>'"}, {"close": "rst"})").verdict, Verdict::pass);
  network.answers["<ask>"] = Acts{{0ms, "<answer>"}, {0ms, "<more>"}};
  EXPECT_THAT(judged(ask + std::string(R"(, {"close": "rst"})")).message,
              HasSubstr("6 bytes after the complete exchange"));
}

TEST_F(LinksTest, InRealTimeEachConnectionIsProbedBeforeItIsClosed) {
  network.can = {.real_device = true, .connections = true};
  EXPECT_EQ(judged(ask).verdict, Verdict::pass);
  EXPECT_THAT(network.done, ElementsAre("open tcp 502", "1 <ask>", "1 <probe>", "close 1 fin"));
  network.done.clear();
  EXPECT_EQ(judged(R"({"send": "'<half'"}, {"silence": true})").verdict, Verdict::pass)
      << "a probe would be read as the rest of the frame";
  EXPECT_THAT(network.done, ElementsAre("open tcp 502", "2 <half", "close 2 fin", "open tcp 0",
                                        "3 <probe>", "close 3 fin"));
  network.answers["<ask>"].push_back({12ms, "<late>"});
  network.answers["<probe>"][0].after = 5ms;
  EXPECT_THAT(judged(ask).message, HasSubstr("6 bytes after the complete exchange"));
}

TEST_F(LinksTest, ADeviceThatRefusesAfterTheCaseIsDead) {
  network.can = {.real_device = true, .connections = true};
  network.answers["<kill>"] = Acts{{1ms, {}, LinkEvent::reset}};
  network.refused_from = 2;
  const Judgement result = judged(R"({"send": "'<kill>'"}, {"expect_close": "rst"})");
  EXPECT_EQ(result.verdict, Verdict::fail);
  EXPECT_THAT(result.message, HasSubstr("it refuses every connection"));
}

}  // namespace
}  // namespace fieldproof::judging
