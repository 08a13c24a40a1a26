#include "suites/xnet/ladder.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace fieldproof::xnet_suite {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

const json stations = json::parse(
    R"([{"ports": [{"net": 1, "station": 2}, {"port": 3, "net": 49320, "station": 2}]}])");
const json program{
    {"M100", "REG_READ net 1 station 2 D0 count 10 to D10"},
    {"M101", "REG_WRITE net D6900 station D6901 type D6902 address D6904 count D6906 from D0"},
    {"M102", "hold BIT_READ net 1 station 2 M0 count 1 to M10"},
    {"M103", "MOTO D20 D22 D24 axis 1"},
    {"M104", "MOSYN D30 master 1 slave 2"}};

Ladder ladder(const json& config = {{"program", program}, {"stations", stations}}) {
  const Result<Ladder> read = Ladder::read(config);
  EXPECT_TRUE(read) << read.error().message;
  return read ? *read : Ladder();
}

TEST(Ladder, AnInstructionIsAnEdgeOfItsRelay) {
  const auto edge = ElementsAre(Pair("M100", "00"), Pair("M100", "01"));
  EXPECT_THAT(*ladder().set_off("REG_READ net 1 station 2 D0 count 10 to D10"), edge);
  EXPECT_THAT(*ladder().set_off("REG_READ net K1 station K2 type 128 address 0 count 10 to D10"),
              edge)
      << "the same, as the manual writes it elsewhere";
  EXPECT_FALSE(ladder().set_off("REG_READ net 1 station 2 D0 count 9 to D10"));
  EXPECT_FALSE(ladder().set_off("REG_READ net 1 station 2 D1 count 10 to D10"));
}

TEST(Ladder, OperandsInRegistersAreSetBefore) {
  EXPECT_THAT(*ladder().set_off("REG_WRITE net H0C0A8 station 2 HD3 count 7 from D0"),
              ElementsAre(Pair("D6900", "C0A8"), Pair("D6901", "0002"), Pair("D6902", "0088"),
                          Pair("D6904", "00030000"), Pair("D6906", "0007"), Pair("M101", "00"),
                          Pair("M101", "01")));
  EXPECT_THAT(*ladder().set_off("MOTO -2 70000 50 axis 1"),
              ElementsAre(Pair("D20", "FFFEFFFF"), Pair("D22", "11700001"), Pair("D24", "00320000"),
                          Pair("M103", "00"), Pair("M103", "01")));
  EXPECT_THAT(*ladder().set_off("MOSYN 0.5 master 1 slave 2"),
              testing::Contains(Pair("D30", "00003F00")));
}

TEST(Ladder, AConditionThatStaysOnIsReleased) {
  EXPECT_TRUE(ladder().set_off("hold BIT_READ net 1 station 2 M0 count 1 to M10"));
  EXPECT_FALSE(ladder().set_off("BIT_READ net 1 station 2 M0 count 1 to M10"));
  EXPECT_THAT(*ladder().set_off("release"), ElementsAre(Pair("M102", "00")));
}

TEST(Ladder, APartnerHasItsOwn) {
  const Ladder both = ladder({{"stations", {{{"program", program}}}}});
  EXPECT_THAT(*both.set_off("B: REG_READ net 1 station 2 D0 count 10 to D10"),
              ElementsAre(Pair("B:M100", "00"), Pair("B:M100", "01")));
  EXPECT_FALSE(both.set_off("REG_READ net 1 station 2 D0 count 10 to D10"));
  EXPECT_FALSE(both.set_off("C: REG_READ net 1 station 2 D0 count 10 to D10"));
}

TEST(Ladder, WhatTheProgramLacksIsToldAsItIsWritten) {
  EXPECT_THAT(ladder().set_off("MOTO 1 2 3 axis 7").error().message,
              HasSubstr(R"("program": {"M100": "MOTO 1 2 3 axis 7"})"));
  EXPECT_THAT(ladder().set_off("B: off").error().message, HasSubstr("done to the model alone"));
  EXPECT_THAT(*ladder().set_off("stop"), IsEmpty());
}

