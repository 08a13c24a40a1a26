#include "src/plc/config_reader.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace fieldproof::plc {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// What becomes of the value of a key that is a host; the message where it is none.
std::string host(const json& value) {
  const json object{{"partner", value}};
  ConfigReader reader(object, "p2p");
  std::string to;
  reader.host("partner", to);
  return reader.error() ? reader.error()->message : to;
}

TEST(ConfigReader, AHostIsAnAddressOrAName) {
  for (const char* good : {"127.0.0.1", "255.255.255.255", "localhost", "plc-7.plant.example"})
    EXPECT_EQ(host(good), good);
  for (const char* bad : {"127.0.0.300", "300.1.1.1", "1.2.3", "1.2.3.4.5", "010.0.0.1", "",
                          "plc 7", "127.0.0.1:2004", "http://plc", "7"})
    EXPECT_THAT(host(bad), HasSubstr("cannot read p2p: partner is ")) << bad;
  EXPECT_THAT(host(7), HasSubstr("which is not an IPv4 address such as \"192.0.2.1\""));
}

TEST(ConfigReader, ANumberHasALeastOne) {
  const json object{{"slot", 0}};
  ConfigReader reader(object, "it");
  unsigned slot = 5;
  reader.whole("slot", 15, slot, 1);
  ASSERT_TRUE(reader.error());
  EXPECT_EQ(reader.error()->message,
            "cannot read it: slot is 0, which is not a number from 1 to 15");
  EXPECT_EQ(slot, 5u);
}

}  // namespace
}  // namespace fieldproof::plc
