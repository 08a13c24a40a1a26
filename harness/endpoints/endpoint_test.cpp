#include "harness/endpoints/endpoint.hpp"
#include "harness/test_protocol.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace fieldproof::endpoints {
namespace {

using ::testing::HasSubstr;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

EndpointName parsed(std::string_view text) {
  const auto name = parse_endpoint(text);
  EXPECT_TRUE(name) << (name ? "" : name.error().message);
  return name ? *name : EndpointName{};
}

std::string refusal(std::string_view text) {
  const auto name = parse_endpoint(text);
  return name ? "accepted" : name.error().message;
}

TEST(EndpointName, KindTargetAndOptions) {
  const EndpointName name = parsed("pty:xbc-h?station=1&protocol=xgt-cnet");
  EXPECT_EQ(name.kind, "pty");
  EXPECT_EQ(name.target, "xbc-h");
  EXPECT_THAT(name.options,
              UnorderedElementsAre(Pair("station", "1"), Pair("protocol", "xgt-cnet")));
  EXPECT_EQ(name.option("station", "9"), "1");
  EXPECT_EQ(name.option("line", "9600-8N1"), "9600-8N1");
}

TEST(EndpointName, AnEmulatorNeedsNoTarget) {
  for (const char* text : {"emulator", "emulator:", "emulator?", "emulator:?"}) {
    EXPECT_EQ(parsed(text).kind, "emulator");
    EXPECT_EQ(parsed(text).target, "");
    EXPECT_TRUE(parsed(text).options.empty());
  }
  EXPECT_EQ(parsed("emulator?station=2").option("station", ""), "2");
}

TEST(EndpointName, TargetsKeepTheirColons) {
  EXPECT_EQ(parsed("tcp:127.0.0.1:2004").target, "127.0.0.1:2004");
  EXPECT_EQ(parsed("tcp:[::1]:2004?station=3").target, "[::1]:2004");
  const EndpointName serial =
      parsed("serial:/dev/serial/by-id/usb-FTDI:1.0-port0?baud=38400&frame=8E1&rs485=1");
  EXPECT_EQ(serial.target, "/dev/serial/by-id/usb-FTDI:1.0-port0");
  EXPECT_EQ(serial.option("frame", ""), "8E1");
}

TEST(EndpointName, ValuesMayHoldEqualSigns) {
  EXPECT_EQ(parsed("emulator:x?p2p=a=b").option("p2p", ""), "a=b");
}

TEST(EndpointName, ACommandKeepsItsOwnQuestionMarks) {
  EXPECT_EQ(parsed("exec:./plc --tty {tty}").target, "./plc --tty {tty}");
  EXPECT_EQ(parsed("exec:./plc a?b & wait").target, "./plc a?b & wait");
  EXPECT_EQ(parsed("exec:curl 'http://x/?a=1&b=2'").target, "curl 'http://x/?a=1&b=2'");
  EXPECT_EQ(parsed("exec:./plc?station").target, "./plc?station");
  EXPECT_EQ(parsed("exec:ls file?").target, "ls file?");
  // One foreign key, and the whole is the command.
  EXPECT_EQ(parsed("exec:./plc?station=2&colour=red").target, "./plc?station=2&colour=red");
}

TEST(EndpointName, ACommandMayBeFollowedByKnownOptions) {
  const EndpointName name =
      parsed("exec:./plc 'http://x/?a=1&b=2' > log?station=2&protocol=xgt-cnet");
  EXPECT_EQ(name.target, "./plc 'http://x/?a=1&b=2' > log");
  EXPECT_THAT(name.options,
              UnorderedElementsAre(Pair("station", "2"), Pair("protocol", "xgt-cnet")));
}

TEST(EndpointName, AnUnknownKindGetsASuggestion) {
  EXPECT_EQ(refusal("emulater:xbc-h"),
            "cannot read endpoint 'emulater:xbc-h': unknown kind 'emulater'; "
            "the kinds are emulator, pty, serial, exec, tcp, udp, listen, rfc2217; did you mean "
            "'emulator'?");
  EXPECT_THAT(refusal("/dev/ttyUSB0"), HasSubstr("unknown kind '/dev/ttyUSB0'; the kinds are"));
  EXPECT_THAT(refusal(""), HasSubstr("unknown kind ''"));
}

TEST(EndpointName, AnUnknownOptionGetsASuggestion) {
  EXPECT_THAT(refusal("serial:/dev/ttyUSB0?buad=9600"),
              HasSubstr("unknown option 'buad'; the options of serial are protocol, station, "
                        "floor_ms, baud, frame, rs485, echo; did you mean 'baud'?"));
  EXPECT_THAT(refusal("tcp:plc:2004?baud=9600"),
              HasSubstr("unknown option 'baud'; the options of tcp are"));
}

TEST(EndpointName, DamagedOptionsAreRefused) {
  EXPECT_THAT(refusal("emulator:x?station"),
              HasSubstr("option 'station' has no value; write KEY=VALUE"));
  EXPECT_THAT(refusal("emulator:x?=1"), HasSubstr("option '=1' has no value"));
  EXPECT_THAT(refusal("emulator:x?station=1&station=2"),
              HasSubstr("option 'station' is given twice"));
}

TEST(EndpointName, AMissingTargetIsRefused) {
  EXPECT_THAT(refusal("serial:"),
              HasSubstr("nothing stands behind the colon; write serial:/dev/ttyUSB0"));
  EXPECT_THAT(refusal("exec"), HasSubstr("write exec:COMMAND"));
  EXPECT_THAT(refusal("tcp:?station=1"), HasSubstr("write tcp:HOST:PORT"));
}

TEST(Endpoint, OpeningAnUnknownKindNamesTheKinds) {
  const auto endpoint = open_endpoint({.kind = "serail", .target = "/dev/ttyUSB0", .options = {}},
                                      harness::TestProtocol());
  ASSERT_FALSE(endpoint);
  EXPECT_THAT(endpoint.error().message, HasSubstr("cannot open an endpoint: unknown kind 'serail'; "
                                                  "the kinds are emulator, pty, serial, exec, tcp, "
                                                  "udp, listen, rfc2217; did you mean 'serial'?"));
}

class Plain : public Endpoint {
 public:
  const Capabilities& capabilities() const override { return capabilities_; }
  std::string describe() const override { return "serial:/dev/ttyUSB0"; }
  Time now() const override { return {}; }
  Duration character_time() const override { return {}; }
  Status begin(const nlohmann::json&) override { return ok(); }
  using endpoints::Endpoint::send;
  Result<Sent> send(ByteView, LinkId) override { return Sent{}; }
  Result<Burst> receive(Time) override { return Burst{}; }

 private:
  Capabilities capabilities_;
};

TEST(Endpoint, WithoutABackDoorMemoryIsOutOfReach) {
  Plain plain;
  EXPECT_EQ(plain.set("%MW100", "0000").error().message,
            "cannot set %MW100: serial:/dev/ttyUSB0 has no back door");
  EXPECT_EQ(plain.get("%MW100", 4).error().message,
            "cannot look at %MW100: serial:/dev/ttyUSB0 has no back door");
  EXPECT_THAT(plain.act("stop").error().message, HasSubstr("cannot do stop: serial:/dev/ttyUSB0"));
  EXPECT_EQ(plain.line_errors(), "");
}

}  // namespace
}  // namespace fieldproof::endpoints
