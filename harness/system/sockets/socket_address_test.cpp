#include "harness/system/sockets/socket_address.hpp"

#include <gmock/gmock.h>

#include "harness/system/sockets/socket_connect.hpp"
#include "harness/system/sockets/socket_listen.hpp"
#include "harness/system/sockets/test_sockets.hpp"

namespace fieldproof::os {
namespace {

using testing::HasSubstr;

std::string read(const std::string& text) {
  const Result<SocketName> name = parse_socket_name(text);
  if (!name) return name.error().message;
  return name->host + '|' + (name->port ? std::to_string(*name->port) : "none");
}

TEST(SocketName, HostAndPort) {
  EXPECT_EQ(read("plc"), "plc|none");
  EXPECT_EQ(read("plc:502"), "plc|502");
  EXPECT_EQ(read("192.168.1.10:2004"), "192.168.1.10|2004");
  EXPECT_EQ(read(":0"), "|0");
  EXPECT_EQ(read("[::1]"), "::1|none");
  EXPECT_EQ(read("[fe80::1%eth0]:502"), "fe80::1%eth0|502");
}

TEST(SocketName, WhatIsNoneIsSaid) {
  EXPECT_EQ(read("plc:"), "there is no port; write HOST:PORT");
  EXPECT_EQ(read("plc:http"), "'http' is no port; write a number up to 65535");
  EXPECT_EQ(read("plc:65536"), "'65536' is no port; write a number up to 65535");
  EXPECT_EQ(read("plc:-1"), "'-1' is no port; write a number up to 65535");
  EXPECT_EQ(read("::1"), "'::1' has several colons; write an IPv6 address in brackets: [::1]:502");
  EXPECT_EQ(read("[::1"), "the brackets of '[::1' do not hold an address; write [IPV6]:PORT");
  EXPECT_EQ(read("[::1]502"),
            "the brackets of '[::1]502' do not hold an address; write [IPV6]:PORT");
}

TEST(SocketName, IsWrittenAsItIsRead) {
  for (const char* text : {"plc", "plc:502", "[::1]:502", "[::1]", ":0"})
    EXPECT_EQ(to_string(*parse_socket_name(text)), text);
}

TEST(Connecting, SaysWhyNot) {
  const auto message = [](const std::string& where) {
    return connect_socket(where, SOCK_STREAM).error().message;
  };
  EXPECT_EQ(message("plc"), "cannot connect to plc: there is no port; write HOST:PORT");
  EXPECT_EQ(message(":2004"), "cannot connect to :2004: there is no host; write HOST:PORT");
  EXPECT_EQ(message("127.0.0.1:0"),
            "cannot connect to 127.0.0.1:0: 0 is no port; write a number from 1 to 65535");
  EXPECT_THAT(message("no-such-host.invalid:502"),
              HasSubstr("cannot find host 'no-such-host.invalid'"));
}

TEST(ListenSocket, SaysWhyNot) {
  const UniqueFd taken = test::bound(SOCK_STREAM);
  const auto message = [](const SocketName& name, int type = SOCK_STREAM) {
    const Result<UniqueFd> fd = listen_socket(name, type);
    return fd ? "listens" : fd.error().message;
  };
  EXPECT_THAT(message({"127.0.0.1", test::port_of(taken)}),
              HasSubstr("the port is in use; end the program that has it, or choose another port"));
  const UniqueFd datagrams = test::bound(SOCK_DGRAM);
  EXPECT_THAT(message({"127.0.0.1", test::port_of(datagrams)}, SOCK_DGRAM),
              HasSubstr("the port is in use"));
  EXPECT_THAT(message({"192.0.2.1", 0}), HasSubstr("this is no address of this computer"));
  EXPECT_EQ(message({"127.0.0.1", std::nullopt}), "listens") << "on a free port";
}

TEST(ListenSocket, IPv6HasPortsToo) {
  const Result<UniqueFd> fd = listen_socket({"::1", 0}, SOCK_STREAM);
  ASSERT_TRUE(fd) << fd.error().message;
  const std::string name = to_string(local_address(fd->get()));
  EXPECT_THAT(name, testing::MatchesRegex("\\[::1\\]:[0-9]+"));
  const Result<UniqueFd> client = connect_socket(name, SOCK_STREAM);
  ASSERT_TRUE(client) << client.error().message;
  SocketAddress from;
  EXPECT_TRUE(accept_socket(fd->get(), from));
  EXPECT_EQ(to_string(from), to_string(local_address(client->get())));
}

}  // namespace
}  // namespace fieldproof::os
