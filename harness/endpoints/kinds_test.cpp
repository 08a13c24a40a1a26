#include "harness/endpoints/kinds.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "harness/endpoints/network_name.hpp"
#include "harness/endpoints/test_endpoint_name.hpp"

namespace fieldproof::endpoints::kinds_test {
namespace {

using test::NetworkProtocol;

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

EndpointName parsed(std::string_view text) {
  const Result<EndpointName> name = parse_endpoint(text);
  EXPECT_TRUE(name) << name.error().message;
  return name ? *name : EndpointName{};
}

std::string refusal(std::string_view text) {
  const auto name = parse_endpoint(text);
  return name ? "accepted" : name.error().message;
}

std::string check(std::string_view text, const harness::Protocol& protocol) {
  const Status checked = check_endpoint(parsed(text), protocol);
  return checked ? "fits" : checked.error().message;
}

TEST(Kinds, EachTakesTheLineThatItCanSet) {
  const line::LineSettings line{38400, 7, 'E', 2};
  const auto options = [&](std::string_view text) { return with_line(parsed(text), line).options; };
  EXPECT_THAT(options("emulator:xbc-h"), ElementsAre(Pair("line", "38400-7E2")));
  EXPECT_THAT(options("pty:xbc-h"), ElementsAre(Pair("line", "38400-7E2")));
  for (const char* port : {"serial:/dev/ttyUSB0?baud=9600", "rfc2217:host:2000"})
    EXPECT_THAT(options(port), ElementsAre(Pair("baud", "38400"), Pair("frame", "7E2"))) << port;
  for (const char* none : {"tcp:h:1", "udp:h:1", "exec:x", "listen:h:1"})
    EXPECT_THAT(options(none), testing::IsEmpty()) << none;
}

TEST(Kinds, CapabilitiesFollowFromTheTable) {
  EXPECT_TRUE(capabilities_of(parsed("emulator:")).simulated);
  EXPECT_TRUE(capabilities_of(parsed("pty:")).back_door);
  EXPECT_FALSE(capabilities_of(parsed("pty:")).real_device);
  EXPECT_TRUE(capabilities_of(parsed("exec:x")).can_power_cycle);
  EXPECT_TRUE(capabilities_of(parsed("tcp:h:1")).real_device);
  EXPECT_FALSE(capabilities_of(parsed("tcp:h:1")).can_power_cycle);
}

TEST(Kinds, AnAddressIsCheckedBeforeAnythingIsOpened) {
  EXPECT_EQ(refusal("tcp:plc:70000"),
            "cannot read endpoint 'tcp:plc:70000': '70000' is no port; write a number up to 65535");
  EXPECT_THAT(refusal("tcp:plc:0"), HasSubstr("0 is no port; write a number from 1 to 65535"));
  EXPECT_THAT(refusal("udp:plc:modbus"), HasSubstr("'modbus' is no port"));
  EXPECT_THAT(refusal("tcp::502"), HasSubstr("there is no host; write HOST:PORT"));
  EXPECT_THAT(refusal("tcp:::1"), HasSubstr("write an IPv6 address in brackets"));
  EXPECT_THAT(refusal("rfc2217:plc:x"), HasSubstr("'x' is no port"));
  EXPECT_THAT(refusal("tcp:plc:2004?udp=0"), HasSubstr("udp is '0', which is no port"));
  EXPECT_THAT(refusal("tcp:plc:2004?udp=2005x"), HasSubstr("udp is '2005x', which is no port"));
  EXPECT_THAT(refusal("tcp:plc:2004?line=9600-8N1"),
              HasSubstr("line is '9600-8N1'; a socket has no speed and format"));
  EXPECT_EQ(refusal("listen:0.0.0.0:0"), "accepted") << "any free port";
  EXPECT_THAT(refusal("exec:./plc {port} {tty}"), HasSubstr("exclude each other"));
}

TEST(Kinds, AProtocolOfANetworkNeedsOne) {
  const NetworkProtocol network;
  for (const char* text :
       {"tcp:plc", "tcp:plc:1502", "udp:plc", "emulator:", "listen:0.0.0.0", "exec:./plc {port}"})
    EXPECT_EQ(check(text, network), "fits") << text;
  EXPECT_EQ(check("serial:/dev/ttyUSB0", network),
            "cannot use serial:/dev/ttyUSB0 for xgt-cnet: it runs on a network; write tcp:HOST");
  EXPECT_THAT(check("pty:xd", network), HasSubstr("write emulator:xd"));
  EXPECT_THAT(check("tcp:plc:2004?line=raw", network), HasSubstr("leave line=raw out"));
  EXPECT_THAT(check("exec:./plc {tty}", network), HasSubstr("write {port} where the command"));
}

TEST(Kinds, AProtocolOfALineNeedsOne) {
  const harness::TestProtocol serial;
  for (const char* text : {"serial:/dev/ttyUSB0", "tcp:plc:2000", "tcp:plc:2000?line=raw",
                           "udp:plc:2000", "pty:", "exec:./plc {tty}", "exec:./plc"})
    EXPECT_EQ(check(text, serial), "fits") << text;
  EXPECT_EQ(
      check("tcp:plc", serial),
      "cannot use tcp:plc for xgt-cnet: there is no port, and a serial server has none of its "
      "own; write tcp:plc:PORT");
  EXPECT_THAT(check("listen:0.0.0.0:2000", serial), HasSubstr("it runs on a serial line"));
  EXPECT_THAT(check("exec:./plc {port}", serial), HasSubstr("write {tty} where the command"));
}

TEST(Kinds, PortsComeFromTheNameElseFromTheProtocol) {
  const NetworkProtocol network;
  const auto ports = [&](std::string_view text) {
    const NetworkPorts read = network_ports(parsed(text), network);
    return fmt::format("{} {} {}", read.host, read.tcp, read.udp);
  };
  EXPECT_EQ(ports("tcp:plc"), "plc 502 0");
  EXPECT_EQ(ports("tcp:[::1]:1502"), "::1 1502 0");
  EXPECT_EQ(ports("tcp:plc:2004?udp=2005"), "plc 2004 2005");
  EXPECT_EQ(ports("udp:plc"), "plc 0 502");
  EXPECT_EQ(ports("udp:plc:2005"), "plc 0 2005");
  EXPECT_EQ(ports("listen:127.0.0.1:0"), "127.0.0.1 0 0");
}

}  // namespace
}  // namespace fieldproof::endpoints::kinds_test
