#include "reports/history/trend.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "reports/history/test_runs.hpp"
#include "reports/history/trend_html.hpp"
#include "reports/history/trend_text.hpp"
#include "reports/testdata/parsed_html.hpp"

namespace fieldproof::history {
namespace {

using test::add_or_fail;
using test::Head;
using test::open_or_fail;
using test::result_of;
using test::run_of;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using V = results::Verdict;

class TrendTest : public testing::Test {
 protected:
  /// A run whose replies take `ms`, more or less.
  void add(const Head& head, double ms, V verdict = V::pass, std::size_t repetitions = 1) {
    std::vector<results::CaseResult> results{
        result_of("rss/a", V::pass, {ms + 0.01 * (head.day * 7 % 5)}),
        result_of("rss/b", V::pass, {ms}), result_of("wss/c", V::pass, {2.0 + head.day % 2 * 0.1}),
        result_of("wss/d", verdict)};
    for (std::size_t i = 1; i < repetitions; ++i) {
      results.push_back(result_of("wss/d", V::pass));
      results.back().repeat = static_cast<int>(i);
    }
    add_or_fail(history_, run_of(head, std::move(results)));
  }
  Trend trend(const std::string& device = "", std::size_t last = 0) {
    Result<Trend> found = trend_of(history_, device, last);
    EXPECT_TRUE(found) << found.error().message;
    return std::move(*found);
  }
  /// Twelve runs of a version, then twelve of the next that answers 2 ms later.
  void add_two_versions() {
    for (int day = 1; day <= 24; ++day)
      add({day <= 12 ? "V1.40" : "V1.41", day}, day <= 12 ? 4 : 6);
  }

