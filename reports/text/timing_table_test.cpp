#include "reports/text/timing_table.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace fieldproof::text {
namespace {

results::CaseResult replied(const std::string& id, std::vector<double> ms,
                            const std::string& line = "") {
  results::CaseResult result;
  result.id = id;
  result.line = line;
  result.response_ms = std::move(ms);
  return result;
}

TEST(TimingTable, RepetitionsOfACaseAreOneRow) {
  TimingTable table;
  for (int i = 0; i < 99; ++i) table.add(replied("xgt_cnet/rss/a", {1}));
  table.add(replied("xgt_cnet/rss/a", {2}));
  table.add(replied("xgt_cnet/rss/b", {3, 5}));
  table.add(replied("xgt_cnet/rss/silent", {}));
  EXPECT_EQ(
      "reply times in ms   replies        min     median        p99        max\n"
      "  xgt_cnet/rss/a        100      1.000      1.000      1.000      2.000\n"
      "  xgt_cnet/rss/b          2      3.000      3.000      5.000      5.000\n",
      timing_text(table.rows()));
  EXPECT_EQ("", timing_text(TimingTable{}.rows()));
}

TEST(TimingTable, ManyCasesBecomeGroupsAndThenProtocols) {
  TimingTable table;
  for (const char* id : {"p/one/a", "p/one/b", "p/two/a", "q/one/a"}) table.add(replied(id, {1}));
  const auto names = [&](std::size_t limit) {
    std::string text;
    for (const auto& [name, figures] : table.rows(limit)) text += name + ' ';
    return text;
  };
  EXPECT_EQ("p/one/a p/one/b p/two/a q/one/a ", names(4));
  EXPECT_EQ("p/one p/two q/one ", names(3));
  EXPECT_EQ("p q ", names(2));
}

TEST(TimingTable, StepsOfALineMatrixStandApart) {
  TimingTable table;
  table.add(replied("p/one/a", {1}, "9600-8N1"));
  table.add(replied("p/one/a", {2}, "38400-8E1"));
  const auto written = nlohmann::json::parse(table.json());
  EXPECT_EQ(2u, written["cases"].size());
  EXPECT_EQ(2.0, written["cases"]["p/one/a [38400-8E1]"]["median_ms"]);
  EXPECT_EQ(1u, written["groups"]["p/one [9600-8N1]"]["replies"]);
}

}  // namespace
}  // namespace fieldproof::text
