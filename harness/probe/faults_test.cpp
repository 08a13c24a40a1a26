// Each thing that can be wrong with a line, and its name.
#include <gmock/gmock.h>

#include "harness/probe/test_wires.hpp"

namespace fieldproof::probe::test {
namespace {

using Kind = Finding::Kind;
using testing::ElementsAre;
using testing::HasSubstr;

Hidden hidden(endpoints::Decorator decorate) { return {.decorate = std::move(decorate)}; }

TEST(LineFault, NothingOnTheLine) {
  const auto findings = find(opener(hidden(switched_off)), small_space());
  ASSERT_THAT(kinds(findings), ElementsAre(Kind::silence));
  EXPECT_THAT(findings[0].text, HasSubstr("not a byte"));
  EXPECT_THAT(findings[0].advice, HasSubstr("later than 500 ms"));
}

TEST(LineFault, EchoWithoutADevice) {
  const auto findings = find(behind<Echo>(opener(hidden(switched_off))), small_space());
  ASSERT_THAT(kinds(findings), ElementsAre(Kind::echo));
  EXPECT_THAT(findings[0].advice, HasSubstr("11.2.4"));
}

TEST(LineFault, EchoBeforeTheReply) {
  EXPECT_THAT(kinds(find(behind<Echo>(opener({})), small_space())),
              ElementsAre(Kind::device, Kind::echo));
  EXPECT_THAT(kinds(find(opener(hidden(with_faults({.echo = true}))), small_space())),
              ElementsAre(Kind::device, Kind::echo));
}

TEST(LineFault, SwappedPair) {
  const auto findings = find(behind<Swapped>(opener({})), small_space());
  ASSERT_THAT(kinds(findings), ElementsAre(Kind::wiring)) << findings[0].text;
  EXPECT_THAT(findings[0].advice, HasSubstr("swap A and B"));
}

TEST(LineFault, LineAtBreak) {
  struct Break final : Wire {
    Break(std::unique_ptr<endpoints::Endpoint> inner, const line::LineSettings&)
        : Wire(std::move(inner)) {}
    std::string line_errors() override { return std::exchange(broken_, false) ? "1 break" : ""; }
    bool broken_ = true;
  };
  const auto findings = find(behind<Break>(opener(hidden(switched_off))), small_space());
  ASSERT_THAT(kinds(findings), ElementsAre(Kind::wiring));
  EXPECT_THAT(findings[0].text, HasSubstr("stands at break"));
}

TEST(LineFault, FloatingLine) {
  const auto nobody = find(behind<Floating>(opener(hidden(switched_off))), small_space());
  ASSERT_THAT(kinds(nobody), ElementsAre(Kind::wiring));
  EXPECT_THAT(nobody[0].text, HasSubstr("mostly 00 and FF"));
  EXPECT_THAT(kinds(find(behind<Floating>(opener({})), small_space())),
              ElementsAre(Kind::device, Kind::stray_bytes));
}

TEST(LineFault, TwoDevicesOneAfterTheOther) {
  Hidden two = hidden(with_faults({.late = 60ms}));
  two.config["neighbours"] = {1};
  EXPECT_THAT(kinds(find(opener(two), small_space())),
              ElementsAre(Kind::device, Kind::two_devices));
}

TEST(LineFault, TwoDevicesAtOnce) {
  Hidden two =
      hidden(with_faults({.late = 7'300us}));  // seven characters: one talks into the other
  two.config["neighbours"] = {1};
  const auto findings = find(opener(two), small_space());
  ASSERT_THAT(kinds(findings), ElementsAre(Kind::two_devices)) << findings[0].text;
  EXPECT_THAT(findings[0].advice, HasSubstr("two devices with one station number"));
}

TEST(LineFault, AnotherStationAnswers) {
  Bytes reply = to_bytes(
      "\x06"
      "03rSS01020000\x03");
  unsigned sum = 0;
  for (const Byte b : reply) sum += b;
  for (const char c : hex_number(sum & 0xFF, 2)) reply.push_back(static_cast<Byte>(c));
  const auto findings = find(opener(hidden(answers(reply))), small_space());
  ASSERT_THAT(kinds(findings), ElementsAre(Kind::device, Kind::other_station)) << findings[0].text;
  EXPECT_EQ(findings[0].trial.station, 3);
  EXPECT_THAT(findings[1].text, HasSubstr("station 3 answers where station 1 was asked"));
}

TEST(LineFault, AnotherMasterTalks) {
  Hidden other =
      hidden([](line::Device&, const line::LineSettings&) { return std::make_unique<Master>(); });
  other.config["line"] = "19200-8E1";
  const Search search = run_search(opener(other), {});
  const auto findings = conclude(search, {});
  ASSERT_THAT(kinds(findings), ElementsAre(Kind::other_talker)) << findings[0].text;
  EXPECT_THAT(findings[0].text, HasSubstr("modbus-rtu frame of station 9"));
  EXPECT_EQ(line::to_string(findings[0].trial.line), "19200-8E1");
  for (const Observation& one : search.observations)
    EXPECT_EQ(one.trial.protocol, nullptr) << "asked into the talk of others";
}

LineOpener any_format_in(const char* out) {
  const LineOpener open = [](const line::LineSettings& line) {
    return opener({.config = {{"station", 1}, {"line", line::to_string(line)}}})(line);
  };
  return behind<OwnFormat>(open, out);
}

TEST(LineFault, WrongParityOfALinkThatCannotBeSet) {
  for (const char* device : {"9600-7E1", "9600-7O1", "9600-8E1", "9600-8O1"}) {
    const auto findings = find(any_format_in(device), small_space());
    ASSERT_THAT(kinds(findings), ElementsAre(Kind::format)) << device << ": " << findings[0].text;
    EXPECT_THAT(findings[0].text, HasSubstr(std::string(device) + " is right"));
  }
}

TEST(Search, TheFormatThatAReplyShowsIsTriedNext) {
  const Search search = run_search(any_format_in("9600-7O1"));
  EXPECT_EQ(search.trials, 1u + 1u + 3u);  // listening, 8N1, 7O1 three times
  const auto findings = conclude(search, {});
  ASSERT_THAT(kinds(findings), ElementsAre(Kind::device)) << findings[0].text;
  EXPECT_EQ(line::to_string(findings[0].trial.line), "9600-7O1");
}

TEST(LineFault, UnstableReplies) {
  const Trial trial{line::LineSettings{}, &protocol_named("xgt-cnet"), 1};
  Search search;
  search.trials = 4;
  for (const Symptom symptom : {Symptom::reply, Symptom::damaged, Symptom::reply}) {
    Observation one{trial, {}, {.symptom = symptom}};
    search.observations.push_back(one);
  }
  const auto findings = conclude(search, {});
  ASSERT_THAT(kinds(findings), ElementsAre(Kind::device, Kind::unstable));
  EXPECT_THAT(findings[1].text, HasSubstr("2 of 3"));
}

}  // namespace
}  // namespace fieldproof::probe::test
