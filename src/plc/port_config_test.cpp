#include "src/plc/port_config.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace fieldproof::plc {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

TEST(EffectiveGap, DefaultFloorAndParameter) {
  const line::LineSettings line;                                  // 9600 bit/s
  EXPECT_EQ(effective_gap(0ms, 0ms, line), Duration(4'010'416));  // 38.5 bits
  EXPECT_EQ(effective_gap(0ms, 0ms, {.baud = 115200}), Duration(334'201));
  EXPECT_EQ(effective_gap(0ms, 0ms, {.baud = 9600, .data_bits = 7, .parity = 'E'}),
            Duration(4'010'416));  // always 11 bits
  EXPECT_EQ(effective_gap(1ms, 0ms, line), 1ms);
  EXPECT_EQ(effective_gap(1ms, 20ms, line), 20ms);
  EXPECT_EQ(effective_gap(50ms, 20ms, line), 50ms);
  EXPECT_EQ(effective_gap(0ms, 20ms, {.baud = 1200}), Duration(32'083'333));
}

TEST(PortConfig, GapAndDelayThatHold) {
  const PortConfig port{.inter_character = 5ms, .inter_character_floor = 20ms, .delay = 50ms};
  EXPECT_EQ(port.gap(), 20ms);
  EXPECT_EQ(port.reply_delay(), 0ms);
  EXPECT_EQ((PortConfig{.delay = 50ms, .rs485 = true}).reply_delay(), 50ms);
}

TEST(PortConfig, EveryKey) {
  const json config = json::parse(
      R"({"station": "255", "role": "client", "mode": "stop", "line": "19200-7E2", "delay_ms": 50,
                                      "inter_character_ms": 2.5, "inter_character_floor_ms": 20, "rs485": true})");
  PortConfig port;
  ConfigReader reader(config, "it");
  read_port_config(reader, port);
  ASSERT_FALSE(reader.error());
  EXPECT_EQ(port, (PortConfig{"xbc-h",
                              255,
                              PortConfig::Role::client,
                              false,
                              {19200, 7, 'E', 2},
                              2500us,
                              20ms,
                              50ms,
                              true}));
}

TEST(PortConfig, TheFirstErrorStays) {
  const json config{{"station", 256}, {"role", "master"}, {"line", "x"}, {"rs485", true}};
  PortConfig port;
  ConfigReader reader(config, "it");
  read_port_config(reader, port);
  ASSERT_TRUE(reader.error());
  EXPECT_EQ(reader.error()->message,
            "cannot read it: station is 256, which is not a number from 0 to 255");
  EXPECT_EQ(port, PortConfig{});
}

TEST(PortConfig, KeysAreSortedForTheMessage) {
  EXPECT_EQ(
      known_keys({{"colour", 1}}, "it", port_keys({"answer", "zoo"})).error().message,
      "cannot read it: there is no key 'colour'; the keys are answer, bench_line, delay_ms, "
      "inter_character_floor_ms, "
      "inter_character_ms, line, mode, model, neighbours, protocol, role, rs485, station, zoo");
}

TEST(CheckPortConfig, LimitsAndOnePast) {
  const auto error = [](const PortConfig& config) {
    const Result<const PlcModel*> model = check_port_config(config);
    return model ? std::string((*model)->name) : model.error().message;
  };
  EXPECT_EQ(error({.model = "xec-h", .station = 255, .delay = 2550ms}), "xec-h");
  EXPECT_THAT(error({.model = "xech"}), HasSubstr("did you mean 'xec-h'"));
  EXPECT_THAT(error({.station = 256}), HasSubstr("station is not 0 to 255"));
  EXPECT_THAT(error({.delay = 2560ms}), HasSubstr("0 to 2550 ms"));
  EXPECT_THAT(error({.delay = 15ms}), HasSubstr("steps of 10 ms"));
  EXPECT_THAT(error({.inter_character = -1ns}), HasSubstr("inter-character time"));
  EXPECT_THAT(error({.inter_character_floor = -1ns}), HasSubstr("inter-character time"));
}

}  // namespace
}  // namespace fieldproof::plc
