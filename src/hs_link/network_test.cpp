#include "src/hs_link/network.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace fieldproof::hs_link {
namespace {

using nlohmann::json;
using testing::HasSubstr;

json receive(unsigned station, unsigned block, const char* area, unsigned size = 1) {
  return {
      {"mode", "receive"}, {"station", station}, {"block", block}, {"area", area}, {"size", size}};
}
json send(unsigned block, const char* area, unsigned size = 1) {
  return {{"mode", "send"}, {"block", block}, {"area", area}, {"size", size}};
}
/// Station 1 takes a block of station 2, each 100 ms, and sends one.
json two_stations() {
  return {
      {"station", 1},
      {"hs_link", {{"period_ms", 100}, {"blocks", {receive(2, 5, "%MW200", 2), send(0, "%MW0")}}}},
      {"stations",
       {{{"station", 2},
         {"hs_link",
          {{"period_ms", 100}, {"blocks", {send(5, "%MW100", 2), receive(1, 0, "%MW9")}}}}}}}};
}

class HsNetworkTest : public testing::Test {
 protected:
  void make(const json& config) {
    auto made = make_hs_network("xbc-h", config);
    ASSERT_TRUE(made) << made.error().message;
    device_ = std::move(*made);
  }
  /// All that happens until then.
  void until(Duration time) {
    line::Device& line = *device_->line();
    for (auto next = line.wake_at(); next && *next <= Time(time); next = line.wake_at())
      EXPECT_TRUE(line.advance(*next).empty());
    line.advance(Time(time));
  }
  std::string get(const char* address, std::size_t digits = 0) {
    const Result<std::string> value = device_->get(address, digits);
    EXPECT_TRUE(value) << value.error().message;
    return value ? *value : "";
  }
  /// RLINK, LTRBL, and STATE, MOD, TRX, ERR of block 0.
  std::string flags() {
    return get("%LX00000") + get("%LX00001") + " " + get("%LX00020") + get("%LX00060") +
           get("%LX00100") + get("%LX00140");
  }
  void act(const char* action) { EXPECT_TRUE(device_->act(action)) << action; }

  std::unique_ptr<plc::EmulatedDevice> device_;
};

TEST_F(HsNetworkTest, ABlockArrivesEachPeriod) {
  make(two_stations());
  EXPECT_TRUE(device_->set("2:%MW100", "12345678"));
  EXPECT_TRUE(device_->set("%MW0", "00AA"));
  until(100ms);
  EXPECT_EQ(get("%MW200", 8), "12345678");
  EXPECT_EQ(get("2:%MW9"), "00AA");
  EXPECT_TRUE(device_->set("2:%MW100", "9ABC"));
  until(199ms);
  EXPECT_EQ(get("%MW200"), "1234") << "not before the period is over";
  until(200ms);
  EXPECT_EQ(get("%MW200"), "9ABC");
}

TEST_F(HsNetworkTest, FlagsOfAWellLinkAndOfEachFault) {
  make(two_stations());
  EXPECT_EQ(flags(), "0000 00000000") << "nothing has come yet";
  EXPECT_EQ(get("%LX00180"), "01") << "SETBLOCK";
  until(100ms);
  EXPECT_EQ(flags(), "0100 01010100");
  act("station 2 stop");
  until(200ms);
  EXPECT_EQ(flags(), "0101 00000100");
  act("station 2 run");
  act("station 2 error on");
  until(300ms);
  EXPECT_EQ(flags(), "0101 00010101");
  act("station 2 error off");
  until(400ms);
  EXPECT_EQ(flags(), "0100 01010100");
  act("station 2 off");
  until(699ms);
  EXPECT_EQ(flags(), "0100 01010100");
  until(700ms);
  EXPECT_EQ(flags(), "0101 00000000") << "three periods after the last block";
  act("link off");
  EXPECT_EQ(flags(), "0000 00000000");
  EXPECT_EQ(get("%LX00180"), "01");
}

TEST_F(HsNetworkTest, AnotherBlockNumberIsNotTaken) {
  json config = two_stations();
  config["hs_link"]["blocks"][0]["block"] = 6;
  make(config);
  EXPECT_TRUE(device_->set("2:%MW100", "12345678"));
  until(600ms);
  EXPECT_EQ(get("%MW200", 8), "00000000");
  EXPECT_EQ(flags(), "0000 00000000");
}

TEST_F(HsNetworkTest, TheSecondLinkHasItsFlagsFromL26) {
  json config = two_stations();
  config["hs_link"]["link"] = 2;
  make(config);
  until(100ms);
  EXPECT_EQ(get("%LW0"), "0000");
  EXPECT_EQ(get("%LW26"), "0001");
  EXPECT_EQ(get("%LW28"), "0003") << "both blocks";
  EXPECT_EQ(get("%LW44"), "0003");
}

TEST_F(HsNetworkTest, WhatIsWrongIsNamed) {
  const auto wrong = [](const json& config, std::string_view model = "xbc-h") {
    const auto made = make_hs_network(model, config);
    return made ? "accepted" : made.error().message;
  };
  const auto with = [](json change) {
    json config{{"hs_link", std::move(change)}};
    return config;
  };
  EXPECT_THAT(wrong({}, "xbc"), HasSubstr("no model 'xbc'"));
  EXPECT_THAT(wrong(with({{"period_ms", 19}})), HasSubstr("20 ms to 10 s"));
  EXPECT_THAT(wrong(with({{"link", 3}})), HasSubstr("link"));
  EXPECT_THAT(wrong({{"station", 64}}), HasSubstr("0 to 63"));
  EXPECT_THAT(wrong(with({{"blocks", json::array({send(0, "%MW0", 201)})}})), HasSubstr("200"));
  EXPECT_THAT(wrong(with({{"blocks", json::array({send(0, "%MB0")})}})), HasSubstr("%MW100"));
  EXPECT_THAT(wrong(with({{"blocks", json::array({send(0, "%MW1023", 2)})}})),
              HasSubstr("past the end"));
  json many = json::array();
  for (unsigned i = 0; i < 33; ++i) many.push_back(send(i, "%MW0"));
  EXPECT_THAT(wrong(with({{"blocks", many}})), HasSubstr("33 blocks to send"));
  make(two_stations());
  EXPECT_THAT(device_->act("station 3 stop").error().message, HasSubstr("no such station"));
  EXPECT_THAT(device_->act("dance").error().message, HasSubstr("can run, stop"));
  EXPECT_THAT(device_->set("3:%MW0", "00").error().message, HasSubstr("no such station"));
}

}  // namespace
}  // namespace fieldproof::hs_link
