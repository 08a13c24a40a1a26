#include "src/p2p/network_client.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "src/net/network.hpp"
#include "src/p2p/p2p_plc.hpp"
#include "src/p2p/test_driver.hpp"

namespace fieldproof::p2p {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

constexpr std::uint16_t port = 502, udp_port = 2005;

std::unique_ptr<P2pDriver> make_driver() { return std::make_unique<test::TestDriver>(); }

Result<std::unique_ptr<plc::Plc>> make_plc(const json& p2p, const json& more = json::object()) {
  json config{{"role", "client"}, {"p2p", p2p}};
  config.update(more);
  Result<std::unique_ptr<plc::Plc>> plc = plc::make_plc("xbc-h", config);
  if (!plc) return plc;
  const Status added = add_network_clients(**plc, config,
                                           {{"test", {.tcp = port, .udp = udp_port}, make_driver},
                                            {"other", {.tcp = 2004}, make_driver}});
  if (!added) return added.error();
  return plc;
}

/// A PLC that asks its blocks 0 and 1 on channel 1 by %MX0 and %MX1, block 2 on channel 2 by %MX2.
/// The driver's requests are "ask N", its replies "ok", or "error NN".
class Client : public testing::Test {
 protected:
  explicit Client(const json& more = json::object()) {
    json p2p = json::parse(R"({"partner": "10.0.0.9", "blocks": [
      {"flag": "%MX0", "read": "%MW0", "save": "%DW0"},
      {"flag": "%MX1", "read": "%MW0", "save": "%DW1"},
      {"flag": "%MX2", "channel": 2, "read": "%MW0", "save": "%DW2"}]})");
    p2p.update(more);
    Result<std::unique_ptr<plc::Plc>> made = make_plc(p2p);
    if (!made) throw std::runtime_error(made.error().message);
    plc = std::move(*made);
    network.attach(*plc->network());
  }

  void pulse(unsigned block) {
    const std::string flag = "%MX" + std::to_string(block);
    ASSERT_TRUE(plc->set(flag, "01"));
    ASSERT_TRUE(plc->set(flag, "00"));
  }
  /// "0:opened", "0:ask 1", "0:closed" (link by its number among those of the device) until then.
  std::string heard(Duration within = 0ms) {
    std::string all;
    for (const Time until = network.now() + within;;) {
      const Burst burst = network.receive(until);
      if (burst.bytes.empty() && burst.event == LinkEvent::data) return all;
      all += all.empty() ? "" : " ";
      all += std::to_string(burst.link - first_own_link) + ":" +
             (burst.event == LinkEvent::opened   ? "opened"
              : burst.event == LinkEvent::closed ? "closed"
              : burst.event == LinkEvent::reset  ? "reset"
                                                 : to_text(burst.bytes));
    }
  }
  void reply(unsigned link, std::string_view text) {
    ASSERT_TRUE(network.send(first_own_link + link, to_bytes(text)));
  }
  /// NDR and ERR, STATUS of a block.
  std::string result(unsigned block) {
    return *plc->get("%LW" + std::to_string(512 + 6 * block), 0) + ' ' +
           *plc->get("%LW" + std::to_string(513 + 6 * block), 0);
  }

  std::unique_ptr<plc::Plc> plc;
  net::SimulatedNetwork network;
};

TEST_F(Client, OpensAtTheFirstRequestAndKeepsTheConnection) {
  EXPECT_EQ(heard(10s), "");
  pulse(0);
  const Burst opened = network.receive(network.now());
  EXPECT_EQ(opened.event, LinkEvent::opened);
  EXPECT_EQ(opened.port, port);
  EXPECT_EQ(opened.peer, "10.0.0.9");
  EXPECT_EQ(heard(), "0:ask 0");
  reply(0, "ok");
  EXPECT_EQ(result(0), "0001 0000");
  pulse(1);
  EXPECT_EQ(heard(1s), "0:ask 1");
}

TEST_F(Client, EachChannelHasItsOwnConnection) {
  pulse(0);
  pulse(2);
  EXPECT_EQ(heard(), "0:opened 0:ask 0 1:opened 1:ask 2");
  reply(1, "ok");
  EXPECT_EQ(result(2), "0001 0000");
  EXPECT_EQ(result(0), "0000 0000");
}

