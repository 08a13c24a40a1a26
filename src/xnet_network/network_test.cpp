#include "src/xnet_network/network.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace fieldproof::xnet {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class XnetTest : public testing::Test {
 protected:
  void make(const std::string& model, const json& config) {
    auto made = make_xnet(model, config);
    ASSERT_TRUE(made) << made.error().message;
    plc = std::move(*made);
  }
  void two(const json& more = json::object()) {
    json config{{"ports", {{{"port", 2}, {"net", 1}, {"station", 1}}}},
                {"stations", {{{"ports", {{{"port", 2}, {"net", 1}, {"station", 2}}}}}}}};
    config.update(more);
    make("xd3", config);
  }
  void wait(Duration time) {
    const Time end = now + time;
    while (plc->line()->wake_at() && *plc->line()->wake_at() <= end) {
      now = *plc->line()->wake_at();
      plc->line()->advance(now);
    }
    now = end;
  }
  void act(std::string_view what) {
    const Status done = plc->act(what);
    EXPECT_TRUE(done) << done.error().message;
  }
  std::string get(std::string_view name, std::size_t digits = 0) { return *plc->get(name, digits); }

  std::unique_ptr<plc::EmulatedDevice> plc;
  Time now{};
};

TEST_F(XnetTest, ReadsAndWritesRegistersAndCoils) {
  two();
  ASSERT_TRUE(plc->set("B:D0", "112233445566"));
  ASSERT_TRUE(plc->set("M0", "010001"));
  act("REG_READ net 1 station 2 D0 count 3 to D10");
  act("BIT_WRITE net 1 station 2 Y0 count 3 from M0");
  wait(50ms);
  EXPECT_EQ(get("D10", 16), "1122334455660000");
  EXPECT_EQ(get("B:Y0", 8), "01000100");
  EXPECT_EQ(get("SD161"), "0000");
}

TEST_F(XnetTest, TraceTellsHowAxesMovedAndWhoHadTheToken) {
  make("xdc", {{"ports", {{{"port", 2}, {"net", 1}, {"station", 1}}}},
               {"stations", {{{"model", "xdc"}, {"ports", {{{"port", 2}, {"station", 2}}}}}}}});
  wait(20ms);
  EXPECT_TRUE(plc->trace().axes.empty()) << "nothing moved";
  ASSERT_TRUE(plc->set("B:SM2010", "01"));
  ASSERT_TRUE(plc->set("B:SFD3016", "0FA00000"));  // 4000, the low word first
  wait(20ms);
  act("B: MOTO 5000 5000 50 axis 1");
  act("B: MOTO 3000 5000 50 axis 1");
  wait(2s);
  const Trace trace = plc->trace();
  ASSERT_EQ(trace.axes.size(), 1u);
  const AxisTrace& axis = trace.axes[0];
  EXPECT_EQ(axis.axis, "B:1");
  EXPECT_EQ(axis.samples.front().position, 0);
  EXPECT_EQ(axis.samples.back().position, 3000);
  EXPECT_EQ(std::ranges::max(axis.samples, {}, &AxisTrace::Sample::speed).speed, 5000);
  ASSERT_EQ(axis.limits.size(), 1u);
  EXPECT_EQ(axis.limits[0].name, "max position limit");
  EXPECT_EQ(axis.limits[0].to, 4000);
  std::string told;
  for (const AxisTrace::Event& event : axis.events) told += event.what + "; ";
  EXPECT_EQ(told, "enabled; MOTO 5000 5000 50; error 20020; MOTO 3000 5000 50; completed; ");
  ASSERT_EQ(trace.nets.size(), 1u);
  EXPECT_EQ(trace.nets[0].net, 1u);
  EXPECT_EQ(trace.nets[0].turns.at(0).station + trace.nets[0].turns.at(1).station, 3u);
}

TEST_F(XnetTest, ResultsOfWhatCannotBe) {
  two();
  act("REG_READ net 1 station 3 D0 count 1 to D10");
  wait(150ms);
  EXPECT_EQ(get("SD161"), "0001") << "there is no station 3";
  act("REG_READ net 1 station 2 type 128 address 7999 count 2 to D10");
  wait(50ms);
  EXPECT_EQ(get("SD161"), "0002") << "past the end";
  act("noise on");
  act("REG_READ net 1 station 2 D0 count 1 to D10");
  wait(50ms);
  EXPECT_EQ(get("SD161"), "0003");
  act("REG_READ net 7 station 2 D0 count 1 to D10");
  wait(150ms);
  EXPECT_EQ(get("SD161"), "0001") << "no route";
}

