#include "harness/probe/target.hpp"
#include "suites/protocols.hpp"

#include <gtest/gtest.h>

namespace fieldproof::probe {
namespace {

std::string found(const char* endpoint, bool settable = true) {
  const Trial trial{*line::parse_line_settings("38400-7E1"), suites::protocols().find("ls-bus"),
                    12};
  return to_string(name_of_found(*endpoints::parse_endpoint(endpoint), trial, settable));
}

TEST(Target, TheFoundIsAddedToTheEndpoint) {
  EXPECT_EQ(found("serial:/dev/ttyUSB0?rs485=1&baud=9600"),
            "serial:/dev/ttyUSB0?baud=38400&frame=7E1&protocol=ls-bus&rs485=1&station=12");
  EXPECT_EQ(found("serial:/dev/pts/5", false), "serial:/dev/pts/5?protocol=ls-bus&station=12");
  EXPECT_EQ(found("tcp:plc:2000"), "tcp:plc:2000?protocol=ls-bus&station=12");
  EXPECT_EQ(found("emulator:inverter?station=12"), "emulator:inverter?station=12");
}

TEST(Target, AnEmulatorIsSetOnTheBenchsSide) {
  EXPECT_EQ(
      to_string(with_settings(*endpoints::parse_endpoint("emulator:xbc-h?line=9600-8E1"), {})),
      "emulator:xbc-h?bench_line=9600-8N1&line=9600-8E1");
}

TEST(Target, TheNameCanBeReadAgain) {
  const std::string text = found("serial:/dev/ttyUSB0?rs485=1");
  EXPECT_EQ(to_string(*endpoints::parse_endpoint(text)), text);
}

}  // namespace
}  // namespace fieldproof::probe
