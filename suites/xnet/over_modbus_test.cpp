#include "suites/xnet/over_modbus.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "suites/xnet/axes.hpp"

namespace fieldproof::xnet_suite {
namespace {

using harness::Protocol;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> read(std::string_view address, std::size_t digits) {
  std::vector<std::string> hex;
  const std::vector<Bytes> requests = *over_modbus_rtu().read_requests(1, address, digits);
  for (const Bytes& one : requests)
    hex.push_back(to_hex(ByteView(one).first(one.size() - 2)));  // but for the CRC
  return hex;
}

/// Data addresses of the XD/XL manual, 6-2-3.
TEST(XnetOverModbus, ObjectsAreAskedForWhereModbusHasThem) {
  EXPECT_THAT(read("D100", 8), ElementsAre("01 03 00 64 00 02"));
  EXPECT_THAT(read("SD161", 4), ElementsAre("01 03 70 A1 00 01"));
  EXPECT_THAT(read("Y10", 4), ElementsAre("01 01 60 08 00 02"));
  EXPECT_THAT(read("D0", 4 * 40), ElementsAre("01 03 00 00 00 20", "01 03 00 20 00 08"));
}

TEST(XnetOverModbus, CoilsHaveTwoDigitsEach) {
  const Protocol& protocol = over_modbus_tcp();
  const Bytes write = protocol
                          .write_requests(1, "M7",
                                          "0100010000000000"
                                          "0001")
                          ->front();
  EXPECT_EQ(to_hex(ByteView(write).subspan(7)), "0F 00 07 00 0A 02 05 02");
  const Bytes reply = *from_hex(
      "00000000000501010205"
      "02");
  EXPECT_EQ(protocol.read_reply(reply)->substr(0, 20), "01000100000000000001");
}

TEST(XnetOverModbus, WhatModbusDoesNotShowIsSaid) {
  const auto why = [](std::string_view address, std::size_t digits) {
    const auto requests = over_modbus_rtu().read_requests(1, address, digits);
    return requests ? "" : requests.error().message;
  };
  EXPECT_THAT(why("D20480", 4), HasSubstr("Modbus shows D0 to D20479"));
  EXPECT_THAT(why("ID0", 4), HasSubstr("Modbus does not show ID"));
  EXPECT_THAT(why("X8", 2), HasSubstr("no such object"));
  EXPECT_THAT(why("Y77", 4), HasSubstr("past the end"));
  EXPECT_THAT(why("@turns", 4), HasSubstr("model alone"));
}

TEST(XnetOverModbus, WhatIsWrittenCanBeSavedAndPutBack) {
  const Protocol& protocol = over_modbus_rtu();
  const Bytes write = protocol.write_requests(1, "Y10", "0101")->front();
  const std::vector<Protocol::Written> written = protocol.written_by(write);
  ASSERT_EQ(written.size(), 1u);
  EXPECT_EQ(written[0].area, "Y");
  EXPECT_EQ(protocol.spell("Y", written[0].last_word), "Y11");
  const std::vector<Protocol::Place> places = protocol.places(written[0]);
  ASSERT_EQ(places.size(), 1u);
  EXPECT_EQ(places[0].address, "Y10");
  EXPECT_EQ(places[0].digits, 4u);
  EXPECT_EQ(protocol.read_word("Y10")->word, 8u);
}

TEST(XnetOverModbus, WhatMovesAnAxisIsTold) {
  EXPECT_EQ(axis_of_action("MOTO 1 2 3 axis 4"), "4");
  EXPECT_EQ(axis_of_action("hold MOSYN 0.5 master 1 slave 2"), "2");
  EXPECT_EQ(axis_of_action("REG_READ net 1 station 2 D0 count 1 to D1"), "");
  EXPECT_EQ(axis_of_action("B: MOTO 1 2 3 axis 4"), "B:4");
  EXPECT_EQ(at_rest("B:2").front().first, "B:SD2068");
  const Protocol& protocol = over_modbus_rtu();
  EXPECT_EQ(protocol.moved_by("SM2010"), "1");
  EXPECT_EQ(protocol.moved_by("SM2031"), "2") << "jogging";
  EXPECT_EQ(protocol.moved_by("SD2090"), "2") << "its target";
  EXPECT_EQ(protocol.moved_by("SM1999"), "");
  EXPECT_EQ(protocol.moved_by("SM2400"), "");
  EXPECT_EQ(protocol.moved_by("D0"), "");
}

std::vector<bool> passing(const std::vector<Protocol::Look>& looks) {
  return over_modbus_rtu().of_a_moment(looks);
}

TEST(XnetOverModbus, AnAxisUnderWayIsNotLookedAtFromAfar) {
  EXPECT_THAT(passing({{{"SM2001", "01"}}}), ElementsAre(true));
  EXPECT_THAT(passing({{{"B:SM2021", "01"}}}), ElementsAre(true)) << "axis 2 of a partner";
  EXPECT_THAT(passing({{{"SD2072", "00010000"}}}), ElementsAre(true)) << "a speed";
  EXPECT_THAT(passing({{{"SD2008", ""}}}), ElementsAre(true)) << "a range";
  EXPECT_THAT(passing({{{"SD2008", "00140000"}, {"SM2001", "00"}}}), ElementsAre(false));
  EXPECT_THAT(passing({{{"SD2008", ""}, {"SM2001", "00"}}}), ElementsAre(false)) << "it stands";
  EXPECT_THAT(passing({{{"SD2008", ""}, {"SM2021", "00"}}}), ElementsAre(true)) << "another stands";
  EXPECT_THAT(passing({{{"D0", "0001"}}, {{"D0", "0002"}}}), ElementsAre(false, false));
}

TEST(XnetOverModbus, OnTheWayToTheLastLookAnAxisMayBeAnywhere) {
  EXPECT_THAT(passing({{{"SD2008", "000A0000"}}, {{"SD2008", "00140000"}}}),
              ElementsAre(true, false));
  EXPECT_THAT(passing({{{"SD2008", "000A0000"}}, {{"SM2001", "01"}}, {{"SD2010", "00000000"}}}),
              ElementsAre(true, true, false));
  EXPECT_THAT(passing({{{"SM2001", "00"}}, {{"SM2001", "01"}}}), ElementsAre(true, true));
  EXPECT_THAT(passing({{{"SM2001", "00"}, {"SD2008", "00000000"}}, {{"SD2020", ""}}}),
              ElementsAre(false, true))
      << "the first says that it stands";
}

}  // namespace
}  // namespace fieldproof::xnet_suite
