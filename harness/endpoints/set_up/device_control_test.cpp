#include "harness/endpoints/set_up/device_control.hpp"

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
    return answer_control(line, {[this](const json& config) {
                                   begun = config;
                                   if (config.contains("bad"))
                                     return Status(fail("cannot make it: bad"));
                                   device = std::make_unique<TinyDevice>(config);
                                   return ok();
                                 },
                                 [this](const json& change) {
                                   changed = change;
                                   return ok();
                                 },
                                 [this] { return device.get(); }});
  }
  json begun, changed;
  std::unique_ptr<plc::EmulatedDevice> device;
};

TEST_F(DeviceControl, BeginSetGetAct) {
  EXPECT_EQ(ask(R"({"begin":{"station":3}})"), "{\"ok\":true}\n");
  EXPECT_EQ(begun, json({{"station", 3}}));
  EXPECT_EQ(ask(R"({"set":{"%MW1":"12AB"}})"), "{\"ok\":true}\n");
  EXPECT_EQ(ask(R"({"get":{"%MW1":2}})"), "{\"values\":{\"%MW1\":\"12\"}}\n");
  EXPECT_EQ(ask(R"({"get":["%MW1"]})"), "{\"values\":{\"%MW1\":\"12AB\"}}\n");
  EXPECT_EQ(ask(R"({"do":"power_cycle"})"), "{\"ok\":true}\n");
  EXPECT_THAT(ask(R"({"get":{"%MW1":4}})"), HasSubstr("nothing was set"));
}

TEST_F(DeviceControl, SeveralAtOnceAndAChangeOfTheConfiguration) {
  EXPECT_EQ(ask(R"({"config":{"delay_ms":5}})"), "{\"ok\":true}\n");
  EXPECT_EQ(changed, json({{"delay_ms", 5}}));
  ASSERT_THAT(ask(R"({"begin":{}})"), HasSubstr("ok"));
  EXPECT_EQ(ask(R"({"set":{"%MW1":"12AB","%MW2":"0001"}})"), "{\"ok\":true}\n");
  EXPECT_EQ(ask(R"({"get":["%MW1","%MW2"]})"),
            "{\"values\":{\"%MW1\":\"12AB\",\"%MW2\":\"0001\"}}\n");
}

TEST_F(DeviceControl, ErrorsAreAnswers) {
  EXPECT_THAT(ask(R"({"do":"run"})"), HasSubstr("there is no device yet"));
  EXPECT_EQ(ask(R"({"begin":{"bad":1}})"), "{\"error\":\"cannot make it: bad\"}\n");
  ASSERT_THAT(ask(R"({"begin":{}})"), HasSubstr("ok"));
  EXPECT_THAT(ask("nonsense"), HasSubstr("write one JSON object"));
  EXPECT_THAT(ask("{}"), HasSubstr("write one JSON object"));
  EXPECT_THAT(ask(R"({"jump":1})"), HasSubstr("cannot do 'jump'"));
  EXPECT_THAT(ask(R"({"set":5})"), HasSubstr("cannot do 'set'"));
  EXPECT_THAT(ask(R"({"do":"fly"})"), HasSubstr("cannot do 'fly'"));
}

TEST_F(DeviceControl, AnAnswerIsAValueOrAnError) {
  EXPECT_EQ(*read_control_answer(R"({"ok":true})"), json::object());
  EXPECT_EQ(*read_control_answer(R"({"values":{"%MW1":"1234"}})"), json({{"%MW1", "1234"}}));
  EXPECT_EQ(read_control_answer(R"({"error":"no such address"})").error().message,
            "no such address");
  EXPECT_THAT(read_control_answer("???").error().message, HasSubstr("it is no JSON object"));
}

TEST_F(DeviceControl, ALineHasNoNewlineInside) {
  EXPECT_EQ(control_line({{"do", "a\nb"}}), "{\"do\":\"a\\nb\"}\n");
}

}  // namespace
}  // namespace fieldproof::endpoints
