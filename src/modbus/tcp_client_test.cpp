// The Modbus TCP client of a PLC on a stream: frames lie across segments and requests.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "src/modbus/p2p_driver.hpp"
#include "src/net/network.hpp"
#include "src/p2p/p2p_plc.hpp"

namespace fieldproof::modbus {
namespace {

using nlohmann::json;

/// Reads holding register 0 of unit 1 into %DW0 whenever %MX0 rises.
class TcpClient : public testing::Test {
 protected:
  TcpClient() {
    const json config = json::parse(R"({"role": "client", "p2p": {"blocks": [
      {"flag": "%MX0", "read": "0x40000", "save": "%DW0", "station": 1}]}})");
    plc = std::move(*plc::make_plc("xbc-h", config));
    const Status added = p2p::add_network_clients(
        *plc, config,
        {{"modbus-tcp", {.tcp = 502}, [] { return make_modbus_p2p_driver(ModbusMode::tcp); }}});
    if (!added) throw std::runtime_error(added.error().message);
    network.attach(*plc->network());
  }

  /// The connection that the request came on, and that it is request `number`.
  LinkId asked(Byte number) {
    EXPECT_TRUE(plc->set("%MX0", "01") && plc->set("%MX0", "00"));
    for (;;) {
      const Burst burst = network.receive(network.now());
      if (burst.event == LinkEvent::data) {
        EXPECT_EQ(burst.bytes, (Bytes{0, number, 0, 0, 0, 6, 1, 3, 0, 0, 0, 1}));
        return burst.link;
      }
    }
  }
  static Bytes answer(Byte number, Byte value) {
    return {0, number, 0, 0, 0, 5, 1, 3, 2, 0x12, value};
  }
  std::string value() { return *plc->get("%DW0", 4); }
  /// NDR and ERR, STATUS.
  std::string result() { return *plc->get("%LW512", 4) + ' ' + *plc->get("%LW513", 4); }

  std::unique_ptr<plc::Plc> plc;
  net::SimulatedNetwork network;
};

/// A server that answers twice, the second time in two segments with the next request between.
TEST_F(TcpClient, ASurplusAnswerAcrossTheNextRequestIsPassedOver) {
  const LinkId link = asked(1);
  const Bytes again = answer(1, 0x11);
  Bytes first = again;
  first.insert(first.end(), again.begin(), again.begin() + 5);
  ASSERT_TRUE(network.send(link, first));
  EXPECT_EQ(value(), "1211");
  EXPECT_EQ(asked(2), link);
  ASSERT_TRUE(network.send(link, Bytes(again.begin() + 5, again.end())));
  EXPECT_EQ(value(), "1211") << "it belongs to the first request";
  ASSERT_TRUE(network.send(link, answer(2, 0x22)));
  EXPECT_EQ(value(), "1222");
  EXPECT_EQ(result(), "0001 0000");
}

/// A length that no frame has: where the next one begins nobody knows.
TEST_F(TcpClient, AStreamThatCannotBeFollowedEndsTheConnection) {
  const LinkId link = asked(1);
  Bytes wrong = answer(1, 0x11);
  wrong[4] = 0xFF;
  ASSERT_TRUE(network.send(link, wrong));
  EXPECT_EQ(result().substr(0, 4), "0002");
  const Burst closed = network.receive(network.now());
  EXPECT_EQ(closed.event, LinkEvent::closed);
  EXPECT_EQ(closed.link, link);
  const LinkId next = asked(2);
  EXPECT_NE(next, link);
  ASSERT_TRUE(network.send(next, answer(2, 0x22)));
  EXPECT_EQ(value(), "1222");
  EXPECT_EQ(result(), "0001 0000");
}

/// The same between two requests.
TEST_F(TcpClient, SoDoesOneThatIsUnfollowableWhileNothingIsAsked) {
  const LinkId link = asked(1);
  ASSERT_TRUE(network.send(link, answer(1, 0x11)));
  ASSERT_TRUE(network.send(link, Bytes{0, 9, 0, 0, 0xFF, 0xFF, 1, 3}));
  EXPECT_EQ(network.receive(network.now()).event, LinkEvent::closed);
  EXPECT_EQ(result(), "0001 0000") << "the answer was good";
  EXPECT_NE(asked(2), link);
}

}  // namespace
}  // namespace fieldproof::modbus
