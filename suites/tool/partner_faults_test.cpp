// The faults of a partner in every protocol that reads words: told apart by the protocol's own
// explanation of the frame.
#include <gmock/gmock.h>

#include "harness/exchange/partner.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::tool_tests {
namespace {

struct Asked {
  const char* protocol;
  const char* model;
  const char* address;
  const char* request = nullptr;  // where the bench's own read request has no check
};

void PrintTo(const Asked& asked, std::ostream* out) { *out << asked.protocol; }

class PartnerFaults : public testing::TestWithParam<Asked> {
 protected:
  Result<exchange::Partner::Answer> answer(const std::string& fault) {
    exchange::Partner partner(protocol());
    vectors::PartnerSpec spec{
        GetParam().model, {{"station", 2}}, {{GetParam().address, "5ABC"}}, fault};
    return partner.answer(spec, request(), 1s);
  }
  Burst request() {
    if (GetParam().request) return {to_bytes(GetParam().request), Time{}, 1ms};
    return {protocol().read_requests(2, GetParam().address, 4)->front(), Time{}, 1ms};
  }
  const harness::Protocol& protocol() { return *suites::protocols().find(GetParam().protocol); }

  /// "station=03 BCC!": the station, and the fields that are wrong.
  std::string seen(ByteView frame) {
    std::string text;
    for (const harness::Field& field : protocol().explain(frame)) {
      if (field.name == "station") text += "station=" + field.text;
      if (!field.problem.empty()) text += " " + field.name + "!";
    }
    return text;
  }
};

TEST_P(PartnerFaults, TheRightAnswerIsRead) {
  const auto right = answer("");
  ASSERT_TRUE(right) << right.error().message;
  EXPECT_EQ(*protocol().read_reply(right->bytes), "5ABC");
}

TEST_P(PartnerFaults, OfTheStationLeavesTheCheckRight) {
  EXPECT_EQ(seen(answer("wrong_station")->bytes), "station=03");
}

TEST_P(PartnerFaults, OfTheCheckLeavesTheRestRight) {
  EXPECT_THAT(seen(answer("wrong_check")->bytes), testing::MatchesRegex("station=02 [A-Z]+!"));
}

TEST_P(PartnerFaults, ARefusalIsOneOfTheProtocol) {
  const Bytes refusal = answer("nak")->bytes;
  EXPECT_EQ(seen(refusal), "station=02") << to_hex(refusal);
  EXPECT_FALSE(protocol().read_reply(refusal));
}

TEST_P(PartnerFaults, LengthsDifferByOneByteOfContent) {
  const std::size_t byte = protocol().station_bytes(2).size();
  EXPECT_EQ(answer("long")->bytes.size(), answer("")->bytes.size() + byte);
  EXPECT_EQ(answer("short")->bytes.size(), answer("")->bytes.size() - byte);
}

TEST_P(PartnerFaults, WhatIsNoAnswerAtAll) {
  EXPECT_EQ(answer("echo")->bytes, request().bytes);
  EXPECT_TRUE(answer("never")->bytes.empty());
  EXPECT_EQ(answer("late")->moment, Time(1s));
  EXPECT_EQ(answer("garbage")->bytes, Bytes(answer("")->bytes.size(), '*'));
}

TEST_P(PartnerFaults, WhatTheFramesLackIsSaid) {
  const bool binary = protocol().station_bytes(2).size() == 1;
  for (const char* fault : {"not_hex", "wrong_head", "wrong_tail"})
    EXPECT_EQ(static_cast<bool>(answer(fault)), !binary) << fault;
  EXPECT_FALSE(answer("previous"));
  EXPECT_FALSE(answer("other_block"));
}

INSTANTIATE_TEST_SUITE_P(Protocols, PartnerFaults,
                         testing::Values(Asked{"xgt-cnet", "xbc-h", "%MW100",
                                               "\x05"
                                               "02rSS0106%MW100\x04"
                                               "A4"},
                                         Asked{"modbus-rtu", "xbc-h", "%MW100"},
                                         Asked{"modbus-ascii", "xbc-h", "%MW100"},
                                         Asked{"ls-bus", "inverter", "1230"}));

/// Of frames with a length and a check in their header, on a network.
TEST(NetworkPartnerFaults, LengthAndCheckFollowTheContent) {
  const harness::Protocol& fenet = *suites::protocols().find("xgt-fenet");
  const auto problems = [&](const std::string& fault) {
    exchange::Partner partner(fenet);
    const Burst request{fenet.read_requests(0, "%MW100", 4)->front(), Time{}, {}};
    const auto answer = partner.answer(
        {"xbc-h", nlohmann::json::object(), {{"%MW100", "5ABC"}}, fault}, request, 1s);
    EXPECT_TRUE(answer) << (answer ? "" : answer.error().message);
    std::string names;
    for (const harness::Field& field : fenet.explain(answer ? answer->bytes : Bytes{}))
      if (!field.problem.empty()) names += field.name + "!";
    return names;
  };
  EXPECT_EQ(problems(""), "");
  EXPECT_EQ(problems("wrong_check"), "check sum!");
  EXPECT_EQ(problems("short"), "data!");
  EXPECT_EQ(problems("long"), "surplus!");
  EXPECT_EQ(problems("nak"), "");
}

}  // namespace
}  // namespace fieldproof::tool_tests