TEST_F(XnetTest, AStationThatIsOffIsPassedOver) {
  two();
  wait(100ms);
  EXPECT_EQ(get("SM1401"), "01");
  EXPECT_EQ(get("@turns", 8).find("01020102") == 0 || get("@turns", 8) == "02010201", true);
  act("B: off");
  wait(100ms);
  EXPECT_EQ(get("SM1401"), "00");
  EXPECT_EQ(get("@turns", 8), "01010101");
}

TEST_F(XnetTest, AGatewayForwards) {
  make(
      "xd5",
      {{"ports", {{{"port", 2}, {"net", 1}, {"station", 1}}}},
       {"routes", {{{"net", 1}, {"port", 2}}, {{"net", 2}, {"port", 2}, {"gateway", 2}}}},
       {"stations",
        {{{"model", "xd5"},
          {"ports",
           {{{"port", 2}, {"net", 1}, {"station", 2}}, {{"port", 4}, {"net", 2}, {"station", 1}}}}},
         {{"model", "xd5"}, {"ports", {{{"port", 2}, {"net", 2}, {"station", 5}}}}}}}});
  ASSERT_TRUE(plc->set("C:D7", "BEEF"));
  act("REG_READ net 2 station 5 D7 count 1 to D0");
  wait(100ms);
  EXPECT_EQ(get("D0"), "BEEF");
}

TEST_F(XnetTest, AGatewayThatLosesItsPowerIsOvertime) {
  make("xd5", {{"ports", {{{"port", 2}, {"net", 1}, {"station", 1}}}},
               {"routes", {{{"net", 2}, {"port", 2}, {"gateway", 2}}}},
               {"stations",
                {{{"model", "xd5"},
                  {"ports",
                   {{{"port", 2}, {"net", 1}, {"station", 2}},
                    {{"port", 4}, {"net", 2}, {"station", 1}, {"cycle_ms", 1000}}}}},
                 {{"model", "xd5"},
                  {"ports", {{{"port", 2}, {"net", 2}, {"station", 5}, {"cycle_ms", 1000}}}}}}}});
  wait(510ms);  // station 5 has the token of net 2
  ASSERT_TRUE(plc->set("SD161", "0009"));
  act("REG_READ net 2 station 5 D7 count 1 to D0");
  wait(50ms);
  act("B: off");
  wait(150ms);
  EXPECT_EQ(get("SD161"), "0001");
}

TEST_F(XnetTest, WhatIsUnderWayWhenThePowerGoesIsGivenUp) {
  two();
  act("REG_READ net 7 station 2 D0 count 1 to D10");  // no route: overtime in 100 ms
  act("REG_WRITE net 1 station 2 D0 count 120 from D0");
  ASSERT_TRUE(plc->set("D0", "1234"));
  act("off");
  wait(1ms);
  act("on");
  ASSERT_TRUE(plc->set("SD161", "0009"));
  wait(200ms);
  EXPECT_EQ(get("SD161"), "0009");
  EXPECT_EQ(get("B:D0"), "0000");
  act("REG_READ net 1 station 2 D0 count 1 to D10");
  wait(50ms);
  EXPECT_EQ(get("SD161"), "0000");
}

TEST_F(XnetTest, EthernetCountsAndHolds) {
  make("xde", {{"ip", "192.168.6.10"}, {"stations", {{{"model", "xde"}, {"ip", "192.168.6.11"}}}}});
  EXPECT_EQ(get("SD1905"), "C0A8");
  EXPECT_EQ(get("SD1906"), "060A");
  act("hold REG_WRITE net H0C0A8 station H060B D0 count 10 from D0");
  wait(20ms);
  act("release");
  wait(10ms);
  EXPECT_EQ(get("SD194"), "000B");  // ten in 20 ms, and the one under way when it was released
  EXPECT_EQ(get("SD196"), "0000");
}

