#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "harness/endpoints/exec.hpp"
#include "harness/endpoints/test_endpoint_name.hpp"

namespace fieldproof::endpoints {
namespace {

using test::next_event;
using testing::HasSubstr;

const nlohmann::json as_server = nlohmann::json::object();
const nlohmann::json as_client{{"role", "client"}};

const std::string listening = "TCP-LISTEN:{port},bind=127.0.0.1,reuseaddr";

std::unique_ptr<Endpoint> open(const std::string& command) {
  Result<std::unique_ptr<Endpoint>> endpoint =
      open_exec(test::endpoint_name("exec", command), test::NetworkProtocol());
  EXPECT_TRUE(endpoint) << endpoint.error().message;
  return std::move(*endpoint);
}

TEST(ExecNetwork, AServerIsReadyWhenItAcceptsAConnection) {
  const auto endpoint = open("exec socat " + listening + ",fork EXEC:cat");
  EXPECT_TRUE(endpoint->capabilities().connections);
  EXPECT_TRUE(endpoint->capabilities().can_power_cycle);
  ASSERT_TRUE(endpoint->begin(as_server));
  const Result<LinkId> link = endpoint->open(Transport::tcp, 0);
  ASSERT_TRUE(link) << link.error().message;
  ASSERT_TRUE(endpoint->send(to_bytes("echo"), *link));
  EXPECT_EQ(next_event(*endpoint), "1 data 'echo'");
  ASSERT_TRUE(endpoint->begin(as_server)) << "it is not started again";
  ASSERT_EQ(*endpoint->open(Transport::tcp, 502), 2u);
  ASSERT_TRUE(endpoint->send(to_bytes("again"), 2));
  EXPECT_EQ(next_event(*endpoint), "2 data 'again'");
}

TEST(ExecNetwork, APowerCycleStartsItAnew) {
  const auto endpoint = open("echo $$ >&2; socat " + listening + " \"EXEC:echo $$\"; sleep 1000");
  ASSERT_TRUE(endpoint->begin(as_server));
  ASSERT_TRUE(endpoint->open(Transport::tcp, 0));
  const std::string first = next_event(*endpoint);
  ASSERT_TRUE(endpoint->act("power_cycle"));
  EXPECT_EQ(next_event(*endpoint, 0ns), "-") << "nothing of the links before";
  ASSERT_EQ(*endpoint->open(Transport::tcp, 0), 2u);
  const std::string second = next_event(*endpoint);
  EXPECT_THAT(second, testing::MatchesRegex("2 data '[0-9]+\n'"));
  EXPECT_NE(first.substr(1), second.substr(1));
}

TEST(ExecNetwork, WhatIsSentAfterAPowerCycleMeetsAReset) {
  const auto endpoint = open("exec socat " + listening + ",fork EXEC:cat");
  ASSERT_TRUE(endpoint->begin(as_server));
  for (LinkId link : {1u, 2u}) ASSERT_EQ(*endpoint->open(Transport::tcp, 0), link);
  ASSERT_TRUE(endpoint->act("power_cycle"));
  EXPECT_EQ(next_event(*endpoint, 0ns), "-") << "it is not heard before";
  ASSERT_TRUE(endpoint->send(to_bytes("more"), 1));
  EXPECT_EQ(next_event(*endpoint), "1 reset");
  EXPECT_TRUE(endpoint->close(2, Closing::fin)) << "of which the device knows nothing";
  EXPECT_EQ(next_event(*endpoint, 0ns), "-");
}

TEST(ExecNetwork, AProgramThatEndsSaysWhy) {
  const auto endpoint = open("echo no licence for {port} >&2; exit 7");
  ASSERT_TRUE(endpoint->begin(as_server));
  const Result<LinkId> link = endpoint->open(Transport::tcp, 0);
  ASSERT_FALSE(link);
  EXPECT_THAT(link.error().message, HasSubstr("the process ended with exit status 7; it said: no "
                                              "licence for "));
  EXPECT_THAT(next_event(*endpoint), HasSubstr("exit status 7"));
}

TEST(ExecNetwork, WhatItSaidBeforeItsEndIsHeard) {
  const auto endpoint = open("socat -u \"EXEC:echo bye\" " + listening + "; exit 3");
  ASSERT_TRUE(endpoint->begin(as_server));
  ASSERT_TRUE(endpoint->open(Transport::tcp, 0));
  EXPECT_EQ(next_event(*endpoint), "1 data 'bye\n'");
  EXPECT_EQ(next_event(*endpoint), "1 closed");
  EXPECT_THAT(next_event(*endpoint), HasSubstr("exit status 3"));
}

TEST(ExecNetwork, AClientFindsTheBenchListening) {
  const auto endpoint = open("exec socat TCP:127.0.0.1:{port} EXEC:cat");
  ASSERT_TRUE(endpoint->begin(as_client));
  EXPECT_EQ(next_event(*endpoint), "own 0 opened");
  ASSERT_TRUE(endpoint->begin(as_client)) << "it goes on";
  ASSERT_TRUE(endpoint->send(to_bytes("answer"), first_own_link));
  EXPECT_EQ(next_event(*endpoint), "own 0 data 'answer'");
  EXPECT_THAT(endpoint->open(Transport::tcp, 0).error().message, HasSubstr("of a client"));
  ASSERT_TRUE(endpoint->act("power_cycle"));
  EXPECT_EQ(next_event(*endpoint), "own 1 opened");
}

/// It may say more on a connection that the bench has closed: that is of the case before.
TEST(ExecNetwork, AConnectionThatTheBenchHasClosedIsOverWithItsCase) {
  const auto endpoint = open(
      "/usr/bin/python3 -c \"import socket; s = socket.create_connection(('127.0.0.1', {port})); "
      "s.sendall(b'one'); s.recv(1); s.sendall(b'late'); s.recv(1); input()\"");
  ASSERT_TRUE(endpoint->begin(as_client));
  const Result<Burst> opened = endpoint->receive(endpoint->now() + 10s);
  ASSERT_TRUE(opened);
  EXPECT_EQ(opened->event, LinkEvent::opened);
  EXPECT_THAT(next_event(*endpoint), HasSubstr("data 'one'"));
  ASSERT_TRUE(endpoint->close(opened->link, Closing::fin));
  ASSERT_TRUE(endpoint->begin(as_client));
  EXPECT_EQ(next_event(*endpoint, 200ms), "-");
}

TEST(ExecNetwork, AClientIsToldWhatToAsk) {
  const auto endpoint = open("exec socat - TCP:127.0.0.1:{port}");
  ASSERT_TRUE(endpoint->begin(as_client));
  EXPECT_EQ(next_event(*endpoint), "own 0 opened");
  ASSERT_TRUE(endpoint->tell("read M100"));
  EXPECT_EQ(next_event(*endpoint), "own 0 data 'read M100\n'");
}

TEST(ExecNetwork, DatagramsHaveAMarkOfTheirOwn) {
  const auto endpoint = open("socat UDP-RECVFROM:{udp_port},fork EXEC:cat & exec socat " +
                             listening + ",fork \"EXEC:echo {udp_port}\"");
  EXPECT_TRUE(endpoint->capabilities().datagrams);
  ASSERT_TRUE(endpoint->begin(as_server));
  ASSERT_EQ(*endpoint->open(Transport::tcp, 0), 1u);
  EXPECT_THAT(next_event(*endpoint), testing::MatchesRegex("1 data '[0-9]+\n'"));
  ASSERT_EQ(*endpoint->open(Transport::udp, 0), 2u);
  const auto without = open("exec socat " + listening + " EXEC:cat");
  EXPECT_FALSE(without->capabilities().datagrams);
  ASSERT_TRUE(without->begin(as_server));
  EXPECT_THAT(without->open(Transport::udp, 0).error().message,
              HasSubstr("write {udp_port} where the command takes its port"));
}

}  // namespace
}  // namespace fieldproof::endpoints
