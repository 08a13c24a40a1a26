#include "harness/exchange/client_program.hpp"

#include <gmock/gmock.h>

#include <fstream>

namespace fieldproof::exchange {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using vectors::Step;

bool same(const std::string& a, const std::string& b) { return a == b; }

Step of_kind(Step::Kind kind) {
  Step step;
  step.kind = kind;
  return step;
}
Step expect() { return of_kind(Step::Kind::expect); }
Step send() { return of_kind(Step::Kind::send); }
Step set(const std::string& address) {
  Step step = of_kind(Step::Kind::set);
  step.memory = {{address, "01"}};
  return step;
}
Step act(const std::string& action) {
  Step step = of_kind(Step::Kind::act);
  step.action = action;
  return step;
}

std::set<std::string> needs(const char* p2p, std::vector<Step> steps) {
  vectors::Case source;
  source.config = {{"role", "client"}, {"p2p", json::parse(p2p)}};
  source.steps = std::move(steps);
  return needs_of(source, true, same);
}

constexpr const char* one_block =
    R"({"blocks": [{"flag": "%MX0", "read": "%MW1", "save": "%MW2"}]})";

TEST(ClientProgram, ARequestAndItsAnswerNeedNothing) {
  EXPECT_THAT(needs(one_block, {set("%MX0"), expect(), send()}), IsEmpty());
}

TEST(ClientProgram, WhatACaseNeedsHasItsName) {
  EXPECT_THAT(needs(R"({"blocks": [{"flag": "F92"}]})", {expect(), send()}), ElementsAre("clock"));
  EXPECT_THAT(needs(R"({"link": false, "blocks": [{"flag": "%MX0"}]})", {}), ElementsAre("link"));
  EXPECT_THAT(needs(one_block, {act("link off")}), ElementsAre("link"));
  EXPECT_THAT(needs(one_block, {act("stop")}), ElementsAre("mode"));
  EXPECT_THAT(needs(one_block, {act("power_cycle")}), ElementsAre("power_cycle"));
  EXPECT_THAT(needs(one_block, {expect(), expect()}), ElementsAre("time_out"));
  EXPECT_THAT(needs(one_block, {expect(), set("%MX0"), send()}), ElementsAre("busy"));
  EXPECT_THAT(needs(R"({"channel": "2", "blocks": [{"channel": 1}, {}]})", {}),
              ElementsAre("channel"));
  EXPECT_THAT(needs(R"({"blocks": [{"function": "send", "frame": "A.B"}]})", {}),
              ElementsAre("frames"));
}

/// A flag, or what a write sends, that another block saves; what a clock sends and the case
/// changes.
TEST(ClientProgram, MemoryIsNeededWhereBlocksShareIt) {
  EXPECT_THAT(
      needs(
          R"({"blocks": [{"flag": "%MX0", "read": "%MX9", "save": "%MX1"}, {"flag": "%MX1", "read": "%MW1", "save": "%MW2"}]})",
          {}),
      ElementsAre("memory"));
  EXPECT_THAT(
      needs(
          R"({"blocks": [{"flag": "%MX0", "read": "%MW1", "save": "%MW2"}, {"flag": "%MX0", "function": "write", "read": "%MW2", "save": "%MW3"}]})",
          {}),
      ElementsAre("memory"));
  EXPECT_THAT(
      needs(R"({"blocks": [{"flag": "F92", "function": "write", "read": "%MW2", "save": "%MW3"}]})",
            {set("%MW2")}),
      ElementsAre("clock", "memory"));
}

TEST(ClientProgram, ADeclarationIsReadOrSaysWhatIsWrong) {
  const Result<Declared> good =
      read_declaration(R"({"follows": ["link", "mode"], "time_out_ms": 300})");
  ASSERT_TRUE(good);
  EXPECT_TRUE(good->answered);
  EXPECT_THAT(good->follows, ElementsAre("link", "mode"));
  EXPECT_EQ(good->time_out, 300ms);
  const Result<Declared> none = read_declaration("");
  ASSERT_TRUE(none);
  EXPECT_FALSE(none->answered);
  EXPECT_THAT(none->follows, ElementsAre("clock"));
  for (const char* bad : {"{", "{}", R"({"follows": "link"})", R"({"follows": ["lnk"]})",
                          R"({"follows": [], "time_out_ms": -1})"})
    EXPECT_THAT(read_declaration(bad).error().message, HasSubstr("any of clock, memory")) << bad;
}

TEST(ClientProgram, PaddedNamesOfThePartnerAreNotAskedOfAnybody) {
  EXPECT_THAT(needs(R"({"blocks": [{"flag": "%MX0", "read": "%DW00100", "save": "%MW2"}]})", {}),
              ElementsAre("names"));
  EXPECT_THAT(
      needs(R"({"blocks": [{"flag": "%MX00000", "read": "0x00040", "save": "%MW002"}]})", {}),
      IsEmpty());
}

TEST(ClientProgram, TheSchemaKnowsTheSameNames) {
  std::ifstream file(FIELDPROOF_SOURCE_DIR "/vectors/stimulus.schema.json");
  const json schema = json::parse(file);
  const json names =
      schema.at("definitions").at("answer").at("properties").at("follows").at("items").at("enum");
  EXPECT_TRUE(read_declaration(json{{"follows", names}}.dump()));
  const std::string known = read_declaration("{}").error().message;
  for (const json& name : names) EXPECT_THAT(known, HasSubstr(name.get<std::string>()));
  EXPECT_EQ(std::ranges::count(known.substr(known.find("any of")), ','), std::ssize(names) - 1);
}

TEST(ClientProgram, WhatIsSetUpHasEveryDefault) {
  vectors::Case source;
  source.config =
      json::parse(R"({"role": "client", "time_out": "20", "p2p": {"channel": 2, "blocks": []}})");
  source.memory = {{"%MW1", "5ABC"}};
  EXPECT_EQ(set_up_of(source, true),
            json::parse(R"({"mode": "run", "link": true, "channel": 2, "station": 0,
    "time_out_ms": 2100, "delay_ms": 0, "inter_character_ms": 0, "rs485": false, "blocks": [], "memory": {"%MW1": "5ABC"}})"));
  EXPECT_EQ(set_up_of(source, false).at("time_out_ms"), 5000);
}

TEST(ClientProgram, DatagramsAreSaidOfEachBlockAndMustBeFollowed) {
  constexpr const char* block = R"("blocks": [{"flag": "%MX0", "read": "%MW1", "save": "%MW2"}])";
  const auto parameters = [&](const char* transport) {
    return std::string("{\"transport\": \"") + transport + "\", " + block + "}";
  };
  EXPECT_THAT(needs(parameters("udp").c_str(), {}), ElementsAre("transport"));
  EXPECT_THAT(needs(parameters("tcp").c_str(), {}), IsEmpty());
  vectors::Case source;
  source.config = {{"p2p", json::parse(parameters("udp"))}};
  EXPECT_EQ(set_up_of(source, false).at("blocks").at(0).at("transport"), "udp");

  const auto own = [&](const char* channel, const char* all) {
    return std::string("{\"transport\": \"") + all + "\", \"channels\": [{\"channel\": " + channel +
           ", \"transport\": \"udp\"}], " + block + "}";
  };
  EXPECT_THAT(needs(own("1", "tcp").c_str(), {}), ElementsAre("transport"));
  EXPECT_THAT(needs(own("2", "tcp").c_str(), {}), IsEmpty()) << "the block is of channel 1";
}

TEST(ClientProgram, MailsAreForWhoFollowsThem) {
  constexpr const char* p2p =
      R"({"email": {"user": "PLC"}, "blocks": [{"function": "esend", "flag": "%MX0", "message": 1, "to": "2"}]})";
  EXPECT_THAT(needs(p2p, {}), ElementsAre("mail"));
  EXPECT_THAT(
      needs(R"({"email": {}, "blocks": [{"function": "esend", "flag": "F93", "data": "%MB0"}]})",
            {}),
      ElementsAre("clock", "mail", "memory"));
  vectors::Case source;
  source.config = {{"p2p", json::parse(p2p)}};
  const json begin = set_up_of(source, false);
  EXPECT_EQ(begin.at("mail"), json::parse(R"({"user": "PLC"})"));
  EXPECT_EQ(begin.at("blocks").at(0), json::parse(R"({"parameter": 1, "block": 0,
    "function": "esend", "flag": "%MX0", "message": 1, "to": 2})"));
}

}  // namespace
}  // namespace fieldproof::exchange
