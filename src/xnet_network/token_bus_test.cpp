#include "src/xnet_network/token_bus.hpp"

#include <gtest/gtest.h>

namespace fieldproof::xnet {
namespace {

void run(TokenBus& bus, Time from, Time to) {
  if (from == 0ms) bus.advance(from);
  while (bus.wake_at() && *bus.wake_at() <= to) bus.advance(*bus.wake_at());
}

TEST(TokenBus, EachStationHasItOnceInACycleAndAloneAtATime) {
  TokenBus bus(32ms, 1'000'000);
  for (unsigned station = 1; station <= 32; ++station) bus.join(station);
  run(bus, 0ms, 320ms);
  Time end{};
  std::map<unsigned, int> turns;
  for (const TokenTurn& turn : bus.turns()) {
    EXPECT_EQ(turn.from, end) << "one after the other";
    end = turn.to;
    EXPECT_LE(turn.busy, turn.to - turn.from);
    if (turn.from < 320ms) ++turns[turn.station];
  }
  for (unsigned station = 1; station <= 32; ++station) EXPECT_EQ(turns[station], 10) << station;
}

TEST(TokenBus, WhatDoesNotFitGoesOnInTheNextTurn) {
  TokenBus bus(10ms, 1'000'000);
  bus.join(1);
  bus.join(2);
  EXPECT_EQ(bus.time_of(200), 10ms);
  Time done{};
  bus.queue(1, {125, [&](Time at) { done = at; }}, 0ms);
  run(bus, 0ms, 100ms);
  EXPECT_EQ(done, 11250us);  // 6.25 ms: 5 of the first turn, 1.25 of the next
}

TEST(TokenBus, AHolderThatLeavesKeepsItsTurn) {
  TokenBus bus(10ms, 1'000'000);
  bus.join(1);
  bus.join(2);
  run(bus, 0ms, 1ms);
  bus.leave(1);
  run(bus, 1ms, 30ms);
  EXPECT_EQ(bus.turns()[0].station, 1u);
  EXPECT_EQ(bus.turns()[1].station, 2u);
  EXPECT_EQ(bus.turns()[1].from, 5ms);
  EXPECT_EQ(bus.turns()[2].station, 2u);
}

TEST(TokenBus, APictureShowsTheTurnsFromTheFirstThatCarried) {
  TokenBus bus(10ms, 1'000'000);
  bus.join(1);
  run(bus, 0ms, 20ms);
  EXPECT_TRUE(bus.shown_turns(20ms).empty()) << "one station alone";
  bus.join(2);
  run(bus, 20ms, 2002ms);
  std::vector<TokenTurn> shown = bus.shown_turns(2002ms);
  ASSERT_EQ(shown.size(), 200u);
  EXPECT_EQ(shown.back().from, bus.turns().back().from) << "the last, where nothing was carried";
  EXPECT_EQ(shown.back().to, 2002ms) << "a turn that goes on ends now";
  bus.queue(1, {25, [](Time) {}}, 2002ms);
  run(bus, 2002ms, 4000ms);
  shown = bus.shown_turns(4000ms);
  ASSERT_EQ(shown.size(), 200u);
  EXPECT_GT(shown[2].busy, 0ns) << "a cycle before it";
}

}  // namespace
}  // namespace fieldproof::xnet
