#include "src/xgt_cnet/plc_config.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace fieldproof::xgt_cnet {

using plc::PortConfig;

namespace {

using nlohmann::json;
using ::testing::HasSubstr;

PortConfig parsed(const json& config) {
  const Result<PortConfig> plc = parse_plc_config("xbc-h", config);
  EXPECT_TRUE(plc) << (plc ? "" : plc.error().message);
  return plc ? *plc : PortConfig{};
}

std::string error_of_config(const json& config) {
  const Result<PortConfig> plc = parse_plc_config("xbc-h", config);
  return plc ? "" : plc.error().message;
}

TEST(PlcConfig, Defaults) {
  EXPECT_EQ(parsed(json::object()), PortConfig{});
  EXPECT_EQ(parse_plc_config("xec-h", json::object())->model, "xec-h");
}

TEST(PlcConfig, EveryKey) {
  const PortConfig plc = parsed(json::parse(R"({
    "station": 32, "role": "client", "mode": "stop", "line": "19200-7E2", "inter_character_ms": 2.5,
    "inter_character_floor_ms": 20, "delay_ms": 50, "rs485": true})"));
  PortConfig expected;
  expected.station = 32;
  expected.role = PortConfig::Role::client;
  expected.run = false;
  expected.line = {19200, 7, 'E', 2};
  expected.inter_character = 2500us;
  expected.inter_character_floor = 20ms;
  expected.delay = 50ms;
  expected.rs485 = true;
  EXPECT_EQ(plc, expected);
}

TEST(PlcConfig, TextOfEndpointOptions) {
  const PortConfig plc =
      parsed({{"station", "7"}, {"rs485", "1"}, {"delay_ms", "10"}, {"inter_character_ms", "1.5"}});
  EXPECT_EQ(plc.station, 7u);
  EXPECT_TRUE(plc.rs485);
  EXPECT_EQ(plc.delay, 10ms);
  EXPECT_EQ(plc.inter_character, 1500us);
  EXPECT_FALSE(parsed({{"rs485", "false"}}).rs485);
  EXPECT_FALSE(parsed({{"rs485", 0}}).rs485);
}

TEST(PlcConfig, KeysOfOthersArePassedOver) {
  EXPECT_EQ(parsed({{"neighbours", {2, 3}},
                    {"bench_line", "1200"},
                    {"protocol", "xgt-cnet"},
                    {"model", "xbc-h"}}),
            PortConfig{});
}

TEST(PlcConfig, ErrorsSayWhatIsAllowed) {
  EXPECT_EQ(error_of_config({{"stations", 1}}),
            "cannot read the PLC's configuration: there is no key 'stations'; the keys are "
            "bench_line, delay_ms, inter_character_floor_ms, "
            "inter_character_ms, line, mode, model, neighbours, protocol, role, rs485, station; "
            "did you mean 'station'?");
  EXPECT_EQ(
      error_of_config({{"station", 256}}),
      "cannot read the PLC's configuration: station is 256, which is not a number from 0 to 255");
  for (const json& wrong : {json(-1), json("x"), json(""), json("1x"), json("nan"), json(true),
                            json(nullptr), json::array()}) {
    EXPECT_THAT(error_of_config({{"station", wrong}}), HasSubstr("a number from 0 to 255"))
        << wrong;
  }
  EXPECT_THAT(error_of_config({{"station", 1.5}}), HasSubstr("a whole number"));
  EXPECT_THAT(error_of_config({{"role", "master"}}),
              HasSubstr("role is 'master', which is not client or server"));
  EXPECT_THAT(error_of_config({{"mode", 1}}), HasSubstr("mode is 1, which is not a text"));
  EXPECT_THAT(error_of_config({{"mode", "pause"}}), HasSubstr("run or stop"));
  EXPECT_THAT(error_of_config({{"line", "9601"}}), HasSubstr("cannot read line settings '9601'"));
  EXPECT_THAT(error_of_config({{"rs485", "maybe"}}), HasSubstr("true or false"));
  EXPECT_THAT(error_of_config({{"inter_character_ms", -1}}), HasSubstr("inter_character_ms is -1"));
  EXPECT_THAT(error_of_config(json::array()), HasSubstr("not a JSON object"));
}

TEST(PlcConfig, AServerHasNoP2p) {
  EXPECT_EQ(error_of_config({{"p2p", json::object()}}),
            "cannot make a PLC: a server has no p2p; remove it, or give role client");
}

}  // namespace
}  // namespace fieldproof::xgt_cnet