  samples::Folder folder_;
  History history_ = open_or_fail(folder_ / "history.sqlite");
};

TEST_F(TrendTest, NamesTheChangeAndItsRuns) {
  add_two_versions();
  const Trend found = trend();
  std::vector<std::string> changes;
  for (const Series* one : changed(found))
    changes.push_back(fmt::format("{}: {} {}, {}; {}", one->name, direction_of(*one),
                                  shift_of(*one), place_of(found, *one), cause_of(found, *one)));
  EXPECT_THAT(
      changes,
      ElementsAre("reply times: slower 4.000 to 6.010 ms (+2.010 ms, +50 %), between run 12 "
                  "(V1.40, 2026-01-12) and run 13 (V1.41, 2026-01-13); firmware V1.40 to V1.41",
                  HasSubstr("xgt_cnet/rss: slower")));
  EXPECT_EQ(found.tested_totals, 1u) << "the counts never changed";
  EXPECT_EQ(found.tested_topics, 2u);
  const std::string text = trend_text(found);
  EXPECT_THAT(text, AllOf(HasSubstr("24 runs, 2026-01-01 to 2026-01-24, firmware V1.40, V1.41\n"),
                          HasSubstr("changes between run 12 (V1.40, 2026-01-12) and run 13 (V1.41, "
                                    "2026-01-13); new there: firmware V1.40 to V1.41 (2)"),
                          HasSubstr("12 runs before and 12 after"),
                          HasSubstr("Mann-Whitney U, two-sided, on one number a run"),
                          HasSubstr("by firmware (2)"), HasSubstr("... and 4 more")));
}

TEST_F(TrendTest, CountsHaveTheirChange) {
  for (int day = 1; day <= 24; ++day) add({"V1.40", day}, 4, day <= 10 ? V::pass : V::fail);
  const Trend found = trend();
  ASSERT_EQ(changed(found).size(), 1u);
  EXPECT_EQ(changed(found)[0]->name, "red");
  EXPECT_EQ(shift_of(*changed(found)[0]), "0 to 1");
  EXPECT_THAT(place_of(found, *changed(found)[0]), HasSubstr("between run 10 "));
}

TEST_F(TrendTest, AWrongAnswerTakesItsOwnTime) {
  const auto add_with = [&](int day, V verdict, double ms) {
    add_or_fail(history_, run_of({"V1.40", day}, {result_of("rss/a", V::pass, {4}),
                                                  result_of("rss/b", verdict, {ms})}));
  };
  for (int day = 1; day <= 24; ++day)
    add_with(day, day <= 12 ? V::pass : V::fail, day <= 12 ? 4 : 100);
  const Trend found = trend();
  EXPECT_THAT(found.topics.at(0).values, testing::Each(4.0));
}

TEST_F(TrendTest, FewRunsAreComparedOneByOne) {
  add({"V1.40", 1}, 4);
  add({"V1.40", 2}, 4, V::fail);
  add({"V1.41", 3}, 4, V::fail);
  add({"V1.41", 4}, 4);
  const Trend found = trend();
  EXPECT_THAT(changed(found), IsEmpty());
  const std::string text = trend_text(found);
  EXPECT_THAT(
      text, AllOf(HasSubstr("4 runs are too few to test them against each other, 8 are"),
                  HasSubstr("1 newly failing  between run 1 (V1.40, 2026-01-01) and run 2"),
                  HasSubstr("1 newly passing  between run 3 "), Not(HasSubstr("between run 2 "))));
}

TEST_F(TrendTest, FlakyIsWhatChangesThoughNothingElseDid) {
  for (int day = 1; day <= 4; ++day) add({"V1.40", day}, 4, day == 3 ? V::fail : V::pass);
  for (int day = 5; day <= 6; ++day) add({"V1.41", day}, 4, V::fail);  // another version
  add({"V1.41", 7, "7", "c3d4"}, 4);                                   // other vectors
  add({"V1.41", 8, "7", "c3d4"}, 4, V::blocked);                       // not judged
  add({"V1.41", 9, "8"}, 4);                                           // another device
  add({"V1.41", 10, "7"}, 4, V::xfail);                                // the same, waived
  const Trend found = trend("number 7");
  ASSERT_EQ(found.flaky.size(), 1u);
  EXPECT_EQ(found.flaky[0].name, "xgt_cnet/wss/d");
  EXPECT_EQ(found.flaky[0].firmware, "V1.40");
  EXPECT_EQ(flaky_text(found.flaky[0]),
            "PASS in 3, FAIL in 1 of 4 runs; the last odd one is run 3");
}

/// Other cases beside it are no other circumstances.
TEST_F(TrendTest, FlakyOverRunsOfOtherSelections) {
  add({"V1.40", 1}, 4, V::fail);
  add_or_fail(history_, run_of({"V1.40", 2}, {result_of("wss/d", V::pass)}));
  add_or_fail(history_,
              run_of({"V1.40", 3}, {result_of("rss/a", V::pass), result_of("wss/d", V::pass)}));
  ASSERT_EQ(trend().flaky.size(), 1u);
  EXPECT_EQ(flaky_text(trend().flaky[0]),
            "PASS in 2, FAIL in 1 of 3 runs; the last odd one is run 1");
}

TEST_F(TrendTest, RepetitionsOfOneRunMayDifferToo) {
  add({}, 4, V::fail, 3);
  ASSERT_EQ(trend().flaky.size(), 1u);
  EXPECT_EQ(flaky_text(trend().flaky[0]),
            "FAIL in 1 of 1 run; repetitions differ within 1 of them");
}

TEST_F(TrendTest, IsOfOneDeviceAndOfRunsThatCameToTheirEnd) {
  add({"V1.40", 1}, 4);
  add({"V1.40", 2, "8"}, 4);
  compare::RunSummary killed = run_of({"V1.40", 3, "8"}, {result_of("rss/a", V::pass)});
  killed.end.reset();
  add_or_fail(history_, killed);
  EXPECT_EQ(trend().device, "LS XBC, serial number 8") << "that of the last run";
  EXPECT_EQ(trend().runs.size(), 1u);
  EXPECT_THAT(trend_text(trend()),
              AllOf(HasSubstr("the history has 2 devices; --device names another"),
                    HasSubstr("1 killed or interrupted runs are left out")));
  const auto two = trend_of(history_, "LS XBC", 0), none = trend_of(history_, "XEC", 0);
  ASSERT_FALSE(two || none);
  EXPECT_THAT(two.error().message, HasSubstr("'LS XBC' is a part of several devices"));
  EXPECT_THAT(none.error().message, AllOf(HasSubstr("'XEC' is no device of this history"),
                                          HasSubstr("\n  LS XBC, serial number 7")));
}

TEST_F(TrendTest, TheLastRunsAlone) {
  add_two_versions();
  const Trend found = trend("", 10);
  EXPECT_EQ(found.runs.size(), 10u);
  EXPECT_EQ(found.older, 14u);
  EXPECT_THAT(changed(found), IsEmpty()) << "it was before them";
}

TEST_F(TrendTest, JsonAndMarkdownSayTheSame) {
  add_two_versions();
  add({"V1.41", 25}, 6, V::fail);
  const Trend found = trend();
  const auto json = nlohmann::json::parse(trend_json(found));
  EXPECT_EQ(json["runs"].size(), 25u);
  EXPECT_EQ(json["runs"][24]["counts"]["FAIL"], 1);
  EXPECT_EQ(json["topics"]["xgt_cnet/rss"].size(), 25u);
  EXPECT_EQ(json["changes"][0]["between"], nlohmann::json({12, 13}));
  EXPECT_LT(json["changes"][0]["corrected_p"], 0.05);
  EXPECT_EQ(json["flaky"][0]["id"], "xgt_cnet/wss/d");
  const std::string markdown = trend_markdown(found);
  EXPECT_THAT(markdown, AllOf(HasSubstr("## Changes (2)"), HasSubstr("| reply times | slower |"),
                              HasSubstr("## Flaky cases (1)"), HasSubstr("## Runs (25)")));
}

TEST_F(TrendTest, HtmlHasTheCurveOfEachChange) {
  add_two_versions();
  add({"V1.41", 25}, 6, V::fail);
  const samples::ParsedHtml page(trend_html(trend()));
  EXPECT_EQ(page.text("//h1"), "2 changes, 1 flaky case");
  EXPECT_EQ(page.count("//main/figure"), 4u) << "totals, and the group that changed";
  EXPECT_EQ(page.count("//details/figure"), 1u);
  EXPECT_EQ(page.count("//main/figure//path[@class='limit']"), 2u) << "where it changed";
  EXPECT_THAT(page.texts("(//main/figure)[1]//text"),
              testing::IsSupersetOf({"V1.40", "V1.41", "2026-01-01", "2026-01-25"}));
  EXPECT_EQ(page.count("//*[@src or @href]"), 0u) << "offline";
}

TEST_F(TrendTest, ALongHistoryHasACurveOfFewPoints) {
  std::vector<results::CaseResult> results{result_of("rss/a", V::pass, {4})};
  for (int day = 1; day <= 200; ++day) {
    results[0].response_ms = {4 + day % 3 * 0.1};
    add_or_fail(history_, run_of({"V1.40", day}, results));
  }
  const samples::ParsedHtml page(trend_html(trend()));
  EXPECT_EQ(page.count("//polyline[string-length(@points) > 2500]"), 0u);
  EXPECT_EQ(page.count("//polyline"), 4u);
}

}  // namespace
}  // namespace fieldproof::history
