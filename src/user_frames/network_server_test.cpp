#include "src/user_frames/network_server.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "src/net/network.hpp"
#include "src/user_frames/definition.hpp"

namespace fieldproof::user_frames {
namespace {

using testing::HasSubstr;

/// "S12\r" stores 12 in M0 and is answered "K12\r"; "N..." has no end of its own.
constexpr const char* network_talker = R"j({
  "title": "a server that stores and answers",
  "groups": {
    "OUT": {"type": "send", "tail": [{"hex": "0D"}],
            "frames": {"K": {"body": [{"text": "K"}, {"variable": 2, "memory": "%MW0"}]},
                       "E": {"body": [{"text": "event"}]}}},
    "IN": {"type": "receive", "tail": [{"hex": "0D"}],
           "frames": {"S": {"body": [{"text": "S"}, {"fixed": 2, "memory": "%MW0"}], "answer": "OUT.K"}}},
    "OPEN": {"type": "receive", "head": [{"text": "N"}], "frames": {"N": {"body": [{"variable": true, "memory": "%MB20"}]}}}
  }
})j";

Result<std::unique_ptr<plc::EmulatedDevice>> make(const nlohmann::json& config) {
  const auto definition = parse_frame_definition(network_talker, "network_talker.json");
  if (!definition) throw std::runtime_error(definition.error().message);
  return make_user_frame_server(*definition, config);
}

class UserFrames : public testing::Test {
 protected:
  UserFrames() { network.attach(*device->network()); }

  LinkId open(Transport transport = Transport::tcp) { return network.open(transport, 3000); }
  void say(LinkId link, std::string_view text) { ASSERT_TRUE(network.send(link, to_bytes(text))); }
  /// "1:K12" or "1:RST"; with a `u` in front a datagram.
  std::string heard(Duration within = 0ms) {
    std::string all;
    for (const Time until = network.now() + within;;) {
      const Burst burst = network.receive(until);
      if (burst.bytes.empty() && burst.event == LinkEvent::data) return all;
      std::string text = to_text(burst.bytes);
      if (!text.empty()) text.pop_back();
      all += (all.empty() ? "" : " ") + std::string(burst.event == LinkEvent::datagram ? "u" : "") +
             std::to_string(burst.link) + ":" + (burst.event == LinkEvent::reset ? "RST" : text);
    }
  }

  std::unique_ptr<plc::EmulatedDevice> device = std::move(*make({{"port", 3000}}));
  net::SimulatedNetwork network;
};

TEST_F(UserFrames, AnAnswerGoesToWhomTheFrameCameFrom) {
  const LinkId a = open(), b = open();
  say(a, "S1");
  say(b, "S34\r");
  EXPECT_EQ(heard(), "2:K34");
  say(a, "2\r");
  EXPECT_EQ(heard(), "1:K12") << "half a frame of one partner stands while another speaks";
  EXPECT_EQ(*device->get("%MW0", 4), "3132");
  EXPECT_EQ(*device->get("@services", 4), "0004") << "two received, two answered";
}

TEST_F(UserFrames, ASendGoesToTheLastPartner) {
  ASSERT_TRUE(device->act("send OUT.E"));
  EXPECT_EQ(heard(1s), "") << "there is none";
  const LinkId a = open(), b = open();
  ASSERT_TRUE(device->act("send OUT.E"));
  EXPECT_EQ(heard(), "2:event");
  say(a, "S12\r");
  EXPECT_EQ(heard(), "1:K12");
  ASSERT_TRUE(device->act("send OUT.E"));
  EXPECT_EQ(heard(), "1:event");
  ASSERT_TRUE(network.close(a, Closing::fin));
  EXPECT_EQ(heard(), "1:RST");
  ASSERT_TRUE(network.close(b, Closing::rst));
  EXPECT_FALSE(device->act("send IN.S"));
  EXPECT_THAT(device->act("send OUT.X").error().message, HasSubstr("there is no such frame"));
}

TEST_F(UserFrames, BytesOfNoFrameThrowNobodyOut) {
  const LinkId a = open();
  say(a, "xyz");
  EXPECT_EQ(heard(10s), "");
  say(a, "S12\r");
  EXPECT_EQ(heard(), "1:K12");
}

TEST_F(UserFrames, ASecondOfSilenceEndsAFrameThatHasNoEnd) {
  const LinkId a = open();
  say(a, "Nab");
  EXPECT_EQ(heard(900ms), "");
  say(a, "cd");
  EXPECT_EQ(*device->get("%MW10", 8), "00000000");
  EXPECT_EQ(heard(1100ms), "");
  EXPECT_EQ(*device->get("%MW10", 8), "62616463");
}

TEST_F(UserFrames, ADatagramIsAFrame) {
  const LinkId a = open(Transport::udp), b = open(Transport::udp);
  say(a, "S12\r");
  EXPECT_EQ(heard(), "u1:K12");
  say(b, "Nab");
  EXPECT_EQ(*device->get("%MW10", 4), "6261") << "ended by the datagram";
  say(a, "S3");
  say(a, "4\r");
  EXPECT_EQ(heard(5s), "") << "two halves are none";
  ASSERT_TRUE(device->act("send OUT.E"));
  EXPECT_EQ(heard(), "u1:event");
}

TEST_F(UserFrames, RestsInStopAndForgetsItsConnectionsWithThePower) {
  const LinkId a = open();
  ASSERT_TRUE(device->act("stop"));
  say(a, "S12\r");
  EXPECT_EQ(heard(5s), "");
  ASSERT_TRUE(device->act("run"));
  say(a, "S12\r");
  EXPECT_EQ(heard(), "1:K12");
  ASSERT_TRUE(device->act("power_cycle"));
  say(a, "S12\r");
  EXPECT_EQ(heard(), "1:RST");
}

TEST(UserFrameServer, HasAPortOfItsOwn) {
  EXPECT_TRUE(make({{"port", 1024}}));
  EXPECT_TRUE(make({{"port", 2007}}));
  for (const unsigned port : {502u, 1023u, 2002u, 2004u, 2006u})
    EXPECT_THAT(make({{"port", port}}).error().message, HasSubstr("1024 and up")) << port;
}

}  // namespace
}  // namespace fieldproof::user_frames
