#include "harness/endpoints/exec.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "harness/endpoints/test_endpoint_name.hpp"
#include "harness/test_protocol.hpp"

namespace fieldproof::endpoints::exec_test {
namespace {

using endpoints::test::endpoint_name;
using os::test::receive_error;
using os::test::receive_text;
using testing::HasSubstr;

std::unique_ptr<Endpoint> open(const std::string& command) {
  Result<std::unique_ptr<Endpoint>> endpoint =
      open_exec(endpoint_name("exec", command), harness::TestProtocol());
  EXPECT_TRUE(endpoint) << endpoint.error().message;
  return endpoint ? std::move(*endpoint) : nullptr;
}

TEST(Exec, WithoutTtyTheStandardStreamsAreTheLine) {
  const auto endpoint = open("cat");
  ASSERT_TRUE(endpoint->begin(nlohmann::json::object()));
  const Bytes controls{0x05, 0x03, 0x04, 0x15, 0x0A, 0x0D,
                       0x11, 0x13, 0x1A, 0xFF, 'z'};  // what a cooked pty would eat
  ASSERT_TRUE(endpoint->send(controls));
  EXPECT_EQ(to_hex(to_bytes(receive_text(*endpoint, "z"))), to_hex(controls));
}

TEST(Exec, TheMarkBecomesThePathOfThePort) {
  const auto endpoint = open(
      "/usr/bin/python3 -c \"import "
      "os,sys;f=os.open(sys.argv[1],os.O_RDWR);os.write(f,os.read(f,100).upper())\n"
      "while os.read(f,1):pass\" {tty}");
  ASSERT_TRUE(endpoint->send(to_bytes("loud")));
  EXPECT_EQ(receive_text(*endpoint, "LOUD"), "LOUD");
}

TEST(Exec, IsStartedAnewWhereACaseNeedsAnotherCommandLine) {
  const auto endpoint = open("echo {station} >{tty}; exec cat <{tty}");
  EXPECT_EQ(receive_text(*endpoint, "1\n"), "1\n");
  EXPECT_EQ(endpoint->starts(), 1u);
  EXPECT_TRUE(endpoint->configures("station"));
  EXPECT_FALSE(endpoint->configures("delay_ms"));
  ASSERT_TRUE(endpoint->begin({{"station", 5}, {"delay_ms", 10}}));
  EXPECT_EQ(receive_text(*endpoint, "5\n"), "5\n");
  ASSERT_TRUE(endpoint->begin({{"station", 5}, {"delay_ms", 20}}));
  EXPECT_EQ(endpoint->starts(), 2u) << "the command takes no delay";
  ASSERT_TRUE(endpoint->act("power_cycle"));
  EXPECT_EQ(receive_text(*endpoint, "5\n"), "5\n") << "as it was";
}

TEST(Exec, IsStartedOnceWithWhatTheFirstCaseNeeds) {
  const auto endpoint = open("echo {delay_ms} >{tty}; exec cat <{tty}");
  EXPECT_EQ(endpoint->starts(), 0u);
  ASSERT_TRUE(endpoint->begin({{"delay_ms", 10}}));
  EXPECT_EQ(receive_text(*endpoint, "10\n"), "10\n");
  EXPECT_EQ(endpoint->starts(), 1u);
  EXPECT_EQ(endpoint->started_with({{"delay_ms", 10}, {"station", 3}}),
            endpoint->started_with({{"delay_ms", 10}, {"station", 5}}))
      << "the command takes no station";
  EXPECT_NE(endpoint->started_with({{"delay_ms", 10}}), endpoint->started_with({{"delay_ms", 20}}));
}

TEST(Exec, WhatAChildSaysBesidesTheLineIsNotOnTheLine) {
  const auto endpoint = open("echo chatter; echo more >&2; cat <{tty} >{tty}");
  ASSERT_TRUE(endpoint->send(to_bytes("x")));
  EXPECT_EQ(receive_text(*endpoint, "x"), "x");
}

TEST(Exec, ADeadChildIsAnErrorThatSaysWhy) {
  const auto endpoint = open("echo cannot find the config >&2; exit 7");
  EXPECT_EQ(receive_error(*endpoint).message,
            "cannot receive from exec:echo cannot find the config >&2; exit 7: "
            "the process ended with exit status 7; it said: cannot find the config");
  const Result<Sent> sent = endpoint->send(to_bytes("x"));
  ASSERT_FALSE(sent);
  EXPECT_THAT(sent.error().message, HasSubstr("exit status 7"));
}

TEST(Exec, TheLastBytesOfADyingChildStillArrive) {
  for (int i = 0; i < 20; ++i) {
    const auto endpoint = open("echo bye");
    EXPECT_EQ(receive_text(*endpoint, "bye\n"), "bye\n");
    EXPECT_THAT(receive_error(*endpoint).message, HasSubstr("exit status 0"));
  }
}

TEST(Exec, AChildThatHangsIsSilent) {
  const auto endpoint = open("sleep 1000 <{tty}");
  ASSERT_TRUE(endpoint->send(to_bytes("anybody?")));
  const Result<Burst> burst = endpoint->receive(endpoint->now() + 30ms);
  ASSERT_TRUE(burst);
  EXPECT_TRUE(burst->bytes.empty());
}

TEST(Exec, AChildThatFloodsDoesNotHoldTheBench) {
  const auto endpoint = open("yes");
  std::size_t got = 0;
  while (got < 100'000) {
    const Result<Burst> burst = endpoint->receive(endpoint->now() + 5s);
    ASSERT_TRUE(burst) << burst.error().message;
    ASSERT_FALSE(burst->bytes.empty());
    got += burst->bytes.size();
  }
}

TEST(Exec, APowerCycleStartsItAnew) {
  const auto endpoint = open("echo $$.; exec cat");
  EXPECT_TRUE(endpoint->capabilities().can_power_cycle);
  const std::string first = receive_text(*endpoint, ".\n");
  ASSERT_TRUE(endpoint->send(to_bytes("never answered by the next one")));
  const Status done = endpoint->act("power_cycle");
  ASSERT_TRUE(done) << done.error().message;
  const std::string second = receive_text(*endpoint, ".\n");
  EXPECT_NE(first, second);
  EXPECT_EQ(second.find("never"), std::string::npos);
  EXPECT_THAT(second, testing::MatchesRegex("[0-9]+\\.\n"));
  ASSERT_TRUE(endpoint->send(to_bytes("here")));
  EXPECT_EQ(receive_text(*endpoint, "here"), "here");
}

TEST(Exec, APowerCycleRevivesADeadChild) {
  const auto endpoint = open("echo up; read x; exit 1");
  EXPECT_EQ(receive_text(*endpoint, "up\n"), "up\n");
  ASSERT_TRUE(endpoint->send(to_bytes("\n")));
  EXPECT_THAT(receive_error(*endpoint).message, HasSubstr("exit status 1"));
  ASSERT_TRUE(endpoint->act("power_cycle"));
  EXPECT_EQ(receive_text(*endpoint, "up\n"), "up\n");
}

TEST(Exec, SaysWhatItIs) {
  const auto endpoint = open("cat");
  EXPECT_EQ(endpoint->describe(), "exec:cat");
  EXPECT_TRUE(endpoint->capabilities().real_device);
  EXPECT_FALSE(endpoint->capabilities().wire);
  EXPECT_EQ(endpoint->capabilities().timing_floor, 20ms);
  EXPECT_FALSE(endpoint->act("stop"));
}

TEST(Exec, RefusesNoCommandAndNoFloor) {
  EXPECT_THAT(open_exec(endpoint_name("exec", ""), harness::TestProtocol()).error().message,
              HasSubstr("there is no command"));
  EXPECT_THAT(open_exec(endpoint_name("exec", "cat", {{"floor_ms", "x"}}), harness::TestProtocol())
                  .error()
                  .message,
              HasSubstr("floor_ms is 'x'"));
}

}  // namespace
}  // namespace fieldproof::endpoints::exec_test
