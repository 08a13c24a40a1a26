#include "harness/endpoints/controlled.hpp"

#include <gmock/gmock.h>

#include <deque>

#include "harness/test_protocol.hpp"

namespace fieldproof::endpoints {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A device that nobody needs to talk to.
struct Silent : Endpoint {
  const Capabilities& capabilities() const override { return can; }
  std::string describe() const override { return "silent"; }
  Time now() const override { return {}; }
  Duration character_time() const override { return 1ms; }
  Status begin(const json&) override { return ok(); }
  bool configures(std::string_view key) const override { return key == "station"; }
  unsigned starts() const override { return started; }
  Result<Sent> send(ByteView, LinkId) override { return fail("silent"); }
  Result<Burst> receive(Time) override { return Burst{}; }
  Status act(std::string_view) override {
    ++started;
    return ok();
  }

  Capabilities can{.real_device = true};
  unsigned started = 1;
};

class ControlledTest : public testing::Test {
 protected:
  ControlledTest() {
    auto device = std::make_unique<Silent>();
    device_ = device.get();
    device_->can.can_power_cycle = true;
    controlled_ = std::make_unique<Controlled>(
        std::move(device), protocol_,
        ControlProgram{[this](const std::string& line) {
                         asked.push_back(line);
                         return ended ? Status(fail("it has ended")) : ok();
                       },
                       [this](Duration patience) {
                         if (patience == 0ns || answers.empty()) return std::string();
                         std::string answer = answers.front();
                         answers.pop_front();
                         return answer;
                       }});
  }

  Controlled& device() { return *controlled_; }
  void declare(const json& config) { ASSERT_TRUE(device().begin(config)); }
  std::string error(const Status& status) {
    EXPECT_FALSE(status);
    return status ? "" : status.error().message;
  }

  std::vector<std::string> asked;
  std::deque<std::string> answers;
  bool ended = false;
  Silent* device_ = nullptr;

 private:
  harness::TestProtocol protocol_;
  std::unique_ptr<Controlled> controlled_;
};

TEST_F(ControlledTest, IsToldWhatDiffersAndNothingElse) {
  declare({{"station", 1}, {"delay_ms", 0}, {"mode", "run"}});
  EXPECT_THAT(asked, IsEmpty()) << "this is what it has";
  answers = {R"({"ok": true})", R"({"ok": true})"};
  ASSERT_TRUE(device().begin({{"station", 5}, {"delay_ms", 10}, {"mode", "run"}, {"slot", 3}}));
  ASSERT_TRUE(device().begin({{"station", 5}, {"delay_ms", 10}, {"mode", "run"}}));
  EXPECT_THAT(asked,
              ElementsAre(R"({"config":{"delay_ms":10,"slot":3}})", R"({"config":{"slot":null}})"))
      << "the command of the device takes the station";
}

TEST_F(ControlledTest, WhatItDoesNotSupportIsRefusedAndNotAskedAgain) {
  declare({{"mode", "run"}});
  answers = {R"({"unsupported": ["slot"]})"};
  const Status begun = device().begin({{"mode", "stop"}, {"slot", 3}});
  EXPECT_EQ(error(begun), "needs slot = 3, which --control does not support");
  EXPECT_TRUE(begun.error().refused);
  EXPECT_FALSE(device().configures("slot"));
  EXPECT_TRUE(device().configures("mode"));
  ASSERT_TRUE(device().begin({{"mode", "stop"}, {"slot", 4}}));
  EXPECT_EQ(asked.size(), 1u) << "the mode holds";
}

TEST_F(ControlledTest, AfterARestartItIsToldAnew) {
  declare({{"mode", "run"}});
  answers = {R"({"ok": true})", R"({"ok": true})"};
  ASSERT_TRUE(device().begin({{"mode", "stop"}}));
  ASSERT_TRUE(device().act("power_cycle"));
  EXPECT_THAT(asked, ElementsAre(R"({"config":{"mode":"stop"}})", R"({"config":{"mode":"stop"}})"));
}

/// The program of the device itself.
struct Obedient : Silent {
  Status tell(std::string_view line) override {
    told.emplace_back(line);
    return ok();
  }
  std::string answer(Duration patience) override { return patience == 0ns ? "" : says; }
  void lose_links() override { ++lost; }

