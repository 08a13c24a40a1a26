#include "reports/compare/compare.hpp"

#include <gmock/gmock.h>

#include <pugixml.hpp>

#include "reports/compare/compare_html.hpp"
#include "reports/compare/compare_junit.hpp"
#include "reports/compare/compare_text.hpp"
#include "reports/testdata/samples.hpp"

namespace fieldproof::compare {

using results::CaseResult;
using results::Verdict;

namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::Pair;

CaseResult result_of(const std::string& id, Verdict verdict, const std::string& message = "",
                     std::vector<double> response_ms = {}) {
  CaseResult result = samples::with(verdict, "xgt_cnet/c/" + id, message);
  result.response_ms = std::move(response_ms);
  return result;
}

RunSummary run_of(std::vector<CaseResult> results, const std::string& gate = "default") {
  ResultFile file{"run.ndjson", samples::run_info(), samples::run_end(0), std::move(results)};
  file.run.properties["gate"] = gate;
  return summarize(file);
}

/// Comparisons point into the runs: they live as long as the test.
class CompareTest : public testing::Test {
 protected:
  ComparisonSet& compared(std::vector<CaseResult> before, std::vector<CaseResult> after) {
    std::vector<RunSummary> runs;
    runs.push_back(run_of(std::move(before)));
    runs.push_back(run_of(std::move(after)));
    set_ = std::make_unique<ComparisonSet>(std::move(runs));
    return *set_;
  }
  /// Of a single case with these verdicts; nothing where it counts as unchanged.
  std::optional<Change> change(Verdict before, Verdict after,
                               const std::string& message_before = "m",
                               const std::string& message_after = "m") {
    const Comparison& one =
        compared({result_of("x", before, message_before)}, {result_of("x", after, message_after)})
            .comparisons.at(0);
    return one.changes.empty() ? std::nullopt : std::optional(one.changes.at(0).change);
  }
  std::unique_ptr<ComparisonSet> set_;
  samples::Folder folder_;
};

TEST_F(CompareTest, EachChangeOfVerdictHasItsName) {
  using V = Verdict;
  using C = Change;
  EXPECT_EQ(change(V::pass, V::fail), C::newly_failing);
  EXPECT_EQ(change(V::skip, V::error), C::newly_failing);
  EXPECT_EQ(change(V::xfail, V::xpass), C::newly_failing);
  EXPECT_EQ(change(V::pass, V::non_strict), C::weaker);
  EXPECT_EQ(change(V::marginal, V::non_strict), C::weaker);
  EXPECT_EQ(change(V::pass, V::blocked), C::no_longer_judged);
  EXPECT_EQ(change(V::info, V::skip), C::no_longer_judged);
  EXPECT_EQ(change(V::fail, V::pass), C::newly_passing);
  EXPECT_EQ(change(V::error, V::non_strict), C::newly_passing);
  EXPECT_EQ(change(V::fail, V::error), C::other_reason);
  EXPECT_EQ(change(V::fail, V::fail, "BCC: x", "no answer"), C::other_reason);
  EXPECT_EQ(change(V::fail, V::xfail), C::other_verdict);
  EXPECT_EQ(change(V::pass, V::xfail), C::other_verdict);
  EXPECT_EQ(change(V::non_strict, V::pass), C::other_verdict);
  EXPECT_EQ(change(V::pass, V::info), C::other_verdict);
  EXPECT_EQ(change(V::fail, V::skip), C::other_verdict);
  for (Verdict verdict : text::Tally::verdicts)
    EXPECT_EQ(change(verdict, verdict), std::nullopt) << results::to_string(verdict);
}

TEST_F(CompareTest, OnlyWhatGotWorseIsRed) {
  for (Verdict before : text::Tally::verdicts) {
    for (Verdict after : text::Tally::verdicts) {
      const auto found = change(before, after);
      const bool worse = found == Change::newly_failing || found == Change::weaker ||
                         found == Change::no_longer_judged;
      EXPECT_EQ(set_->worse(), worse)
          << results::to_string(before) << " to " << results::to_string(after);
    }
  }
}

TEST_F(CompareTest, TheGateOfEachRunCounts) {
  const RunSummary before = run_of({result_of("x", Verdict::non_strict)}),
                   after = run_of({result_of("x", Verdict::non_strict)}, "strict");
  EXPECT_EQ(compare(before, after).changes.at(0).change, Change::newly_failing);
  EXPECT_EQ(compare(after, before).changes.at(0).change, Change::newly_passing);
}

TEST_F(CompareTest, TimesInAMessageAreNoOtherReason) {
  EXPECT_EQ(change(Verdict::fail, Verdict::fail, "late answer: 612.3 ms after the request",
                   "late answer: 598.0 ms after the request"),
            std::nullopt);
  EXPECT_EQ(
      change(Verdict::fail, Verdict::fail, "late answer: 612.3 ms", "no answer within 500 ms"),
      Change::other_reason);
  EXPECT_EQ(change(Verdict::fail, Verdict::fail, "data: 0001", "data: 0002"), Change::other_reason);
}

TEST_F(CompareTest, AddedRemovedAndRevisedAreToldButAreNotWorse) {
  CaseResult revised = result_of("r", Verdict::fail);
  revised.rev = 2;
  const Comparison& one = compared({result_of("a", Verdict::pass), result_of("r", Verdict::pass)},
                                   {revised, result_of("z", Verdict::fail)})
                              .comparisons.at(0);
  std::vector<std::pair<std::string, Change>> found;
  for (const CaseChange& change : one.changes) found.emplace_back(change.id, change.change);
  EXPECT_THAT(
      found, ElementsAre(Pair("xgt_cnet/c/z", Change::added), Pair("xgt_cnet/c/a", Change::removed),
                         Pair("xgt_cnet/c/r", Change::revised)));
  EXPECT_FALSE(one.worse());
}

TEST_F(CompareTest, ARevThatTheFileDoesNotSayIsComparable) {
  CaseResult unknown = result_of("r", Verdict::pass);
  unknown.rev = 0;
  EXPECT_THAT(compared({unknown}, {result_of("r", Verdict::pass)}).comparisons.at(0).changes,
              IsEmpty());
}

TEST_F(CompareTest, TheGravestRepetitionCounts) {
  std::vector<CaseResult> flaky(5, result_of("x", Verdict::pass));
  for (int i = 0; i < 5; ++i) flaky[static_cast<std::size_t>(i)].repeat = i;
  flaky[1].verdict = flaky[3].verdict = Verdict::fail;
  flaky[1].message = "no answer";
  const Comparison& one = compared({result_of("x", Verdict::pass)}, flaky).comparisons.at(0);
  ASSERT_EQ(one.changes.size(), 1u);
  EXPECT_EQ(verdict_text(one.changes[0].after), "FAIL in 2 of 5");
  EXPECT_EQ(one.changes[0].after->message, "no answer");
}

// ---- reply times

std::vector<double> times(double from, std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(from + 0.01 * static_cast<double>(i));
  return values;
}

TEST_F(CompareTest, ASlowerCaseIsWorseAndAFasterOneIsNot) {
  const ComparisonSet& set = compared({result_of("slow", Verdict::pass, "", times(4, 8)),
                                       result_of("fast", Verdict::pass, "", times(9, 8)),
                                       result_of("same", Verdict::pass, "", times(4, 8))},
                                      {result_of("slow", Verdict::pass, "", times(6, 8)),
                                       result_of("fast", Verdict::pass, "", times(4, 8)),
                                       result_of("same", Verdict::pass, "", times(4.005, 8))});
  const Comparison& one = set.comparisons.at(0);
  ASSERT_EQ(one.shifts.size(), 2u);
  EXPECT_EQ(one.shifts[0].id, "xgt_cnet/c/slow");
  EXPECT_NEAR(one.shifts[0].shift_ms, 2, 1e-9);
  EXPECT_NEAR(one.shifts[0].p, 2.0 / 12870, 1e-12);
  EXPECT_NEAR(one.shifts[0].corrected_p, 3 * 2.0 / 12870, 1e-12);
  EXPECT_EQ(one.shifts[1].id, "xgt_cnet/c/fast");
  EXPECT_EQ(one.slower(), 1u);
  EXPECT_TRUE(set.worse());
  EXPECT_EQ(outcome(one), "1 slower");
  const std::string text = compare_text(set);
  EXPECT_THAT(text, HasSubstr("slower  xgt_cnet/c/slow\n      4.035 to 6.035 ms (+2.000 ms, +50 "
                              "%), p 0.00016, corrected 0.00047, 8 and 8 replies"));
  EXPECT_THAT(text, HasSubstr("Mann-Whitney U"));
}

TEST_F(CompareTest, CertainButSmallShiftsAreNotReported) {
  EXPECT_THAT(compared({result_of("x", Verdict::pass, "", times(4, 8))},
                       {result_of("x", Verdict::pass, "", times(4.3, 8))})
                  .comparisons.at(0)
                  .shifts,
              IsEmpty())
      << "0.3 ms";
  EXPECT_THAT(compared({result_of("x", Verdict::pass, "", times(400, 8))},
                       {result_of("x", Verdict::pass, "", times(410, 8))})
                  .comparisons.at(0)
                  .shifts,
              IsEmpty())
      << "2.5 %";
  std::vector<CaseResult> before{result_of("x", Verdict::pass, "", times(4, 8))},
      after{result_of("x", Verdict::pass, "", times(9, 8))};
  after[0].recording.link_floor = 20ms;
  EXPECT_THAT(compared(before, after).comparisons.at(0).shifts, IsEmpty())
      << "the link cannot tell 5 ms";
}

TEST_F(CompareTest, TooFewRepliesAreSaidToBeUntested) {
  const ComparisonSet& set = compared({result_of("x", Verdict::pass, "", {1, 2, 3})},
                                      {result_of("x", Verdict::pass, "", {100, 200, 300})});
  EXPECT_THAT(set.comparisons.at(0).shifts, IsEmpty());
  EXPECT_EQ(set.comparisons.at(0).timing.too_few, 1u);
  EXPECT_THAT(compare_text(set),
              AllOf(HasSubstr("reply times: not tested"), HasSubstr("`run --repeat 4`")));
}

TEST_F(CompareTest, TimesOfFailingOrRevisedCasesAreNotCompared) {
  CaseResult revised = result_of("x", Verdict::pass, "", times(9, 8));
  revised.rev = 2;
  const CaseResult before = result_of("x", Verdict::pass, "", times(4, 8));
  EXPECT_THAT(compared({before}, {revised}).comparisons.at(0).shifts, IsEmpty());
  EXPECT_THAT(
      compared({before}, {result_of("x", Verdict::fail, "", times(9, 8))}).comparisons.at(0).shifts,
      IsEmpty());
}

/// With 200 cases, one p of 0.03 is chance: the correction must not let it pass.
TEST_F(CompareTest, ManyCasesAreCorrectedFor) {
  std::vector<CaseResult> before, after;
  for (int i = 0; i < 200; ++i) {
    before.push_back(result_of(std::to_string(i), Verdict::pass, "", times(4, 4)));
    after.push_back(result_of(std::to_string(i), Verdict::pass, "", times(i == 7 ? 9 : 4, 4)));
  }
  EXPECT_THAT(compared(before, after).comparisons.at(0).shifts, IsEmpty());
  EXPECT_THAT(compared({before[7]}, {after[7]}).comparisons.at(0).shifts, testing::SizeIs(1));
}

// ---- matrix and reports

std::unique_ptr<ComparisonSet> three_runs() {
  std::vector<RunSummary> runs;
  runs.push_back(run_of({result_of("a", Verdict::pass), result_of("b", Verdict::pass),
                         result_of("c", Verdict::pass)}));
  runs.push_back(run_of({result_of("a", Verdict::pass), result_of("b", Verdict::fail, "no answer"),
                         result_of("c", Verdict::pass)}));
  runs.push_back(run_of({result_of("a", Verdict::pass), result_of("b", Verdict::pass),
                         result_of("d", Verdict::skip)}));
  return std::make_unique<ComparisonSet>(std::move(runs));
}

TEST_F(CompareTest, MatrixHasRowsThatDifferFirst) {
  const auto set = three_runs();
  std::vector<std::string> ids;
  for (const MatrixRow& row : set->rows) ids.push_back(row.id + (row.differs ? " differs" : ""));
  EXPECT_THAT(ids, ElementsAre("xgt_cnet/c/b differs", "xgt_cnet/c/c differs",
                               "xgt_cnet/c/d differs", "xgt_cnet/c/a"));
  EXPECT_THAT(compare_text(*set), HasSubstr("cases that differ (3)\n"
                                            "  case          A     B     C\n"
                                            "  xgt_cnet/c/b  PASS  FAIL  PASS\n"
                                            "  xgt_cnet/c/c  PASS  PASS  -\n"
                                            "  xgt_cnet/c/d  -     -     SKIP\n"));
}

TEST_F(CompareTest, LongListsAreCutWithACount) {
  std::vector<CaseResult> before, after;
  for (int i = 0; i < 60; ++i) {
    before.push_back(result_of(std::to_string(i), Verdict::pass));
    after.push_back(result_of(std::to_string(i), Verdict::fail));
  }
  const ComparisonSet& set = compared(before, after);
  EXPECT_THAT(compare_text(set), HasSubstr("... and 10 more; --html FILE shows all"));
  EXPECT_THAT(compare_text(set, {.limit = 0}), Not(HasSubstr("more; --html")));
}

/// Texts from a device and from files of others go through every report.
TEST_F(CompareTest, HostileContentSurvivesEveryReport) {
  const std::string hostile =
      std::string("<script>alert('x')</script>\x05\xFF\r\n]]>&") + '\0' + std::string(1 << 20, 'A');
  CaseResult evil = result_of("<b>\"\x01", Verdict::fail, hostile);
  evil.title = hostile;
  const ComparisonSet& set = compared({result_of("<b>\"\x01", Verdict::pass, hostile)},
                                      {evil, result_of("\xFF\xFE", Verdict::fail, hostile)});
  ASSERT_TRUE(write_compare_html(set, folder_ / "c.html"));
  ASSERT_TRUE(write_compare_junit(set, folder_ / "c.xml"));
  for (const char* name : {"c.html", "c.xml"}) {
    pugi::xml_document document;
    const auto parsed = document.load_file((folder_ / name).c_str());
    EXPECT_TRUE(parsed) << name << ": " << parsed.description();
    EXPECT_TRUE(document.select_nodes("//script").empty()) << name;
    EXPECT_THAT(samples::read_file(folder_ / name),
                AllOf(HasSubstr("[05][FF]"), Not(HasSubstr("\x05"))))
        << name;
  }
  EXPECT_THAT(compare_text(set), AllOf(HasSubstr("[05][FF]"), Not(HasSubstr("\x05"))));
}

TEST_F(CompareTest, HtmlHoldsEveryChangeAndEveryRow) {
  const auto set = three_runs();
  ASSERT_TRUE(write_compare_html(*set, folder_ / "c.html"));
  const std::string html = samples::read_file(folder_ / "c.html");
  EXPECT_THAT(html, AllOf(HasSubstr("something got worse"), HasSubstr("A to B: 1 newly failing"),
                          HasSubstr("A to C: nothing got worse"), HasSubstr("now: no answer"),
                          HasSubstr("1 cases alike in all runs")));
}

TEST_F(CompareTest, JunitCountsEqualItsChildren) {
  const auto set = three_runs();
  ASSERT_TRUE(write_compare_junit(*set, folder_ / "c.xml"));
  pugi::xml_document document;
  ASSERT_TRUE(document.load_file((folder_ / "c.xml").c_str()));
  std::set<std::string> names;
  std::size_t failures = 0, skipped = 0, cases = 0;
  for (const pugi::xml_node suite : document.child("testsuites").children("testsuite")) {
    std::size_t own = 0;
    for (const pugi::xml_node one : suite.children("testcase")) {
      ++own;
      failures += !one.child("failure").empty();
      skipped += !one.child("skipped").empty();
      names.insert(std::string(one.attribute("classname").value()) + ' ' +
                   one.attribute("name").value());
    }
    EXPECT_EQ(suite.attribute("tests").as_uint(), own);
    cases += own;
  }
  EXPECT_EQ(cases, 7u);
  EXPECT_EQ(names.size(), cases) << "unique names";
  EXPECT_EQ(failures, 1u);
  EXPECT_EQ(skipped, 2u);
  const std::string lint = "xmllint --noout --schema " FIELDPROOF_SOURCE_DIR
                           "/reports/testdata/junit-10.xsd '" +
                           (folder_ / "c.xml") + "' 2>/dev/null";
  EXPECT_EQ(std::system(lint.c_str()), 0) << "junit-10.xsd";
}

TEST(ComparisonSetTest, LettersGoOnAfterZ) {
  EXPECT_EQ(ComparisonSet::letter(0), "A");
  EXPECT_EQ(ComparisonSet::letter(25), "Z");
  EXPECT_EQ(ComparisonSet::letter(26), "AA");
  EXPECT_EQ(ComparisonSet::letter(53), "BB");
}

}  // namespace
}  // namespace fieldproof::compare
