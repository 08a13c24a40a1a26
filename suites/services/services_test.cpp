#include "suites/services/services.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "src/modbus/modbus_plc.hpp"
#include "suites/services/clients.hpp"

namespace fieldproof::services {
namespace {

using nlohmann::json;
using testing::HasSubstr;

Result<std::unique_ptr<plc::EmulatedDevice>> make(const json& config) {
  return make_plc("xbc-h", config, [](plc::Plc& plc, const json& own) {
    return modbus::add_modbus_server(plc, modbus::ModbusMode::tcp, 1, own);
  });
}

TEST(Services, ShareOneMemory) {
  const auto device = make({{"station", 1}, {"services", {{"modbus-rtu", {{"station", 3}}}}}});
  ASSERT_TRUE(device) << device.error().message;
  ASSERT_TRUE((*device)->network());
  EXPECT_FALSE((*device)->line(1));
  line::Device* const line = (*device)->line(2);
  ASSERT_TRUE(line);
  ASSERT_TRUE((*device)->set("%MW1", "1234"));
  line->advance(0ns);
  line->receive(
      {.bytes = *from_hex("03 03 00 01 00 01 D4 28"), .start = 0ns, .character_time = 1ms});
  Bytes answer;
  for (Time now = 8ms; answer.empty() && now < 1s; now += 1ms) answer = line->advance(now);
  EXPECT_EQ(to_hex(ByteView(answer).first(5)), "03 03 02 12 34");
}

TEST(Services, WithoutAnyThereIsOneAlone) {
  const auto device = make({{"station", 1}});
  ASSERT_TRUE(device) << device.error().message;
  EXPECT_FALSE((*device)->line(2));
  EXPECT_FALSE(wants_services({{"station", 1}}));
}

/// FEnet EN 7.3.2: the channels of a module are 4, those of P2P and those of its server.
TEST(Services, AServerHasTheConnectionsThatChannelsLeave) {
  const auto made = [](const json& server, int channels) {
    json blocks = json::array();
    for (int channel = 1; channel <= channels; ++channel)
      blocks.push_back(
          {{"flag", "%MX0"}, {"channel", channel}, {"read", "0x40000"}, {"save", "%MW0"}});
    const json config{
        {"role", "client"}, {"p2p", {{"blocks", blocks}}}, {"services", {{"xgt-fenet", server}}}};
    return make_plc("xbc-h", config, [](plc::Plc& plc, const json& own) {
      return p2p::add_network_clients(plc, own, client_drivers("modbus-tcp"));
    });
  };
  EXPECT_TRUE(made({{"connections", 1}}, 3));
  EXPECT_TRUE(made({{"connections", 3}}, 1));
  const auto most = made({{"connections", 2}}, 3);
  ASSERT_FALSE(most);
  EXPECT_THAT(most.error().message,
              HasSubstr("connections is 2, and the P2P channels leave 1 of the module's 4"));
  const auto two = made(json::object(), 2);
  ASSERT_TRUE(two) << two.error().message;
  net::Host& module = *(*two)->network();
  for (const LinkId link : {1u, 2u, 3u})
    module.receive(
        {.bytes = {}, .start = 0ns, .link = link, .event = LinkEvent::opened, .port = 2004});
  std::vector<LinkId> reset;
  for (const Burst& one : module.advance(1s))
    if (one.event == LinkEvent::reset) reset.push_back(one.link);
  EXPECT_THAT(reset, testing::ElementsAre(3u)) << "two are left";
}

TEST(Services, WhatIsNoneIsNamed) {
  const auto message = [](const json& services) {
    const auto device = make({{"station", 1}, {"services", services}});
    return device ? std::string("made") : device.error().message;
  };
  EXPECT_THAT(message({{"modbus-rtx", json::object()}}), HasSubstr("did you mean 'modbus-rtu'"));
  EXPECT_THAT(message({{"xgt-cnet", {{"statoin", 1}}}}), HasSubstr("service 'xgt-cnet'"));
  EXPECT_THAT(message(3), HasSubstr("no object"));
}

}  // namespace
}  // namespace fieldproof::services
