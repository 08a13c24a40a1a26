#include "suites/hs_link/protocol.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace fieldproof::hs_link_suite {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST(HsLinkProtocol, EveryModelMakesADevice) {
  for (const std::string& model : protocol().models())
    EXPECT_TRUE(protocol().make_device(model, json::object())) << model;
}

TEST(HsLinkProtocol, FactsAreComparedWithTheTable) {
  const auto wrong = [](const json& facts) {
    const Status checked = protocol().check_fact(facts);
    return checked ? "right" : checked.error().message;
  };
  json fact{{"hs_link", 1}, {"flag", "mod"}, {"block", 55}, {"mk", "L00097"}, {"iec", "%LX151"}};
  EXPECT_EQ(wrong(fact), "right");
  fact["mk"] = "L00098";
  EXPECT_THAT(wrong(fact), HasSubstr("the table has L00097"));
  fact["mk"] = "L00097";
  fact["iec"] = "%LX152";
  EXPECT_THAT(wrong(fact), HasSubstr("%LX151"));
  EXPECT_EQ(wrong({{"hs_link", 1}, {"flag", "state"}, {"block", 0}, {"iec", "%LX032"}}), "right");
  EXPECT_THAT(wrong({{"hs_link", 1}, {"flag", "stat"}, {"mk", "L00000"}}), HasSubstr("setblock"));
  EXPECT_EQ(wrong({{"parameter", {{"period_ms", 20}}}, {"accepted", true}}), "right");
  EXPECT_EQ(wrong({{"parameter", {{"period_ms", 19}}}, {"accepted", false}}), "right");
  EXPECT_THAT(wrong({{"parameter", {{"period_ms", 19}}}, {"accepted", true}}), HasSubstr("20 ms"));
  EXPECT_THAT(wrong({{"parameter", {{"period_ms", 20}}}, {"accepted", false}}),
              HasSubstr("is accepted"));
}

}  // namespace
}  // namespace fieldproof::hs_link_suite
