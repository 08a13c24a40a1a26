#include "harness/endpoints/network.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "harness/endpoints/listen.hpp"
#include "harness/endpoints/test_endpoint_name.hpp"
#include "harness/system/sockets/test_sockets.hpp"

namespace fieldproof::endpoints::network_test {
namespace {

using os::test::accepted;
using os::test::bound;
using os::test::hear;
using os::test::port_of;
using os::test::say;
using test::next_event;
using testing::HasSubstr;

const nlohmann::json no_config = nlohmann::json::object();

std::unique_ptr<Endpoint> open(const std::string& text, const harness::Protocol& protocol) {
  const Result<EndpointName> name = parse_endpoint(text);
  EXPECT_TRUE(name) << name.error().message;
  Result<std::unique_ptr<Endpoint>> endpoint = open_endpoint(*name, protocol);
  EXPECT_TRUE(endpoint) << endpoint.error().message;
  return std::move(*endpoint);
}

class Network : public testing::Test {
 protected:
  os::UniqueFd listener = bound(SOCK_STREAM);
  std::string where = "127.0.0.1:" + std::to_string(port_of(listener));
};

TEST_F(Network, ThePortIsThatOfTheNameElseOfTheProtocol) {
  for (const auto& [name, protocol] :
       {std::pair{where, test::NetworkProtocol()},
        {std::string("127.0.0.1"), test::NetworkProtocol(port_of(listener))}}) {
    const auto endpoint = open("tcp:" + name, protocol);
    EXPECT_EQ(endpoint->describe(), "tcp:" + where);
    EXPECT_TRUE(endpoint->capabilities().connections);
    EXPECT_FALSE(endpoint->capabilities().datagrams);
    EXPECT_TRUE(endpoint->capabilities().real_device);
    // What asks for the protocol's port means the service that the name gives.
    for (const std::uint16_t asked : {std::uint16_t{0}, protocol.default_port()}) {
      const Result<LinkId> link = endpoint->open(Transport::tcp, asked);
      ASSERT_TRUE(link) << link.error().message;
      const os::UniqueFd device = accepted(listener);
      ASSERT_TRUE(endpoint->send(to_bytes("question"), *link));
      EXPECT_EQ(hear(device), "question");
    }
  }
}

TEST_F(Network, ACaseBeginsWithoutLinksAndOpensNone) {
  const auto endpoint = open("tcp:" + where, test::NetworkProtocol());
  ASSERT_TRUE(endpoint->begin(no_config));
  ASSERT_EQ(*endpoint->open(Transport::tcp, 0), 1u);
  const os::UniqueFd device = accepted(listener);
  ASSERT_TRUE(endpoint->begin(no_config));
  EXPECT_EQ(hear(device), "FIN");
  say(device, "late");
  EXPECT_EQ(next_event(*endpoint, 0ns), "-");
  EXPECT_FALSE(endpoint->send(to_bytes("x"), 1));
  listener.reset();
  ASSERT_TRUE(endpoint->begin(no_config)) << "nothing is opened";
}

TEST_F(Network, ARefusedConnectionIsAResetAndNoError) {
  const auto endpoint = open("tcp:" + where, test::NetworkProtocol());
  listener.reset();
  const Result<LinkId> link = endpoint->open(Transport::tcp, 0);
  ASSERT_TRUE(link) << link.error().message;
  EXPECT_EQ(next_event(*endpoint), "1 reset");
}

TEST_F(Network, OneDeviceIsReachedBothWays) {
  const os::UniqueFd datagrams = bound(SOCK_DGRAM);
  const std::string udp = std::to_string(port_of(datagrams));
  const auto endpoint = open("tcp:" + where + "?udp=" + udp, test::NetworkProtocol());
  EXPECT_EQ(endpoint->describe(), "tcp:" + where + ", UDP " + udp);
  EXPECT_TRUE(endpoint->capabilities().datagrams);
  ASSERT_EQ(*endpoint->open(Transport::tcp, 0), 1u);
  ASSERT_EQ(*endpoint->open(Transport::udp, 0), 2u);
  ASSERT_TRUE(endpoint->send(to_bytes("datagram"), 2));
  EXPECT_EQ(hear(datagrams), "datagram");
  say(accepted(listener), "bye");
  EXPECT_EQ(next_event(*endpoint), "1 data 'bye'");
  EXPECT_EQ(next_event(*endpoint), "1 closed");
}

TEST_F(Network, DatagramsAloneHaveNoConnections) {
  const os::UniqueFd device = bound(SOCK_DGRAM);
  const auto endpoint =
      open("udp:127.0.0.1:" + std::to_string(port_of(device)), test::NetworkProtocol());
  EXPECT_FALSE(endpoint->capabilities().connections);
  EXPECT_TRUE(endpoint->capabilities().datagrams);
  EXPECT_THAT(endpoint->open(Transport::tcp, 0).error().message,
              HasSubstr("the endpoint is for datagrams; write tcp:HOST:PORT"));
  ASSERT_EQ(*endpoint->open(Transport::udp, 0), 1u);
}

TEST_F(Network, WhatTheNameDoesNotSayIsAskedFor) {
  const auto endpoint = open("tcp:" + where, test::NetworkProtocol());
  EXPECT_EQ(endpoint->open(Transport::udp, 0).error().message,
            "cannot open a datagram port of tcp:" + where +
                ": the endpoint names no port for datagrams; add ?udp=PORT");
}

TEST_F(Network, AHostThatNobodyKnowsIsSaidAtOnce) {
  const auto endpoint = open_endpoint({"tcp", "no-such-host.invalid", {}}, test::NetworkProtocol());
  ASSERT_FALSE(endpoint);
  EXPECT_THAT(endpoint.error().message,
              testing::StartsWith("cannot open tcp:no-such-host.invalid: cannot find host"));
}

class Listen : public testing::Test {
 protected:
  /// A connection of the device.
  os::UniqueFd connect() { return os::test::connected(SOCK_STREAM, port); }
  std::unique_ptr<Endpoint> endpoint = open("listen:127.0.0.1:0", test::NetworkProtocol());
  std::uint16_t port = static_cast<std::uint16_t>(
      std::stoi(endpoint->describe().substr(endpoint->describe().find("TCP ") + 4)));
};

TEST_F(Listen, TheDeviceOpensTheLinks) {
  const os::UniqueFd device = connect();
  EXPECT_EQ(next_event(*endpoint), "own 0 opened");
  say(device, "request");
  EXPECT_EQ(next_event(*endpoint), "own 0 data 'request'");
  ASSERT_TRUE(endpoint->send(to_bytes("reply"), first_own_link));
  EXPECT_EQ(hear(device), "reply");
  EXPECT_THAT(endpoint->open(Transport::tcp, 0).error().message,
              HasSubstr("there the device opens the links"));
}

TEST_F(Listen, AConnectionStandsFromCaseToCase) {
  const os::UniqueFd device = connect();
  EXPECT_EQ(next_event(*endpoint), "own 0 opened");
  ASSERT_TRUE(endpoint->begin(no_config));
  say(device, "next request");
  EXPECT_EQ(next_event(*endpoint), "own 0 data 'next request'");
  ASSERT_TRUE(endpoint->close(first_own_link, Closing::rst));
  EXPECT_EQ(hear(device), "ECONNRESET");
}

TEST_F(Listen, APortInUseIsSaid) {
  const Result<std::unique_ptr<Endpoint>> second =
      open_endpoint({"listen", "127.0.0.1:" + std::to_string(port), {}}, test::NetworkProtocol());
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().message, HasSubstr("the port is in use; end the program that has it"));
}

}  // namespace
}  // namespace fieldproof::endpoints::network_test
