#include "src/xnet_motion/axis.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "src/xnet_motion/motion_bus.hpp"

namespace fieldproof::xnet {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::Ge;
using testing::HasSubstr;
using testing::Le;

class MotionTest : public testing::Test {
 protected:
  void make(const json& servos) {
    std::vector<Servo> list;
    for (const json& one : servos) list.push_back(*read_servo(one));
    bus = std::make_unique<MotionBus>(memory, std::move(list));
    run(20ms);
  }
  void enable(unsigned axis = 1) {
    registers(axis).set(reg::enable, 1);
    run(20ms);
  }
  AxisRegisters registers(unsigned axis = 1) { return {memory, axis}; }
  double get(const Register& one, unsigned axis = 1) { return registers(axis).get(one); }
  void act(std::string_view what) {
    const Status done = bus->act(what);
    EXPECT_TRUE(done) << done.error().message;
  }
  void run(Duration time) {
    memory.touch();  // registers are set past the back door
    now += time;
    while (bus->wake_at() <= now) bus->advance(bus->wake_at(), plc_runs);
  }
  /// Until the axis stands, at most 20 s.
  Duration until_it_stands(unsigned axis = 1) {
    const Time from = now;
    while (get(reg::running, axis) != 0 && now - from < 20s) run(3ms);
    return now - from;
  }

