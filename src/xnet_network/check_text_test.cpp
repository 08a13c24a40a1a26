#include "src/xnet_network/check_text.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace fieldproof::xnet {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::string wrong(const Status& status) { return status ? "" : status.error().message; }

const json two{{"stations", {{{"model", "xd5"}}}}};

TEST(CheckText, AddressesAreThoseOfTheModel) {
  const TextCheck check("xd3", two);
  EXPECT_EQ(wrong(check.address("D7999", 4)), "");
  EXPECT_EQ(wrong(check.address("B:D8000", 4)), "");
  EXPECT_EQ(wrong(check.address("@turns", 6)), "");
  EXPECT_THAT(wrong(check.address("D8000", 4)), HasSubstr("no such component"));
  EXPECT_THAT(wrong(check.address("D7999", 8)), HasSubstr("ends at D7999"));
  EXPECT_THAT(wrong(check.address("ZZ0", 4)), HasSubstr("get ZZ0"));
  EXPECT_THAT(wrong(check.address("X18", 2)), HasSubstr("in octal"));
  EXPECT_THAT(wrong(check.address("C:D0", 4)), HasSubstr("no such PLC"));
}

TEST(CheckText, ActionsAreThoseOfTheModel) {
  const TextCheck check("xdc", two);
  for (const char* good : {"run", "B: off", "noise on",
                           "hold REG_READ net 1 station 2 D0 count 1 "
                           "to D0",
                           "MOTO 1 2 3 axis 20", "servo 1 push 500", "release"})
    EXPECT_EQ(wrong(check.action(good)), "") << good;
  EXPECT_THAT(wrong(check.action("MOTO 1 2 3 axis 21")), HasSubstr("axes are 1 to 20"));
  EXPECT_THAT(wrong(check.action("B: MOTO 1 2 3 axis 1")), HasSubstr("xd5 has no motion bus"));
  EXPECT_THAT(wrong(check.action("REG_READ net 1 station 2 ZZ0 count 1 to D0")),
              HasSubstr("there is no object 'ZZ0'"));
  EXPECT_THAT(wrong(check.action("BIT_READ net 1 station 2 X8 count 1 to M0")), HasSubstr("'X8'"));
  EXPECT_THAT(wrong(check.action("servo 21 alarm")), HasSubstr("no such servo"));
  EXPECT_THAT(wrong(check.action("servo 1 dance")), HasSubstr("a servo can"));
  EXPECT_THAT(wrong(check.action("jump")), HasSubstr("cannot do 'jump'"));
}

/// For whoever makes the PLCs to tell.
TEST(CheckText, WithoutAModelNothingIsWrong) {
  EXPECT_EQ(wrong(TextCheck("xd9", json::object()).address("ZZ0", 4)), "");
}

}  // namespace
}  // namespace fieldproof::xnet
