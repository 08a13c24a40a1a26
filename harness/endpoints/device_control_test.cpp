#include "harness/endpoints/device_control.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "harness/hosting/test_tiny_device.hpp"

namespace fieldproof::endpoints {
namespace {

using hosting::test::TinyDevice;
using nlohmann::json;
using testing::HasSubstr;

class DeviceControl : public testing::Test {
 protected:
  std::string ask(std::string_view line) {
    return answer_control(
        line,
        [this](const json& config) {
          begun = config;
          if (config.contains("bad")) return Status(fail("cannot make it: bad"));
          device = std::make_unique<TinyDevice>(config);
          return ok();
        },
        [this] { return device.get(); });
  }
  json begun;
  std::unique_ptr<plc::EmulatedDevice> device;
};

TEST_F(DeviceControl, BeginSetGetAct) {
  EXPECT_EQ(ask(R"({"begin":{"station":3}})"), "{\"ok\":true}\n");
  EXPECT_EQ(begun, json({{"station", 3}}));
  EXPECT_EQ(ask(R"({"set":{"address":"%MW1","hex":"12AB"}})"), "{\"ok\":true}\n");
  EXPECT_EQ(ask(R"({"get":{"address":"%MW1","digits":2}})"), "{\"ok\":true,\"value\":\"12\"}\n");
  EXPECT_EQ(ask(R"({"get":{"address":"%MW1"}})"), "{\"ok\":true,\"value\":\"12AB\"}\n");
  EXPECT_EQ(ask(R"({"act":"power_cycle"})"), "{\"ok\":true}\n");
  EXPECT_THAT(ask(R"({"get":{"address":"%MW1","digits":4}})"), HasSubstr("nothing was set"));
}

TEST_F(DeviceControl, ErrorsAreAnswers) {
  EXPECT_THAT(ask(R"({"act":"run"})"), HasSubstr("there is no device yet"));
  EXPECT_EQ(ask(R"({"begin":{"bad":1}})"), "{\"error\":\"cannot make it: bad\"}\n");
  ASSERT_THAT(ask(R"({"begin":{}})"), HasSubstr("ok"));
  EXPECT_THAT(ask("nonsense"), HasSubstr("write one JSON object"));
  EXPECT_THAT(ask("{}"), HasSubstr("write one JSON object"));
  EXPECT_THAT(ask(R"({"jump":1})"), HasSubstr("cannot do 'jump'"));
  EXPECT_THAT(ask(R"({"set":5})"), HasSubstr("cannot do 'set'"));
  EXPECT_THAT(ask(R"({"act":"fly"})"), HasSubstr("cannot do 'fly'"));
}

TEST_F(DeviceControl, AnAnswerIsAValueOrAnError) {
  EXPECT_EQ(*read_control_answer(R"({"ok":true})"), "");
  EXPECT_EQ(*read_control_answer(R"({"ok":true,"value":"1234"})"), "1234");
  EXPECT_EQ(read_control_answer(R"({"error":"no such address"})").error().message,
            "no such address");
  EXPECT_THAT(read_control_answer("???").error().message, HasSubstr("it is no JSON object"));
}

TEST_F(DeviceControl, ALineHasNoNewlineInside) {
  EXPECT_EQ(control_line({{"act", "a\nb"}}), "{\"act\":\"a\\nb\"}\n");
}

}  // namespace
}  // namespace fieldproof::endpoints
