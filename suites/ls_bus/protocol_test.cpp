#include "suites/ls_bus/protocol.hpp"

#include <gmock/gmock.h>

#include <array>
#include <nlohmann/json.hpp>

#include "suites/ls_bus/memory_requests.hpp"

namespace fieldproof::ls_bus_suite {
namespace {

using nlohmann::json;
using testing::HasSubstr;

Bytes answer_of(plc::EmulatedDevice& device, const Bytes& request) {
  device.line()->receive({request, 0ms, {}});
  return device.line()->wake_at() ? device.line()->advance(*device.line()->wake_at()) : Bytes{};
}

TEST(LsBusProtocol, MakesAnInverter) {
  EXPECT_EQ(protocol().models(), std::vector<std::string>{"inverter"});
  const auto device = protocol().make_device("inverter", {{"station", 10}});
  ASSERT_TRUE(device) << device.error().message;
  ASSERT_TRUE((*device)->set("1230", "1234"));
  EXPECT_EQ(
      *protocol().read_reply(answer_of(**device, protocol().read_requests(10, "1230", 4)->front())),
      "1234");
  EXPECT_THAT(protocol().make_device("s100", json::object()).error().message, HasSubstr("'s100'"));
  EXPECT_THAT(protocol().make_device("inverter", {{"station", 256}}).error().message,
              HasSubstr("station"));
  EXPECT_EQ(protocol().station_bytes(10), to_bytes("0A"));
}

TEST(LsBusProtocol, TheProbeIsAnsweredByAHealthyInverter) {
  const auto device = protocol().make_device("inverter", {{"station", 1}});
  ASSERT_TRUE(device);
  for (const Bytes& tested :
       {Bytes{}, request("01R12301"), request("01R12308"), request("01W1230100FF")}) {
    const Bytes probe = protocol().probe(1, tested);
    EXPECT_TRUE(protocol().is_reply_to_probe(probe, answer_of(**device, probe))) << to_hex(tested);
  }
}

TEST(LsBusProtocol, NoReplyToTheTestedRequestLooksLikeTheProbes) {
  const auto device = protocol().make_device("inverter", {{"station", 1}});
  ASSERT_TRUE(device);
  std::vector<Bytes> requests{request("01W1230100FF"), request("01X12301"), request("01R13001"),
                              request("01R12309")};
  for (unsigned count = 1; count <= 8; ++count)
    requests.push_back(request("01R1230" + std::to_string(count)));
  Bytes begun_anew = to_bytes(
      "\x05"
      "01R12308");
  const Bytes one = request("01R12301");
  begun_anew.insert(begun_anew.end(), one.begin(), one.end());
  requests.push_back(begun_anew);
  for (const Bytes& tested : requests) {
    const Bytes reply = answer_of(**device, tested);
    ASSERT_FALSE(reply.empty()) << to_hex(tested);
    EXPECT_FALSE(protocol().is_reply_to_probe(protocol().probe(1, tested), reply))
        << to_hex(tested);
  }
}

TEST(LsBusProtocol, ARefusalIsNoReplyToTheProbe) {
  const Bytes probe = protocol().probe(1, {});
  Bytes reply = request("01R1234");
  reply[0] = 0x06;
  EXPECT_TRUE(protocol().is_reply_to_probe(probe, reply));
  reply[0] = 0x15;
  EXPECT_FALSE(protocol().is_reply_to_probe(probe, reply));
}

TEST(LsBusProtocol, AParameterIsWrittenOnlyWhenNamed) {
  EXPECT_THAT(protocol().output_areas(), testing::ElementsAre("H"));
}

TEST(LsBusFacts, AreCheckedAgainstTheTables) {
  const auto error_of = [](const char* facts) {
    const Status status = protocol().check_fact(json::parse(facts));
    return status ? "" : status.error().message;
  };
  EXPECT_EQ(error_of(R"({"model": "inverter", "first": "0009", "last": "000F", "write": false})"),
            "");
  EXPECT_EQ(error_of(R"({"model": "inverter", "first": "1000", "last": "11FF", "exists": false})"),
            "");
  EXPECT_EQ(error_of(R"({"model": "inverter", "max_words": 8})"), "");
  EXPECT_EQ(error_of(R"({"model": "inverter", "max_frame": 44})"), "");
  EXPECT_EQ(error_of(R"({"model": "inverter", "error": "WM"})"), "");
  EXPECT_THAT(error_of(R"({"model": "inverter", "first": "0008", "last": "000F", "write": false})"),
              HasSubstr("0008: the table has it writable"));
  EXPECT_THAT(error_of(R"({"model": "inverter", "first": "0FFF", "last": "1000", "write": true})"),
              HasSubstr("1000: the table says"));
  EXPECT_THAT(
      error_of(R"({"model": "inverter", "first": "12FF", "last": "1300", "exists": false})"),
      HasSubstr("12FF"));
  EXPECT_THAT(error_of(R"({"model": "inverter", "first": "0FFF", "write": true})"),
              HasSubstr("first and last"));
  EXPECT_THAT(error_of(R"({"model": "inverter", "first": "0003", "last": "0000", "write": false})"),
              HasSubstr("first and last"));
  EXPECT_THAT(error_of(R"({"model": "inverter", "max_words": 9})"), HasSubstr("the table has 8"));
  EXPECT_THAT(error_of(R"({"model": "inverter", "max_frame": 256})"),
              HasSubstr("the table has 44"));
  EXPECT_THAT(error_of(R"({"model": "inverter", "error": "12"})"), HasSubstr("'12'"));
  EXPECT_THAT(error_of(R"({"model": "inverter", "max_word": 8})"),
              HasSubstr("did you mean 'max_words'"));
  EXPECT_THAT(error_of(R"({"model": "xbc-h", "max_words": 8})"), HasSubstr("model inverter"));
  EXPECT_THAT(error_of(R"({"model": "inverter"})"), HasSubstr("besides its model"));
}

TEST(Monitor, KnowsRequestsAndReplies) {
  const Bytes request = protocol().probe(1, {});
  EXPECT_EQ(protocol().monitor_result(request, true, true), (plc::FrameResult{7, "LS Bus"}));
  EXPECT_EQ(protocol().monitor_result(request, false, false), (plc::FrameResult{7, "LS Bus"}));
  EXPECT_EQ(protocol().monitor_result(request, true, false), plc::unknown_frame) << "its own echo";
  EXPECT_EQ(protocol().monitor_result(to_bytes("01R"), false, false), plc::unknown_frame);
}

TEST(LsBusProtocol, ParametersAreNamedByTheirHexAddress) {
  for (const char* text : {"h1230", "1230", "H1230"}) {
    const auto name = protocol().read_word(text);
    ASSERT_TRUE(name) << text;
    EXPECT_EQ(name->word, 0x1230u);
  }
  EXPECT_FALSE(protocol().read_word("h")->word);
  for (const char* text :
       {"", "M100", "h12", "h12345", "12G0", "\r\r21", "h1 30"})  // found by fuzz.sh
    EXPECT_FALSE(protocol().read_word(text)) << text;
}

}  // namespace
}  // namespace fieldproof::ls_bus_suite