TEST_F(Client, ARefusedConnectionEndsTheRequestAndTheNextOpensAgain) {
  network.take_connections(false);
  pulse(0);
  EXPECT_EQ(heard(1s), "");
  EXPECT_EQ(result(0), "0002 0007");
  network.take_connections(true);
  pulse(0);
  EXPECT_EQ(heard(), "1:opened 1:ask 0");
}

TEST_F(Client, ALostConnectionEndsTheRequest) {
  for (const Closing how : {Closing::rst, Closing::fin}) {
    pulse(0);
    (void)heard();
    const LinkId link = first_own_link + (how == Closing::rst ? 0 : 1);
    ASSERT_TRUE(network.close(link, how));
    EXPECT_EQ(result(0), "0002 0007");
    EXPECT_EQ(heard(10s), how == Closing::rst ? "" : "1:closed");
  }
  pulse(0);
  EXPECT_EQ(heard(), "2:opened 2:ask 0");
}

TEST_F(Client, AConnectionLostBetweenRequestsIsNoError) {
  pulse(0);
  (void)heard();
  reply(0, "ok");
  ASSERT_TRUE(network.close(first_own_link, Closing::rst));
  EXPECT_EQ(result(0), "0001 0000");
  pulse(0);
  EXPECT_EQ(heard(), "1:opened 1:ask 0");
}

TEST_F(Client, TimesOutAfterFiveSecondsAndClosesTheConnection) {
  pulse(0);
  (void)heard();
  EXPECT_EQ(heard(5s - 1ns), "");
  EXPECT_EQ(result(0), "0000 0000");
  EXPECT_EQ(heard(1ns), "0:closed");
  EXPECT_EQ(result(0), "0002 000A");
  reply(0, "ok");  // late: it belongs to no request, and nobody is there any more
  EXPECT_EQ(heard(1s), "0:reset");
  EXPECT_EQ(result(0), "0002 000A");
  pulse(0);
  EXPECT_EQ(heard(), "1:opened 1:ask 0");
}

/// A partner that never closes its side costs one connection, not one a time-out.
TEST_F(Client, WhatTheTimeOutLeftHalfClosedEndsBeforeTheNextConnection) {
  for (unsigned link = 0; link < 3; ++link) {
    pulse(0);
    const std::string number = std::to_string(link);
    const std::string before = link == 0 ? "" : std::to_string(link - 1) + ":reset ";
    EXPECT_EQ(heard(), before + number + ":opened " + number + ":ask 0");
    EXPECT_EQ(heard(5s), number + ":closed");
  }
  ASSERT_TRUE(network.close(first_own_link + 2, Closing::fin));
  pulse(0);
  EXPECT_EQ(heard(), "3:opened 3:ask 0") << "both sides have closed the one before";
}

TEST_F(Client, RestsInStopAndWithTheLinkOff) {
  for (const auto& [off, on] : {std::pair{"stop", "run"}, {"link off", "link on"}}) {
    ASSERT_TRUE(plc->act(off));
    pulse(0);
    EXPECT_EQ(heard(1s), "") << off;
    ASSERT_TRUE(plc->act(on));
    EXPECT_EQ(heard(1s), "") << on;
  }
  pulse(0);
  EXPECT_EQ(heard(), "0:opened 0:ask 0");
}

TEST_F(Client, APowerCycleForgetsTheConnection) {
  pulse(0);
  (void)heard();
  ASSERT_TRUE(plc->act("power_cycle"));
  EXPECT_EQ(heard(10s), "") << "it is gone without a word";
  reply(0, "ok");
  EXPECT_EQ(heard(), "0:reset");
  EXPECT_EQ(result(0), "0000 0000");
  pulse(0);
  EXPECT_EQ(heard(), "1:opened 1:ask 0");
  ASSERT_TRUE(plc->act("power_cycle"));
  ASSERT_TRUE(network.close(first_own_link + 1, Closing::fin));
  EXPECT_EQ(heard(), "1:reset") << "nobody knows that connection";
  pulse(0);
  EXPECT_EQ(heard(), "2:opened 2:ask 0");
  ASSERT_TRUE(plc->act("power_cycle"));
  pulse(0);
  EXPECT_EQ(heard(), "2:reset 3:opened 3:ask 0") << "a partner that says nothing keeps no link";
}