  std::vector<std::string> told;
  std::string says = R"({"ok": true})";
  int lost = 0;
};

TEST(ControlledProgram, IsSwitchedOffAndOnByAWordAndKeepsWhatItWasTold) {
  auto own = std::make_unique<Obedient>();
  Obedient& program = *own;
  const harness::TestProtocol protocol;
  Controlled device(std::move(own), protocol, {});
  ASSERT_TRUE(device.begin({{"mode", "run"}, {"delay_ms", 0}}));
  ASSERT_TRUE(device.begin({{"mode", "run"}, {"delay_ms", 5}}));
  ASSERT_TRUE(device.renew());
  EXPECT_EQ(program.lost, 1);
  EXPECT_EQ(program.starts(), 1u);
  ASSERT_TRUE(device.begin({{"mode", "run"}, {"delay_ms", 5}}));
  EXPECT_THAT(program.told, ElementsAre(R"({"config":{"delay_ms":5}})", R"({"do":"power_cycle"})",
                                        R"({"config":{"mode":"run"}})"))
      << "it may come up in another mode";
}

TEST(ControlledProgram, ThatKnowsNoPowerCycleIsNotAskedForItAgain) {
  auto own = std::make_unique<Obedient>();
  Obedient& program = *own;
  program.says = R"({"unsupported": true})";
  const harness::TestProtocol protocol;
  Controlled device(std::move(own), protocol, {});
  for (int i = 0; i < 2; ++i) {
    const Status renewed = device.renew();
    ASSERT_FALSE(renewed);
    EXPECT_TRUE(renewed.error().refused);
  }
  EXPECT_EQ(program.told.size(), 1u);
  EXPECT_FALSE(device.capabilities().renews);
}

TEST_F(ControlledTest, AProgramBesideTheDeviceCannotSayWhenItIsUpAgain) {
  EXPECT_TRUE(device().renew().error().refused);
  EXPECT_THAT(asked, IsEmpty());
}

TEST_F(ControlledTest, WhatAnActionChangedIsToldBeforeTheNextCase) {
  declare({{"mode", "run"}});
  answers = {R"({"ok": true})", R"({"ok": true})", R"({"ok": true})", R"({"ok": true})"};
  ASSERT_TRUE(device().act("stop"));
  ASSERT_TRUE(device().begin({{"mode", "run"}}));
  ASSERT_TRUE(device().act("error on"));
  ASSERT_TRUE(device().begin({{"mode", "run"}}));
  EXPECT_THAT(asked, ElementsAre(R"({"do":"stop"})", R"({"config":{"mode":"run"}})",
                                 R"({"do":"error on"})", R"({"config":{"error":null}})"));
}

TEST_F(ControlledTest, MemoryGoesElementByElementAndIsPutBack) {
  answers = {R"({"values": {"%FW9": "0001", "%FW10": "0002"}})", R"({"ok": true})",
             R"({"ok": true})"};
  ASSERT_TRUE(device().set("%FW9", "12345678"));
  ASSERT_TRUE(device().put_back());
  EXPECT_THAT(
      asked, ElementsAre(R"({"get":["%FW9","%FW10"]})", R"({"set":{"%FW10":"5678","%FW9":"1234"}})",
                         R"({"set":{"%FW10":"0002","%FW9":"0001"}})"));
}

TEST_F(ControlledTest, OnADeviceThatStaysNothingIsSetThatCannotBePutBack) {
  device_->can.can_power_cycle = false;
  Controlled staying(std::make_unique<Silent>(), harness::TestProtocol(),
                     {[this](const std::string& line) {
                        asked.push_back(line);
                        return ok();
                      },
                      [this](Duration patience) {
                        return patience == 0ns ? std::string() : R"({"unsupported": true})";
                      }});
  EXPECT_THAT(error(staying.set("%FW0", "1234")), HasSubstr("since it could not be put back"));
  EXPECT_EQ(asked.size(), 1u);
}

TEST_F(ControlledTest, SeveralFormsOfValuesAreRead) {
  for (const char* form :
       {R"({"values": {"%PW0": "12ab"}})", R"({"get": {"%PW0": "12ab"}})", R"({"%PW0": "12ab"})"}) {
    answers = {form};
    const Result<std::string> value = device().get("%PW0", 4);
    ASSERT_TRUE(value) << form;
    EXPECT_EQ(*value, "12AB");
  }
}

TEST_F(ControlledTest, ABadAnswerIsRefusedAndQuoted) {
  for (const char* bad : {"{broken", R"({"values": {"%PW0": "12"}})", R"({"ok": true})",
                          R"({"values": {"%PW0": "here"}})"}) {
    answers = {bad};
    const Result<std::string> value = device().get("%PW0", 4);
    ASSERT_FALSE(value) << bad;
    EXPECT_TRUE(value.error().refused) << bad;
    EXPECT_THAT(value.error().message, HasSubstr("--control"));
  }
  answers = {R"({"error": "no such input"})"};
  EXPECT_EQ(device().get("%PW0", 4).error().message,
            R"(--control refuses {"get":["%PW0"]}: no such input)");
}

TEST_F(ControlledTest, WhoDoesNotAnswerIsAskedNoMoreUntilItIsStartedAnew) {
  EXPECT_THAT(device().get("%PW0", 4).error().message, HasSubstr("gave no answer to"));
  EXPECT_TRUE(device().get("%PW0", 4).error().refused);
  EXPECT_EQ(asked.size(), 1u);
  ASSERT_TRUE(device().act("power_cycle"));
  answers = {R"({"values": {"%PW0": "0001"}})"};
  EXPECT_TRUE(device().get("%PW0", 4));
}

TEST_F(ControlledTest, TheEndOfAProgramBesideTheDeviceIsNotThatOfTheDevice) {
  ended = true;
  const Result<std::string> value = device().get("%PW0", 4);
  EXPECT_TRUE(value.error().refused);
  EXPECT_EQ(value.error().message, "--control: it has ended");
}

}  // namespace
}  // namespace fieldproof::endpoints
