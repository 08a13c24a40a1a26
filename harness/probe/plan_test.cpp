#include "harness/probe/plan.hpp"
#include "harness/test_protocol.hpp"
#include "suites/protocols.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <set>

namespace fieldproof::probe {
namespace {

std::vector<std::string> texts(const std::vector<Trial>& plan) {
  std::vector<std::string> result;
  for (const Trial& trial : plan) result.push_back(to_string(trial));
  return result;
}

std::ptrdiff_t place(const std::vector<Trial>& plan, const std::string& text) {
  const auto all = texts(plan);
  const auto found = std::ranges::find(all, text);
  EXPECT_NE(found, all.end()) << text;
  return found - all.begin();
}

TEST(SearchPlan, AsksEachQuestionOnce) {
  const std::vector<Trial> plan = make_plan({}, suites::protocols());
  const auto all = texts(plan);
  EXPECT_EQ(std::set<std::string>(all.begin(), all.end()).size(), plan.size());
  // 8 speeds; 32 stations; 6 frames, but RTU with the three 8-bit ones alone.
  EXPECT_EQ(plan.size(), 8u * 32 * (6 + 3 + 6 + 6));
}

TEST(SearchPlan, BeginsWithTheMostLikely) {
  const std::vector<Trial> plan = make_plan({}, suites::protocols());
  EXPECT_EQ(to_string(plan.front()), "9600-8N1 xgt-cnet station 1");
  EXPECT_LT(place(plan, "9600-8N1 modbus-rtu station 1"), 10);
  EXPECT_LT(place(plan, "19200-8E1 modbus-rtu station 1"), 100);
  EXPECT_LT(place(plan, "9600-8N1 xgt-cnet station 2"),
            place(plan, "9600-8N1 xgt-cnet station 31"));
  EXPECT_LT(place(plan, "38400-8N1 xgt-cnet station 1"),
            place(plan, "1200-8N1 xgt-cnet station 1"));
  EXPECT_LT(place(plan, "9600-8E1 ls-bus station 1"), place(plan, "9600-7N1 ls-bus station 1"));
}

TEST(SearchPlan, AProtocolOfANetworkIsNotSearched) {
  struct OnPort final : harness::TestProtocol {
    std::uint16_t default_port() const override { return 502; }
  };
  const OnPort network;
  const harness::TestProtocol line;
  const std::array<const harness::Protocol*, 2> table{&network, &line};
  EXPECT_THAT(filled({}, harness::Protocols(table)).protocols, testing::ElementsAre(&line));
}

/// A read is harmless at any station, and a module may be set to 0.
TEST(SearchPlan, AsksStation0LikeAnyOther) {
  EXPECT_THAT(texts(make_plan({.speeds = {9600},
                               .frames = {{}},
                               .stations = {0},
                               .protocols = {suites::protocols().find("modbus-rtu")}},
                              suites::protocols())),
              testing::ElementsAre("9600-8N1 modbus-rtu station 0"));
}

TEST(SearchPlan, SendsNoBinaryBytesOverSevenBits) {
  const auto seven = std::ranges::count_if(make_plan({}, suites::protocols()), [](const Trial& t) {
    return t.line.data_bits == 7 && t.protocol->name() == "modbus-rtu";
  });
  EXPECT_EQ(seven, 0);
}

TEST(SearchPlan, WritesNothing) {
  for (const Trial& trial :
       make_plan({.speeds = {9600}, .frames = {{}}, .stations = {}, .protocols = {}},
                 suites::protocols()))
    EXPECT_TRUE(trial.protocol->written_by(trial.protocol->probe(trial.station, {})).empty())
        << to_string(trial);
}

TEST(SearchPlan, ALinkWithoutSettingsHasOne) {
  const SearchSpace space{
      .speeds = {}, .frames = {}, .stations = {}, .protocols = {}, .settable = false};
  for (const Trial& trial : make_plan(space, suites::protocols()))
    EXPECT_EQ(trial.line, line::LineSettings{});
}

TEST(SearchPlan, SaysTheWorstCaseBeforehand) {
  const std::vector<Trial> plan = make_plan({.speeds = {9600, 1200},
                                             .frames = {{}},
                                             .stations = {1},
                                             .protocols = {suites::protocols().find("xgt-cnet")}},
                                            suites::protocols());
  ASSERT_EQ(plan.size(), 2u);
  const auto characters = static_cast<int>(plan[0].protocol->probe(1, {}).size());
  const Duration wire =
      characters * (plan[0].line.character_time() + plan[1].line.character_time());
  const Duration four_characters_at_1200 = 4 * plan[1].line.character_time();
  EXPECT_EQ(longest_time(plan, 500ms), 2 * 500ms + wire + 20ms + four_characters_at_1200);
  const Duration second = longest_time({plan[0], plan[0]}, 0ms) - longest_time({plan[0]}, 0ms);
  EXPECT_EQ(second, characters * plan[0].line.character_time()) << "listened to once";
}

}  // namespace
}  // namespace fieldproof::probe
