#include "harness/judge/token_rules.hpp"

#include <gtest/gtest.h>

namespace fieldproof::judging {
namespace {

NetTrace three_in_30_ms() {
  NetTrace net{1, {}, 30ms};
  for (unsigned i = 0; i < 9; ++i)
    net.turns.push_back({1 + i % 3, i * 10ms, (i + 1) * 10ms, 2ms, 3, i == 0});
  return net;
}

TEST(TokenRules, ARightBusBreaksNone) {
  EXPECT_EQ(broken_token_rule({}), "");
  EXPECT_EQ(broken_token_rule(three_in_30_ms()), "");
}

TEST(TokenRules, EachIsNamed) {
  NetTrace net = three_in_30_ms();
  net.turns[4].from = 39ms;
  EXPECT_EQ(broken_token_rule(net), "at 39 ms stations 1 and 2 have the token at one time");
  net = three_in_30_ms();
  net.turns[4].from = 41ms;
  EXPECT_EQ(broken_token_rule(net), "at 41 ms nobody has the token for 1 ms behind station 1");
  net = three_in_30_ms();
  net.turns[4].busy = 11ms;
  EXPECT_EQ(broken_token_rule(net), "at 40 ms station 2 sends longer than it has the token");
  net = three_in_30_ms();
  net.turns[4].station = 1;
  EXPECT_EQ(broken_token_rule(net),
            "at 20 ms station 1 has the token twice before all 3 have had it");
  net = three_in_30_ms();
  net.cycle = 20ms;
  EXPECT_EQ(broken_token_rule(net),
            "at 0 ms the token takes 30 ms to come round, the cycle is 20 ms");
}

/// While somebody leaves or joins, the shares of the cycle are others.
TEST(TokenRules, RoundsInWhichTheStationsChangeAreNotJudged) {
  NetTrace net{1, {{1, 0ms, 10ms, 0ms, 3, true}, {2, 10ms, 20ms, 0ms, 3}}, 30ms};
  net.turns.push_back({3, 20ms, 35ms, 0ms, 2});
  net.turns.push_back({1, 35ms, 50ms, 0ms, 2});
  EXPECT_EQ(broken_token_rule(net), "");
  net.turns.push_back({1, 90ms, 120ms, 0ms, 1, true});
  EXPECT_EQ(broken_token_rule(net), "") << "nobody was there in between";
}

}  // namespace
}  // namespace fieldproof::judging