TEST_F(XnetTest, WhatIsWrongIsNamed) {
  const auto error = [](const json& config, const char* model = "xd3") {
    const auto made = make_xnet(model, config);
    return made ? std::string("made") : made.error().message;
  };
  EXPECT_THAT(error({{"ports", {{{"station", 33}}}}}), HasSubstr("stations of TBN are 1 to 32"));
  EXPECT_THAT(error({{"prots", 1}}), HasSubstr("ports"));
  EXPECT_THAT(error({{"ip", "192.168.6.1"}}), HasSubstr("no Ethernet"));
  EXPECT_THAT(error({{"ports", {{{"net", 1}}}}, {"routes", {{{"net", 2}, {"port", 2}}}}}),
              HasSubstr("has no gateway"));
  EXPECT_THAT(
      error({{"ports", {{{"station", 1}}}}, {"stations", {{{"ports", {{{"station", 1}}}}}}}}),
      HasSubstr("A port 2 and B port 2 are both station 1"));
  two();
  EXPECT_THAT(plc->act("REG_READ net 1 station 2 X8 count 1 to D0").error().message,
              HasSubstr("no object 'X8'"));
  EXPECT_THAT(plc->act("REG_READ net 1 station 2 D0 count 1 to M0").error().message,
              HasSubstr("is a coil"));
  EXPECT_THAT(plc->act("MOTO 1 2 3 axis 1").error().message, HasSubstr("no motion bus"));
  EXPECT_THAT(plc->get("C:D0", 0).error().message, HasSubstr("no such PLC"));
}

TEST_F(XnetTest, AProgramRunsAtTheEdgeOfItsRelay) {
  two({{"program",
        {{"M100", "REG_READ net 1 station 2 D0 count 1 to D10"},
         {"M101", "hold BIT_WRITE net 1 station 2 Y0 count 1 from M0"}}}});
  ASSERT_TRUE(plc->set("B:D0", "1234"));
  ASSERT_TRUE(plc->set("M100", "01"));
  wait(50ms);
  EXPECT_EQ(get("D10"), "1234");
  ASSERT_TRUE(plc->set("B:D0", "5678"));
  wait(50ms);
  EXPECT_EQ(get("D10"), "1234") << "the relay stays on: no edge";
  ASSERT_TRUE(plc->set("M100", "00"));
  wait(5ms);
  ASSERT_TRUE(plc->set("M100", "01"));
  wait(50ms);
  EXPECT_EQ(get("D10"), "5678");
}

TEST_F(XnetTest, WrongProgramsAreNamed) {
  const auto wrong = [](const json& program) {
    auto made = make_xnet("xd3", {{"program", program}});
    return made ? "" : made.error().message;
  };
  EXPECT_THAT(wrong({{"D0", "REG_READ net 1 station 2 D0 count 1 to D10"}}),
              HasSubstr("no relay 'D0'"));
  EXPECT_THAT(wrong({{"M0", "MOVE"}}), HasSubstr("'MOVE' at M0 is no instruction"));
  EXPECT_THAT(wrong({{"M0", "REG_READ net 1"}}), HasSubstr("program: cannot execute"));
  EXPECT_THAT(wrong("M0"), HasSubstr("no object"));
  EXPECT_THAT(wrong({{"M0", "MOTO 1 2 3 axis 1"}}), HasSubstr("xd3 has no motion bus"));
  const auto wrong_motion = [](const char* text) {
    auto made = make_xnet("xdc", {{"program", {{"M0", text}}}});
    return made ? "" : made.error().message;
  };
  EXPECT_THAT(wrong_motion("MOTO 1 2 3 axis 21"), HasSubstr("the axis '21'; axes are 1 to 20"));
  EXPECT_THAT(wrong_motion("MOTO 1 2 axis 1"), HasSubstr("'axis' is no number"));
  EXPECT_EQ(wrong_motion("MOTO 1 2 3 axis 20"), "");
}

TEST(XnetConfiguration, AMotionBusHasTwentyServos) {
  for (const json& count : {json(21u), json(4'000'000'000u), json(4'294'967'297u)}) {
    const auto made = make_xnet("xdc", {{"servos", count}});
    ASSERT_FALSE(made) << count;
    EXPECT_THAT(made.error().message, HasSubstr("a motion bus has up to 20"));
  }
  EXPECT_TRUE(make_xnet("xdc", {{"servos", 20u}}));
}

/// Of the same series, an XDM has 10000 more.
TEST_F(XnetTest, AModelHasItsOwnRegisters) {
  make("xd5", json::object());
  EXPECT_TRUE(plc->set("D59999", "1234"));
  EXPECT_FALSE(plc->set("D60000", "1234"));
  EXPECT_FALSE(plc->set("D59999", "12345678"));
  EXPECT_FALSE(plc->get("D60000", 4));
  EXPECT_FALSE(plc->act("REG_READ net 1 station 2 D0 count 1 to D60000"));
  make("xdm", json::object());
  EXPECT_TRUE(plc->set("D60000", "1234"));
}