  Memory memory;
  std::unique_ptr<MotionBus> bus;
  Time now{};
  bool plc_runs = true;
};

TEST_F(MotionTest, MotoIsRelativeAndMotoaAbsolute) {
  make({{{"start", 2000}}});
  enable();
  EXPECT_EQ(get(reg::speed_setting), 1000);
  EXPECT_EQ(get(reg::status), 2);
  act("MOTO 10000 5000 50 axis 1");
  EXPECT_EQ(get(reg::target), 12000);
  EXPECT_EQ(get(reg::speed_setting), 5000);
  EXPECT_THAT(until_it_stands(), AllOf(Ge(2047ms), Le(2060ms)));
  EXPECT_EQ(get(reg::position), 12000);
  EXPECT_EQ(get(reg::offset), 10000);
  EXPECT_EQ(get(reg::completed), 1);
  act("MOTOA 10000 5000 50 axis 1");
  until_it_stands();
  EXPECT_EQ(get(reg::position), 10000);
  EXPECT_EQ(get(reg::offset), -2000);
  EXPECT_EQ(get(reg::error_flag), 0);
}

TEST_F(MotionTest, ATargetIsChangedOnTheWay) {
  make({{{"axis", 1}}});
  enable();
  act("MOTO 1000 1000 50 axis 1");
  while (get(reg::position) < 600) run(3ms);
  registers().set(reg::target, 400);
  run(16ms);
  EXPECT_LT(get(reg::set_speed), 1000);
  until_it_stands();
  EXPECT_EQ(get(reg::position), 400);
}

TEST_F(MotionTest, ASpeedOfZeroStopsAndTheFlagStays) {
  make({{{"axis", 1}}});
  enable();
  act("MOTO 10000 5000 50 axis 1");
  run(600ms);
  registers().set(reg::speed_setting, 0);
  run(2s);
  EXPECT_EQ(get(reg::running), 1);
  EXPECT_EQ(get(reg::set_speed), 0);
  registers().set(reg::speed_setting, 3000);
  until_it_stands();
  EXPECT_EQ(get(reg::position), 10000);
}

TEST_F(MotionTest, TheSegmentsOfTheExample) {
  make({{{"start", 5000}}});
  enable();
  const std::vector<std::pair<double, double>> rows{
      {10000, 5000}, {26000, 1000}, {-20000, 7500}, {25000, 4000}};
  for (std::uint32_t i = 0; i < rows.size(); ++i) {
    write_number(memory, *find_component("D" + std::to_string(10 * i)), Kind::dword, rows[i].first);
    write_number(memory, *find_component("D" + std::to_string(10 * i + 2)), Kind::dword,
                 rows[i].second);
  }
  ASSERT_TRUE(memory.set("D1000", "00000000000400000032000000320000"));
  act("MOTOS D0 D1000 axis 1");
  EXPECT_EQ(get(reg::target), 15000);
  run(2300ms);
  EXPECT_EQ(get(reg::segment), 2);
  while (get(reg::running) != 0 && now < 60s) run(3ms);
  EXPECT_EQ(get(reg::position), 46000);
  EXPECT_EQ(get(reg::segment), 4);
}

TEST_F(MotionTest, StopsOfAllKindsAndOn) {
  make({{{"axis", 1}}});
  enable();
  act("MOTO 10000 5000 50 axis 1");
  run(1s);
  act("MOSTOP 0 axis 1");
  until_it_stands();
  const double stopped = get(reg::position);
  EXPECT_THAT(stopped, AllOf(Ge(4800), Le(5050)));
  act("MOGOON axis 1");
  until_it_stands();
  EXPECT_EQ(get(reg::position), 10000);
  act("MOTOA 0 5000 50 axis 1");
  run(1s);
  act("MOSTOP K-1 axis 1");
  run(6ms);
  EXPECT_EQ(get(reg::running), 0);
  const double at = get(reg::position);
  act("MOTOA 0 5000 50 axis 1");
  run(300ms);
  act("MOSTOP 1000 axis 1");
  until_it_stands();
  EXPECT_THAT(get(reg::position), AllOf(Ge(at - 2420), Le(at - 2300)));
}

TEST_F(MotionTest, AStopOfSegmentsBrakesInTheTimeThatIsShown) {
  make({{{"axis", 1}}});
  enable();
  ASSERT_TRUE(memory.set("D0", "2710000013880000"));   // 10000 at 5000
  ASSERT_TRUE(memory.set("D10", "4E20000003E80000"));  // 20000 at 1000
  ASSERT_TRUE(memory.set("D1000", "00000000000200000032000000320000"));
  act("MOTOS D0 D1000 axis 1");
  run(1s);
  EXPECT_EQ(get(reg::deceleration), 25000);
  const double at = get(reg::position);
  act("MOSTOP 0 axis 1");
  run(100ms);
  EXPECT_EQ(get(reg::running), 1) << "20000 pulses a second in each second: 250 ms";
  until_it_stands();
  EXPECT_THAT(get(reg::position) - at, AllOf(Ge(620), Le(725)));
}

TEST_F(MotionTest, ASlaveFollowsAtItsRatio) {
  make({{{"axis", 1}}, {{"axis", 4}}});
  enable(1);
  enable(4);
  act("MOSYN 0.5 master 1 slave 4");
  act("MOTO 10000 5000 50 axis 1");
  run(1s);
  EXPECT_EQ(get(reg::running, 4), 1);
  EXPECT_EQ(get(reg::bound, 4), 1);
  until_it_stands(1);
  run(10ms);
  EXPECT_EQ(get(reg::position, 4), 5000);
  act("MOTO 100 5000 50 axis 4");
  EXPECT_EQ(get(reg::error, 4), 20030);
}

TEST_F(MotionTest, WhatIsRefusedSaysWhy) {
  make({{{"axis", 1}}});
  act("MOTO 100 1000 50 axis 1");
  EXPECT_EQ(get(reg::error), 20030) << "not enabled";
  enable();
  act("MOTO 100 500001 50 axis 1");
  EXPECT_EQ(get(reg::error), 20021);
  act("MOTO 100 1000 0 axis 1");
  EXPECT_EQ(get(reg::error), 20023);
  act("MOTOA 1000000001 1000 50 axis 1");
  EXPECT_EQ(get(reg::error), 20020);
  act("MOTO 100 1000 50 axis 1");
  EXPECT_EQ(get(reg::error), 0);
  for (const char* wrong : {"MOTO 1 2 axis 1", "MOTO 1 2 3 axis 0", "MOTO 1 2 3 axis 21",
                            "MOTO X0 2 3 axis 1", "MOTOS 0 D0 axis 1", "MOSYN 1 master a slave 2",
                            "MOTO 1 2 3 axis 1 2", "servo 21 alarm", "servo 1 sing"})
    EXPECT_FALSE(bus->act(wrong)) << wrong;
}

TEST_F(MotionTest, RegistersAtTheEdgeAreRefused) {
  make({{{"axis", 1}}});
  enable();
  EXPECT_FALSE(bus->act("MOTO D69999 1000 50 axis 1")) << "a double word";
  EXPECT_FALSE(bus->act("MOREAD D69999 axis 1"));
  act("MOTOS D0 D69998 axis 1");
  EXPECT_EQ(get(reg::error), 20022) << "the parameters end behind D69999";
  write_number(memory, *find_component("D102"), Kind::dword, 3);
  act("MOTOS D69990 D100 axis 1");
  EXPECT_EQ(get(reg::error), 20022) << "the data do";
  registers().set(reg::loop_counter, -1);
  registers().set(reg::full_loop, 1);
  run(100ms);
  EXPECT_EQ(get(reg::loop_position), 0) << "there is no such counter";
}

TEST_F(MotionTest, NothingIsDividedByZero) {
  make({{{"axis", 1}}});
  enable();
  for (const Register& one : {reg::per_turn, reg::ppr, reg::max_speed, reg::least_acceleration})
    registers().set(one, 0);
  act("MOTO 10 1 50 axis 1");
  write_number(memory, *find_component("D102"), Kind::dword, 1);
  write_number(memory, *find_component("D104"), Kind::dword, 50);
  write_number(memory, *find_component("D106"), Kind::dword, 50);
  run(20s);
  EXPECT_EQ(get(reg::position), 10);
  act("MOTOS D0 D100 axis 1");
  run(1s);
  EXPECT_EQ(get(reg::position), 10);
}

TEST_F(MotionTest, ReleasingAnAxisThatIsNotBoundChangesNothing) {
  make({{{"axis", 1}}});
  enable();
  act("MOTO 1000 1000 50 axis 1");
  run(500ms);
  act("MOUSYN axis 1");
  until_it_stands();
  EXPECT_EQ(get(reg::position), 1000);
}

TEST_F(MotionTest, ErrorsOfTheServo) {
  make({{{"axis", 1}}});
  enable();
  act("servo 1 alarm");
  run(10ms);
  EXPECT_EQ(get(reg::error), 20010);
  EXPECT_EQ(get(reg::enabled), 0);
  registers().set(reg::clear_alarm, 1);
  run(10ms);
  EXPECT_EQ(get(reg::error), 0);
  registers().set(reg::enable, 0);
  run(10ms);
  enable();
  EXPECT_EQ(get(reg::enabled), 1);
  act("servo 1 off");
  run(10ms);
  EXPECT_EQ(get(reg::error), 20011);
  EXPECT_EQ(get(reg::status), 0);
}

TEST_F(MotionTest, HomingForwardWithCloseSignal) {
  make({{{"start", -20000}, {"switches", {{"X6", {-8000, -6000}}, {"X7", {0, 2000}}}}}});
  registers().set(reg::close_terminal, 6);
  registers().set(reg::origin_terminal, 7);
  registers().set(reg::max_speed, 10000);
  registers().set(reg::home_high, 10000);
  registers().set(reg::home_low, 2000);
  registers().set(reg::home_creep, 500);
  registers().set(reg::acceleration, 100);
  registers().set(reg::deceleration, 100);
  enable();
  registers().set(reg::home_forward, 1);
  run(500ms);
  EXPECT_EQ(get(reg::set_speed), 10000);
  run(2500ms);
  EXPECT_EQ(get(reg::set_speed), 2000);
  until_it_stands();
  EXPECT_EQ(get(reg::position), 0);
  EXPECT_EQ(get(reg::error), 0);
  EXPECT_EQ(memory.read(*find_component("X7")), 0);
  const std::vector<AxisTrace> traces = bus->trace(now);
  ASSERT_EQ(traces.size(), 1u);
  std::string told;
  for (const AxisTrace::Event& event : traces[0].events) told += event.what + "; ";
  EXPECT_THAT(told, testing::EndsWith("return to origin, forward; close signal on; close signal "
                                      "off; origin switch on; origin switch off; origin found; "));
  ASSERT_EQ(traces[0].limits.size(), 2u);
  const AxisTrace::Limit& origin = traces[0].limits[1];
  EXPECT_EQ(origin.name, "origin switch");
  EXPECT_EQ(origin.from, 0);
  EXPECT_EQ(origin.to, 2000);
}

}  // namespace
}  // namespace fieldproof::xnet