TEST(Ladder, WhatAnInstructionWritesIsKnownBefore) {
  json config = json::parse(R"({"ports": [{"net": 1, "station": 1}],
                               "stations": [{"ports": [{"net": 1, "station": 2}]}]})");
  config["program"] = program;
  const Ladder both = ladder(config);
  const auto written = [&](std::string_view action) {
    return both.written_by(action, xnet::Series::xd3);
  };
  EXPECT_THAT(written("REG_READ net 1 station 2 D0 count 2 to D10"),
              ElementsAre(Pair("D10", "00000000")));
  EXPECT_THAT(written("hold BIT_WRITE net 1 station 2 Y7 count 2 from M0"),
              ElementsAre(Pair("B:Y7", "0000")));
  EXPECT_THAT(written("B: REG_WRITE net 1 station 1 D5 count 1 from D0"),
              ElementsAre(Pair("D5", "0000")));
  EXPECT_THAT(written("B: REG_READ net 1 station 1 D5 count 1 to D7"),
              ElementsAre(Pair("B:D7", "0000")));
  EXPECT_THAT(written("REG_WRITE net 1 station 2 D7999 count 9 from D0"),
              ElementsAre(Pair("B:D7999", "0000")))
      << "a PLC may write as far as it goes";
  EXPECT_THAT(written("REG_WRITE net 1 station 7 D0 count 1 from D0"), IsEmpty()) << "nobody";
  EXPECT_THAT(written("REG_READ net 1 station 2 D0 count 0 to D10"), IsEmpty());
  EXPECT_THAT(written("MOTO 1 2 3 axis 1"), IsEmpty());
  EXPECT_THAT(both.set_off("REG_READ net 1 station 2 D0 count D9 to D10").error().message,
              HasSubstr("nobody can tell what it would write"));
}

/// The net and the station of a PLC on Ethernet are those of its address.
TEST(Ladder, APlcOnEthernetIsAStation) {
  const Ladder both = ladder({{"ip", "192.168.6.6"}, {"stations", {{{"ip", "192.168.6.11"}}}}});
  const auto written = [&](std::string_view action) {
    return both.written_by(action, xnet::Series::xd5);
  };
  EXPECT_THAT(written("BIT_WRITE net 49320 station 1547 SM2010 count 1 from M0"),
              ElementsAre(Pair("B:SM2010", "00")));
  EXPECT_THAT(written("B: BIT_WRITE net 49320 station 1542 Y0 count 2 from M0"),
              ElementsAre(Pair("Y0", "0000")));
}

/// Nobody could fence it, nor put it back.
TEST(Ladder, NothingIsWrittenToAPlcThatIsNotDeclared) {
  const Ladder alone = ladder({{"ports", {{{"net", 1}, {"station", 1}}}},
                               {"program",
                                {{"M1", "BIT_WRITE net 1 station 3 Y0 count 8 from M0"},
                                 {"M2", "BIT_READ net 1 station 3 Y0 count 8 to M0"}}}});
  const auto refused = alone.set_off("BIT_WRITE net 1 station 3 Y0 count 8 from M0");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message,
              HasSubstr("writes to station 3 of net 1, which the profile does not name"));
  EXPECT_TRUE(alone.set_off("BIT_READ net 1 station 3 Y0 count 8 to M0"));
}

TEST(Ladder, ARelayMovesWhatItsInstructionMoves) {
  EXPECT_EQ(ladder().axis_behind("M103"), "1");
  EXPECT_EQ(ladder().axis_behind("M104"), "2");
  EXPECT_EQ(ladder().axis_behind("M100"), "");
}

TEST(Ladder, BadProgramsAreNamed) {
  const auto wrong = [](const json& bad) {
    const Result<Ladder> read = Ladder::read({{"program", bad}});
    return read ? "" : read.error().message;
  };
  EXPECT_THAT(wrong("M1"), HasSubstr("no object"));
  EXPECT_THAT(wrong({{"D1", "MOTO 1 2 3 axis 1"}}), HasSubstr("'D1' is no relay"));
  EXPECT_THAT(wrong({{"M1", "MOVE"}}), HasSubstr("no instruction of X-NET"));
  EXPECT_THAT(wrong({{"M1", 7}}), HasSubstr("7 at M1"));
}

}  // namespace
}  // namespace fieldproof::xnet_suite
