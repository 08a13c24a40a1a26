#include "harness/endpoints/pty.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "harness/endpoints/test_endpoint_name.hpp"
#include "harness/hosting/test_tiny_device.hpp"
#include "harness/system/fd_link.hpp"
#include "src/line/settings.hpp"

namespace fieldproof::hosting {
namespace {

using endpoints::test::endpoint_name;
using nlohmann::json;
using os::test::receive_error;
using os::test::receive_text;
using testing::HasSubstr;

/// This test program started as the emulator: `emulate MODEL?options --control FD --tty PATH`.
int emulate(const std::vector<std::string>& arguments) {
  HostOptions options;
  options.make_device = hosting::test::make_tiny_device;
  const std::string& device = arguments.at(2);
  options.model = device.substr(0, device.find('?'));
  if (device.find("station=5") != std::string::npos) options.config["station"] = 5;
  options.control = std::stoi(arguments.at(4));
  options.tty = arguments.at(6);
  return host_device(options);
}

[[gnu::constructor]] void run_as_emulator() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> arguments;
  for (std::string one; std::getline(file, one, '\0');) arguments.push_back(one);
  if (arguments.size() == 7 && arguments[1] == "emulate") std::_Exit(emulate(arguments));
}

std::unique_ptr<endpoints::Endpoint> open(const std::string& model,
                                          std::map<std::string, std::string> options = {}) {
  Result<std::unique_ptr<endpoints::Endpoint>> endpoint =
      endpoints::open_pty(endpoint_name("pty", model, std::move(options)));
  EXPECT_TRUE(endpoint) << endpoint.error().message;
  return endpoint ? std::move(*endpoint) : nullptr;
}

TEST(Pty, AnswersOverThePty) {
  const auto endpoint = open("tiny");
  ASSERT_TRUE(endpoint->begin(json::object()));
  ASSERT_TRUE(endpoint->send(to_bytes("hello.")));
  EXPECT_EQ(receive_text(*endpoint, ">"), "<hello>");
}

TEST(Pty, HasABackDoor) {
  const auto endpoint = open("tiny");
  ASSERT_TRUE(endpoint->begin(json::object()));
  ASSERT_TRUE(endpoint->set("%MW1", "12AB"));
  const Result<std::string> value = endpoint->get("%MW1", 4);
  ASSERT_TRUE(value) << value.error().message;
  EXPECT_EQ(*value, "12AB");
  EXPECT_EQ(endpoint->get("%MW2", 4).error().message, "cannot get %MW2: nothing was set");
  ASSERT_TRUE(endpoint->act("power_cycle"));
  EXPECT_FALSE(endpoint->get("%MW1", 4));
  EXPECT_EQ(endpoint->act("fly").error().message, "cannot do 'fly'");
}

TEST(Pty, EachCaseHasAFreshDeviceWithItsConfiguration) {
  const auto endpoint = open("tiny", {{"station", "5"}, {"floor_ms", "20"}});
  ASSERT_TRUE(endpoint->set("%MW1", "12"));
  ASSERT_TRUE(endpoint->begin({{"mode", "stop"}}));
  EXPECT_FALSE(endpoint->get("%MW1", 2));
  EXPECT_EQ(
      json::parse(*endpoint->get("@config", 0)),
      json(
          {{"model", "tiny"}, {"station", 5}, {"mode", "stop"}, {"inter_character_floor_ms", 20}}));
}

TEST(Pty, WithoutAModelTheCaseDecides) {
  const auto endpoint = open("");
  EXPECT_EQ(endpoint->describe(), "pty: emulator");
  EXPECT_FALSE(json::parse(*endpoint->get("@config", 0)).contains("model"))
      << "the device's own default";
  ASSERT_TRUE(endpoint->begin({{"model", "tiny"}}));
  EXPECT_EQ(json::parse(*endpoint->get("@config", 0))["model"], "tiny");
  EXPECT_THAT(endpoint->begin({{"model", "xgk"}}).error().message,
              HasSubstr("cannot make a device 'xgk'"));
}

TEST(Pty, NothingOfAnEarlierCaseIsLeft) {
  const auto endpoint = open("tiny");
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(endpoint->begin(json::object()));
    ASSERT_TRUE(endpoint->send(to_bytes("old.old.half of a frame")));
    ASSERT_TRUE(endpoint->begin(json::object()));
    ASSERT_TRUE(endpoint->send(to_bytes("new.")));
    ASSERT_EQ(receive_text(*endpoint, ">"), "<new>");
  }
}

TEST(Pty, AReplyThatTheOldDeviceOwesNeverComes) {
  const auto endpoint = open("tiny");
  ASSERT_TRUE(endpoint->begin({{"delay_ms", 30}}));
  ASSERT_TRUE(endpoint->send(to_bytes("old.")));
  ASSERT_TRUE(endpoint->begin(json::object()));
  const Result<Burst> burst = endpoint->receive(endpoint->now() + 60ms);
  ASSERT_TRUE(burst);
  EXPECT_TRUE(burst->bytes.empty());
}

TEST(Pty, SaysWhatItIs) {
  const auto endpoint = open("tiny");
  EXPECT_EQ(endpoint->describe(), "pty: emulator tiny");
  const endpoints::Capabilities& can = endpoint->capabilities();
  EXPECT_TRUE(can.back_door);
  EXPECT_FALSE(can.real_device || can.wire || can.simulated);
  EXPECT_EQ(can.timing_floor, 20ms);
  ASSERT_TRUE(endpoint->begin({{"line", "1200-8N1"}}));
  EXPECT_EQ(endpoint->character_time(), (line::LineSettings{1200, 8, 'N', 1}.character_time()));
  EXPECT_THAT(endpoint->begin({{"line", "1200-9N1"}}).error().message,
              HasSubstr("cannot read line settings '1200-9N1'"));
}

TEST(Pty, AnEmulatorThatDoesNotStartSaysWhy) {
  const auto endpoint = endpoints::open_pty(endpoint_name("pty", "xgk"));
  ASSERT_FALSE(endpoint);
  EXPECT_THAT(endpoint.error().message,
              testing::AllOf(HasSubstr("cannot open pty:xgk: "),
                             HasSubstr("the process ended with exit status 2; it said: "),
                             HasSubstr("fieldproof: cannot make a device 'xgk'")));
}

TEST(Pty, AnEmulatorThatDiesIsAnError) {
  const auto endpoint = open("tiny");
  EXPECT_THAT(endpoint->act("die").error().message,
              HasSubstr("the process ended with exit status 9"));
  EXPECT_THAT(receive_error(*endpoint).message,
              HasSubstr("cannot receive from pty:tiny: the process ended with exit status 9"));
}

TEST(Pty, AnotherProgramCanBeTheEmulator) {
  ::setenv("FIELDPROOF_EXECUTABLE", "/nowhere/fieldproof", 1);
  const auto endpoint = endpoints::open_pty(endpoint_name("pty", "tiny"));
  ::unsetenv("FIELDPROOF_EXECUTABLE");
  ASSERT_FALSE(endpoint);
  EXPECT_THAT(endpoint.error().message,
              HasSubstr("cannot start /nowhere/fieldproof: no such file or directory"));
}

}  // namespace
}  // namespace fieldproof::hosting
