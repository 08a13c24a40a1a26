#include "harness/bench/adapter_floor.hpp"

#include <gtest/gtest.h>

namespace fieldproof::bench {
namespace {

AdapterFloor measured(AdapterFloor::Source source) {
  AdapterFloor floor{source, 2ms};
  for (int i = 0; i < 99; ++i) floor.times.add(30);
  floor.times.add(70);
  floor.times.add(25);
  return floor;
}

TEST(AdapterFloor, TheGreatestOfDeclaredAndMeasured) {
  EXPECT_EQ(20ms, timing_floor(20ms, 500ms, std::nullopt));
  EXPECT_EQ(25ms, timing_floor(20ms, 500ms, measured(AdapterFloor::Source::device)));
  EXPECT_EQ(40ms, timing_floor(40ms, 500ms, measured(AdapterFloor::Source::device)));
  EXPECT_EQ(30ms, timing_floor(20ms, 500ms, measured(AdapterFloor::Source::loop)))
      << "the 99th percentile of 101 answers";
}

TEST(AdapterFloor, ByHandBeatsWhatIsDeclared) {
  EXPECT_EQ(2ms, timing_floor(20ms, 500ms, measured(AdapterFloor::Source::by_hand)));
  EXPECT_EQ(2ms, gap_floor(20ms, measured(AdapterFloor::Source::by_hand)));
}

TEST(AdapterFloor, FollowsHowFarAnswersScatter) {
  AdapterFloor floor;
  for (int i = 0; i < 10; ++i) floor.times.add(2), floor.times.add(162);
  EXPECT_EQ(160ms, timing_floor(20ms, 500ms, floor));
  AdapterFloor one_late;
  for (int i = 0; i < 19; ++i) one_late.times.add(2);
  one_late.times.add(162);
  EXPECT_EQ(20ms, timing_floor(20ms, 500ms, one_late)) << "one in twenty says nothing";
}

TEST(AdapterFloor, ASlowDeviceIsNotExcusedFromItsLimit) {
  EXPECT_EQ(10ms, timing_floor(1ms, 10ms, measured(AdapterFloor::Source::device)))
      << "answers of 25 ms are late, not inconclusive";
}

TEST(AdapterFloor, AnswerTimeOfTheDeviceLoosensNoGap) {
  EXPECT_EQ(1ms, gap_floor(1ms, measured(AdapterFloor::Source::device)));
  EXPECT_EQ(30ms, gap_floor(1ms, measured(AdapterFloor::Source::loop)));
}

TEST(AdapterFloor, WhatASerialServerMayHoldIsNamed) {
  const auto answered_after = [](double ms) {
    AdapterFloor floor;
    floor.times.add(ms);
    return floor;
  };
  EXPECT_EQ("", held_by_server(answered_after(0.2), 100us)) << "at once";
  EXPECT_NE("", held_by_server(answered_after(3.3), 100us));
  EXPECT_EQ("", held_by_server(answered_after(3.3), 3ms)) << "the network is as slow";
  EXPECT_EQ("", held_by_server(answered_after(25), 100us)) << "the device is slow by itself";
  EXPECT_EQ("", held_by_server(AdapterFloor{}, 100us)) << "nothing answered";
  EXPECT_EQ("", held_by_server(measured(AdapterFloor::Source::loop), 24ms));
}

TEST(AdapterFloor, InWords) {
  EXPECT_EQ(
      "25.0 ms (101 answers by the device, its own time included: min 25.000, median 30.000, p99 "
      "30.000 ms)",
      to_string(measured(AdapterFloor::Source::device), 25ms));
  EXPECT_EQ("30.0 ms (101 answers over the loop: min 25.000, median 30.000, p99 30.000 ms)",
            to_string(measured(AdapterFloor::Source::loop), 30ms));
  EXPECT_EQ("2.0 ms (given by hand)", to_string(measured(AdapterFloor::Source::by_hand), 2ms));
  EXPECT_EQ("20.0 ms (declared; no probe was answered)", to_string(AdapterFloor{}, 20ms));
}

}  // namespace
}  // namespace fieldproof::bench