TEST_F(Client, ShowsTheChannelWhereAStationWouldBe) {
  EXPECT_EQ(*plc->get("%NW0", 0), "0001");
  EXPECT_EQ(*plc->get("%NW82", 0), "0002");
}

TEST(NetworkClients, HaveThreeChannels) {
  const auto error = [](const json& p2p) {
    const auto plc = make_plc(p2p);
    return plc ? "" : plc.error().message;
  };
  const json block{{"flag", "%MX0"}, {"read", "%MW0"}, {"save", "%DW0"}};
  const auto on_channels = [&block](std::initializer_list<unsigned> channels) {
    json blocks = json::array();
    for (const unsigned channel : channels) {
      blocks.push_back(block);
      blocks.back()["channel"] = channel;
    }
    return json{{"parameter", 2}, {"blocks", blocks}};
  };
  EXPECT_EQ(error(on_channels({1, 2, 3})), "");
  EXPECT_THAT(error(on_channels({4})), HasSubstr("channel is 4"));
  EXPECT_THAT(error(on_channels({0})), HasSubstr("channel is 0; use 1 to 3"));
  EXPECT_THAT(error({{"blocks", json::array()}}), HasSubstr("there are no blocks"));
}

TEST(NetworkClients, HaveWhatTheServersConnectionsLeave) {
  const auto error = [](unsigned connections, unsigned channels) {
    json blocks = json::array();
    for (unsigned channel = 1; channel <= channels; ++channel)
      blocks.push_back(
          {{"channel", channel}, {"flag", "%MX0"}, {"read", "%MW0"}, {"save", "%DW0"}});
    const auto plc = make_plc({{"blocks", blocks}}, {{"connections", connections}});
    return plc ? "" : plc.error().message;
  };
  for (unsigned connections = 1; connections <= 4; ++connections) {
    EXPECT_EQ(error(connections, 4 - connections),
              connections < 4 ? "" : "cannot read p2p: there are no blocks; give a list of them");
    EXPECT_THAT(error(connections, 5 - connections),
                HasSubstr(connections > 1 ? "together they are at most 4" : "channel is 4"));
  }
}

/// The same by datagrams.
class DatagramClient : public Client {
 protected:
  DatagramClient() : Client({{"transport", "udp"}}) {}
};

TEST_F(DatagramClient, AsksByDatagramsOfOnePort) {
  pulse(0);
  const Burst asked = network.receive(network.now());
  EXPECT_EQ(asked.event, LinkEvent::datagram);
  EXPECT_EQ(asked.port, udp_port);
  EXPECT_EQ(asked.peer, "10.0.0.9");
  EXPECT_EQ(asked.bytes, to_bytes("ask 0"));
  reply(0, "ok");
  EXPECT_EQ(result(0), "0001 0000");
  pulse(1);
  EXPECT_EQ(heard(1s), "0:ask 1");
  reply(0, "ok");
  EXPECT_EQ(result(1), "0001 0000");
  pulse(2);
  EXPECT_EQ(heard(), "1:ask 2") << "each channel has its own";
}

TEST_F(DatagramClient, TimesOutAndGoesOnWithTheSamePort) {
  pulse(0);
  EXPECT_EQ(heard(5s - 1ns), "0:ask 0");
  EXPECT_EQ(result(0), "0000 0000");
  EXPECT_EQ(heard(1ns), "") << "there is nothing to close";
  EXPECT_EQ(result(0), "0002 000A");
  pulse(0);
  EXPECT_EQ(heard(), "0:ask 0");
}

TEST_F(DatagramClient, HasAnotherPortWhenThePowerWent) {
  pulse(0);
  EXPECT_EQ(heard(), "0:ask 0");
  ASSERT_TRUE(plc->act("power_cycle"));
  reply(0, "ok");
  EXPECT_EQ(heard(1s), "");
  EXPECT_EQ(result(0), "0000 0000");
  pulse(0);
  EXPECT_EQ(heard(), "1:ask 0");
}

