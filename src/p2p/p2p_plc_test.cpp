#include "src/p2p/p2p_plc.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "src/p2p/test_driver.hpp"

namespace fieldproof::p2p {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

Result<std::unique_ptr<plc::Plc>> make(const json& config, std::string_view model = "xbc-h") {
  return make_p2p_plc(model, config,
                      [](const plc::PortConfig&) { return std::make_unique<test::TestDriver>(); },
                      {"colour"});
}

const json config = json::parse(R"({"role": "client", "station": 5, "p2p": {"blocks": [
  {"flag": "%MX0", "read": "%MW0", "save": "%MX1", "type": "bit", "station": 2, "read": "%MX9"},
  {"flag": "%MX1", "channel": 2, "read": "%MW0", "save": "%DW1", "station": 3}]}})");

json with(const json& changes) {
  json changed = config;
  changed.merge_patch(changes);
  return changed;
}

std::unique_ptr<plc::Plc> plc_of(const json& with_config) {
  Result<std::unique_ptr<plc::Plc>> plc = make(with_config);
  EXPECT_TRUE(plc) << (plc ? "" : plc.error().message);
  return plc ? std::move(*plc) : nullptr;
}

std::string error_of_plc(const json& with_config) {
  const Result<std::unique_ptr<plc::Plc>> plc = make(with_config);
  return plc ? "" : plc.error().message;
}

std::string sent(line::Device& device, Time now = {}) {
  const auto wake = device.wake_at();
  return wake && *wake <= now ? to_text(device.advance(now)) : "";
}

TEST(P2pPlc, TheBackDoorRaisesFlags) {
  const auto plc = plc_of(config);
  EXPECT_EQ(plc->line()->wake_at(), std::nullopt);
  ASSERT_TRUE(plc->set("%MX0", "01"));
  EXPECT_EQ(sent(*plc->line()), "ask 0");
  plc->line()->receive({to_bytes("ok"), 1ms, 0ms});
  EXPECT_EQ(*plc->get("%LX5120", 0), "01");
  EXPECT_EQ(*plc->get("@services", 0), "0001");
  EXPECT_FALSE(plc->set("%ZX0", "01"));
}

TEST(P2pPlc, ChannelsShareMemory) {
  const auto plc = plc_of(config);
  ASSERT_TRUE(plc->set("%MX0", "01"));
  EXPECT_EQ(sent(*plc->line(1)), "ask 0");
  EXPECT_EQ(sent(*plc->line(2)), "");
  plc->line(1)->receive({to_bytes("ok"), 1ms, 0ms});  // saves %MX1, the flag of channel 2
  EXPECT_EQ(sent(*plc->line(2), 1ms), "ask 1");
  EXPECT_EQ(*plc->get("@services", 0), "0001");  // of the channel on the line
}

TEST(P2pPlc, TheLineLeadsToTheChannelOfTheParameter) {
  const auto plc = plc_of(with({{"p2p", {{"channel", 2}}}}));
  ASSERT_TRUE(plc->set("%MX1", "01"));
  EXPECT_EQ(sent(*plc->line()), "ask 1");
}

TEST(P2pPlc, RunAndLinkAreRequired) {
  for (const auto& [off, on] : {std::pair{"stop", "run"}, {"link off", "link on"}}) {
    const auto plc = plc_of(config);
    ASSERT_TRUE(plc->act(off));
    ASSERT_TRUE(plc->set("%MX0", "01"));
    EXPECT_EQ(sent(*plc->line()), "") << off;
    ASSERT_TRUE(plc->act(on));
    EXPECT_EQ(sent(*plc->line()), "") << on;
    ASSERT_TRUE(plc->set("%MX0", "00"));
    ASSERT_TRUE(plc->set("%MX0", "01"));
    EXPECT_EQ(sent(*plc->line()), "ask 0") << on;
  }
  for (const json& off : {json{{"mode", "stop"}}, json{{"p2p", {{"link", false}}}}}) {
    const auto plc = plc_of(with(off));
    ASSERT_TRUE(plc->set("%MX0", "01"));
    EXPECT_EQ(sent(*plc->line()), "") << off;
  }
  const auto plc = plc_of(config);
  ASSERT_TRUE(plc->act("stop"));
  ASSERT_TRUE(plc->act("link on"));  // one alone does not do
  ASSERT_TRUE(plc->set("%MX0", "01"));
  EXPECT_EQ(sent(*plc->line()), "");
}