TEST_F(XnetTest, ARatioInARegisterIsANumber) {
  make("xdc", json::object());
  ASSERT_TRUE(plc->set("SM2010", "01"));
  ASSERT_TRUE(plc->set("SM2030", "01"));
  ASSERT_TRUE(plc->set("D0", "00007FC0"));  // NaN
  wait(20ms);
  act("MOSYN D0 master 1 slave 2");
  wait(20ms);
  EXPECT_EQ(get("SM2029"), "00");
  EXPECT_EQ(get("SD2062"), "4E3F") << "20031";
  EXPECT_FALSE(plc->act("MOSYN nan master 1 slave 2"));
}

/// Two models that are told each other's lines, as two processes are.
class JoinedTest : public testing::Test {
 protected:
  static std::unique_ptr<plc::EmulatedDevice> station(int number,
                                                      const json& more = json::object()) {
    json config{{"ports", {{{"port", 2}, {"net", 1}, {"station", number}}}}};
    config.update(more);
    auto made = make_xnet("xd3", config);
    EXPECT_TRUE(made) << made.error().message;
    return std::move(*made);
  }
  void join() {
    EXPECT_TRUE(a->bus_end()->hear(b->bus_end()->hello()));
    EXPECT_TRUE(b->bus_end()->hear(a->bus_end()->hello()));
  }
  static void carry(plc::EmulatedDevice& from, plc::EmulatedDevice& to, bool carried) {
    for (const std::string& line : from.bus_end()->take_lines())
      EXPECT_TRUE(!carried || to.bus_end()->hear(line)) << line;
  }
  void wait(Duration time, bool carried = true) {
    for (const Time end = now + time; now < end; now += 1ms) {
      a->line()->advance(now);
      b->line()->advance(now);
      carry(*a, *b, carried);
      carry(*b, *a, carried);
    }
  }
  std::unique_ptr<plc::EmulatedDevice> a = station(1), b = station(2);
  Time now{};
};

TEST_F(JoinedTest, EachReachesTheMemoryOfTheOther) {
  join();
  EXPECT_EQ(*a->get("SM1401", 2), "01") << "its relay of presence";
  ASSERT_TRUE(b->set("D0", "11223344"));
  ASSERT_TRUE(b->set("M5", "0101"));
  ASSERT_TRUE(a->act("REG_READ net 1 station 2 D0 count 2 to D10"));
  ASSERT_TRUE(a->act("BIT_WRITE net 1 station 2 Y0 count 2 from SM0"));
  ASSERT_TRUE(b->act("BIT_WRITE net 1 station 1 Y0 count 2 from M5"));
  wait(60ms);
  EXPECT_EQ(*a->get("D10", 8), "11223344");
  EXPECT_EQ(*a->get("Y0", 4), "0101");
  EXPECT_EQ(*a->get("SD161", 4), "0000");
  ASSERT_TRUE(a->act("REG_READ net 1 station 2 D7999 count 2 to D10"));
  wait(60ms);
  EXPECT_EQ(*a->get("SD161", 4), "0002") << "past the end of B's D";
}

TEST_F(JoinedTest, WhoDoesNotAnswerIsOvertime) {
  join();
  ASSERT_TRUE(a->act("REG_READ net 1 station 2 D0 count 2 to D10"));
  wait(150ms, false);
  EXPECT_EQ(*a->get("SD161", 4), "0001");
  a->bus_end()->part();
  EXPECT_EQ(*a->get("SM1401", 2), "00");
}

TEST_F(JoinedTest, StationsThatClashDoNotJoin) {
  b = station(1);
  const Status heard = a->bus_end()->hear(b->bus_end()->hello());
  ASSERT_FALSE(heard);
  EXPECT_THAT(heard.error().message, HasSubstr("station 1"));
  EXPECT_FALSE(a->bus_end()->hear("noise"));
  EXPECT_TRUE(a->bus_end()->hear(R"({"answer": 7, "values": "x"})"));
  EXPECT_TRUE(a->bus_end()->hear(R"({"ask": 7, "count": 3})"));
}

}  // namespace
}  // namespace fieldproof::xnet