/// What the first doings of channels 1 and 2 are, whose blocks fire together.
std::vector<Burst> first_doings(const json& channels) {
  const auto plc =
      make_plc({{"partner", "10.0.0.9"},
                {"channels", channels},
                {"blocks",
                 {{{"flag", "%MX0"}, {"read", "%MW0"}, {"save", "%DW0"}},
                  {{"flag", "%MX0"}, {"channel", 2}, {"read", "%MW0"}, {"save", "%DW1"}}}}});
  EXPECT_TRUE(plc) << plc.error().message;
  if (!plc || !(*plc)->set("%MX0", "01")) return {};
  std::vector<Burst> doings = (*plc)->network()->advance(Time{});
  std::erase_if(doings, [](const Burst& one) { return one.event == LinkEvent::data; });
  return doings;
}

/// FEnet EN 7.1.1, table 7-3: protocol, partner, port and transport are those of a channel.
TEST(NetworkClients, EachChannelHasSettingsOfItsOwn) {
  const auto of_two = [](json settings) {
    settings["channel"] = 2;
    const std::vector<Burst> doings = first_doings(json::array({settings}));
    EXPECT_EQ(doings.size(), 2u);
    EXPECT_EQ(doings.at(0).port, port) << "that of channel 1 is as it was";
    EXPECT_EQ(doings.at(0).peer, "10.0.0.9");
    return doings.at(1);
  };
  const Burst other = of_two({{"protocol", "other"}, {"partner", "10.0.0.7"}});
  EXPECT_EQ(other.port, 2004);
  EXPECT_EQ(other.peer, "10.0.0.7");
  EXPECT_EQ(of_two({{"port", 4000}}).port, 4000);
  EXPECT_EQ(of_two({{"port", 4000}}).peer, "10.0.0.9") << "the partner of all channels";
  const Burst datagram = of_two({{"transport", "udp"}});
  EXPECT_EQ(datagram.event, LinkEvent::datagram);
  EXPECT_EQ(datagram.port, udp_port);
}

TEST(NetworkClients, ChannelsThatCannotBeAreRefused) {
  const auto error = [](const char* channels) {
    const auto plc = make_plc(
        {{"channels", json::parse(channels)},
         {"blocks", {{{"flag", "%MX0"}, {"channel", 2}, {"read", "%MW0"}, {"save", "%DW0"}}}}});
    return plc ? std::string("taken") : plc.error().message;
  };
  EXPECT_THAT(error(R"([{"channel": 2, "protocol": "othr"}])"),
              HasSubstr("channel 2 cannot speak 'othr'; use one of test, other"));
  EXPECT_THAT(error(R"([{"channel": 2, "protocol": "other", "transport": "udp"}])"),
              HasSubstr("other is fixed to TCP"));
  EXPECT_THAT(error(R"([{"channel": 2}, {"channel": 2}])"),
              HasSubstr("p2p.channels[1]: channel 2 is there twice"));
  EXPECT_THAT(error(R"([{"port": 4000}])"), HasSubstr("p2p.channels[0]: give its channel, 1 to 3"));
  EXPECT_THAT(error(R"([{"channel": 4}])"), HasSubstr("channel"));
  EXPECT_THAT(error(R"({"channel": 2})"), HasSubstr("p2p.channels: it is no list"));
  EXPECT_THAT(error(R"([{"channel": 2, "prot": 3}])"), HasSubstr("prot"));
  EXPECT_THAT(error(R"([{"channel": 2, "partner": "127.0.0.300"}])"), HasSubstr("127.0.0.300"));
}

TEST(NetworkClients, WithoutADatagramPortAreFixedToTcp) {
  const json config = json::parse(R"({"role": "client", "p2p": {"transport": "udp", "blocks": [
      {"flag": "%MX0", "read": "%MW0", "save": "%DW0"}]}})");
  const auto plc = plc::make_plc("xbc-h", config);
  const Status added = add_network_clients(**plc, config, {{"test", {.tcp = port}, make_driver}});
  ASSERT_FALSE(added);
  EXPECT_THAT(added.error().message, HasSubstr("fixed to TCP"));
}

}  // namespace
}  // namespace fieldproof::p2p