TEST(P2pPlc, PowerCycleKeepsMemoryModeAndLink) {
  const auto plc = plc_of(config);
  ASSERT_TRUE(plc->set("%MX0", "01"));
  EXPECT_EQ(sent(*plc->line()), "ask 0");
  plc->line()->receive({to_bytes("error 0F"), 1ms, 0ms});
  ASSERT_TRUE(plc->act("link off"));
  ASSERT_TRUE(plc->act("power_cycle"));
  EXPECT_EQ(*plc->get("@errors", 0), "0000");
  EXPECT_EQ(*plc->get("%LW513", 0), "000F");
  ASSERT_TRUE(plc->set("%MX0", "00"));
  ASSERT_TRUE(plc->set("%MX0", "01"));
  EXPECT_EQ(sent(*plc->line(), 1s), "");
}

TEST(P2pPlc, UnknownActions) {
  EXPECT_EQ(plc_of(config)->act("lnk off").error().message,
            "cannot do 'lnk off': there is no such action; use one of run, stop, power_cycle, link "
            "on, link off; did you mean "
            "'link off'?");
}

TEST(P2pPlc, TimesOutByItsParameter) {
  const auto plc = plc_of(with({{"time_out", 3}, {"line", "9600-8N1"}}));
  ASSERT_TRUE(plc->set("%MX0", "01"));
  EXPECT_EQ(sent(*plc->line()), "ask 0");
  EXPECT_EQ(plc->line()->wake_at(), 5 * line::LineSettings{}.character_time() + 400ms);
}

TEST(P2pPlc, DelayHoldsWithRs485) {
  const auto next = [](bool rs485) {
    const auto plc = plc_of(with({{"rs485", rs485}, {"delay_ms", 50}}));
    EXPECT_TRUE(plc->set("%MX0", "01"));
    sent(*plc->line(), 1s);
    plc->line()->receive({to_bytes("ok"), 1100ms, 0ms});
    EXPECT_TRUE(plc->set("%MX0", "00"));
    EXPECT_TRUE(plc->set("%MX0", "01"));
    return plc->line()->wake_at();
  };
  EXPECT_EQ(next(true), 1150ms);
  EXPECT_EQ(next(false), 1100ms);
}

TEST(P2pPlc, ShowsItsParametersInN) {
  const auto plc = plc_of(config);
  EXPECT_EQ(*plc->get("%NW0", 0), "0002");
  EXPECT_EQ(*plc->get("%NW41", 0), "0003");
}

TEST(P2pPlc, ErrorsNameTheKey) {
  EXPECT_THAT(error_of_plc(with({{"timeout", 1}})),
              HasSubstr("the P2P client's configuration: there is no key 'timeout'"));
  EXPECT_EQ(error_of_plc(with({{"colour", 1}})), "");  // a key of the protocol's own
  EXPECT_THAT(error_of_plc(with({{"time_out", 51}})),
              HasSubstr("time_out is 51, which is not a number from 0 to 50"));
  EXPECT_THAT(error_of_plc(with({{"delay_ms", 15}})), HasSubstr("steps of 10 ms"));
  EXPECT_EQ(error_of_plc({{"role", "client"}}),
            "cannot make a P2P client: there is no p2p; give its blocks, or role server");
  EXPECT_THAT(make(config, "xbc_h").error().message, HasSubstr("did you mean 'xbc-h'"));
  json blocks = config;
  blocks["p2p"]["blocks"][1]["station"] = 99;
  EXPECT_EQ(error_of_plc(blocks),
            "cannot set up P2P block 1: station is 99, which this driver has not");
}

TEST(P2pPlc, IsAskedForByItsRole) {
  EXPECT_TRUE(is_p2p_client(config));
  EXPECT_FALSE(is_p2p_client({{"role", "server"}}));
  EXPECT_FALSE(is_p2p_client(json::object()));
}

}  // namespace
}  // namespace fieldproof::p2p
