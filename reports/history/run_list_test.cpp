#include "reports/history/run_list.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "reports/history/test_runs.hpp"

namespace fieldproof::history {
namespace {

using test::add_or_fail;
using test::open_or_fail;
using test::result_of;
using test::run_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using V = results::Verdict;

class RunListTest : public testing::Test {
 protected:
  RunListTest() {
    add_or_fail(history_, run_of({.day = 1}, {result_of("rss/a", V::pass, {4, 6}),
                                              result_of("rss/b", V::fail, {}, "BCC: expected 0F"),
                                              result_of("wss/c", V::skip, {}, "no WSS")}));
    compare::RunSummary killed = run_of({"V1.41", 2}, {result_of("rss/a", V::pass, {4})});
    killed.end.reset();
    add_or_fail(history_, killed);
    compare::RunSummary interrupted = run_of({"V1.41", 3}, {result_of("rss/a", V::pass, {4})});
    interrupted.end->interrupted = true;
    interrupted.end->exit_code = 130;
    add_or_fail(history_, interrupted);
    runs_ = *history_.runs();
  }
  samples::Folder folder_;
  History history_ = open_or_fail(folder_ / "history.sqlite");
  std::vector<RunEntry> runs_;
};

TEST_F(RunListTest, TheNewestFirst) {
  EXPECT_THAT(
      list_text(runs_, 2),
      AllOf(StartsWith("runs (3)\n  run  started "),
            HasSubstr("\n  3    2026-01-03T12:00:00+00:00  LS XBC, serial number 7  V1.41     "
                      "a1b2     1       0    not whole\n  2  "),
            HasSubstr("0    killed\n  ... and 1 more before these; --last 0 shows all\n")));
  EXPECT_THAT(list_text(runs_, 0), HasSubstr("a1b2     2       1    exit 0\n"));
}

TEST_F(RunListTest, AsJson) {
  const nlohmann::json list = nlohmann::json::parse(list_json(runs_));
  ASSERT_EQ(list.size(), 3u);
  EXPECT_EQ(list[0]["counts"], nlohmann::json({{"FAIL", 1}, {"PASS", 1}, {"SKIP", 1}}));
  EXPECT_EQ(list[0]["exit_code"], 0);
  EXPECT_EQ(list[1]["exit_code"], nullptr);
  EXPECT_EQ(list[2]["complete"], false);
}

TEST_F(RunListTest, OneRun) {
  const compare::RunSummary run = *history_.summary(1);
  EXPECT_THAT(
      show_text(runs_[0], run),
      AllOf(StartsWith("run 1: LS XBC, serial number 7\n2026-01-01T12:00:00+00:00, "),
            HasSubstr("exit 0, 3 results: 1 PASS, 1 FAIL, 1 SKIP\n"),
            HasSubstr("  FAIL     xgt_cnet/rss/b  BCC: expected 0F\n"), Not(HasSubstr("wss/c")),
            HasSubstr("  xgt_cnet/rss            2      4.000      4.000      6.000")));
  const nlohmann::json shown = nlohmann::json::parse(show_json(runs_[0], run));
  EXPECT_EQ(shown["info"]["identity"]["serial"], "7");
  EXPECT_EQ(shown["cases"].size(), 3u);
  EXPECT_EQ(shown["cases"][0]["response_ms"], nlohmann::json({4.0, 6.0}));
}

}  // namespace
}  // namespace fieldproof::history
