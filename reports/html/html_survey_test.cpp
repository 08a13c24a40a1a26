#include "reports/html/html_survey.hpp"

#include <gmock/gmock.h>

#include <fmt/format.h>

#include "reports/html/html_red.hpp"
#include "reports/testdata/parsed_html.hpp"
#include "reports/testdata/samples.hpp"

namespace fieldproof::html {

using results::CaseResult;
using results::Gate;
using results::RunInfo;
using results::Verdict;

namespace {

using samples::with;
using testing::ElementsAre;
using testing::HasSubstr;

class Survey : public testing::Test {
 protected:
  HtmlSurvey survey(const std::vector<CaseResult>& results, const Gate& gate = {},
                    const RunInfo& run = samples::run_info()) {
    HtmlSurveyor surveyor(gate);
    for (const CaseResult& result : results) surveyor.add(result);
    results::RunLog log;
    log.run = run;
    return surveyor.finish(log);
  }
};

TEST(SectionNames, AreOrderedAsAPersonCounts) {
  const auto less = [](const char* a, const char* b) {
    return SectionName{"m", a} < SectionName{"m", b};
  };
  EXPECT_TRUE(less("7.1.2", "7.1.10"));
  EXPECT_FALSE(less("7.1.10", "7.1.2"));
  EXPECT_TRUE(less("7.1.2", "7.1.2 (1)(a)"));
  EXPECT_TRUE(less("7.1.2 (9)", "7.1.2 (10)"));
  EXPECT_TRUE(less("11.1", "Appendix 3.1"));
  EXPECT_FALSE(less("7.1", "7.1"));
  // A strict order also of what differs in leading zeros only.
  EXPECT_NE(less("7.01", "7.1"), less("7.1", "7.01"));
  EXPECT_TRUE((SectionName{"a", "9"} < SectionName{"b", "1"}));
}

TEST_F(Survey, WhatTurnsEveryGateRedStandsFirst) {
  const HtmlSurvey made =
      survey({samples::with(Verdict::non_strict, "a/lenient"),
              samples::with(Verdict::fail, "a/bad"), samples::with(Verdict::error, "a/port")},
             {.strict = true});
  HtmlWriter red;
  red.element("div", {}, [&] {
    for (const RedCause& cause : red_causes(made)) red.markup(cause.group->blocks.str());
  });
  EXPECT_THAT(samples::ParsedHtml(red.str()).texts("//summary/b"),
              ElementsAre("a/bad", "a/port", "a/lenient"));
}

TEST_F(Survey, WhatWasNotJudgedIsGroupedByReason) {
  const HtmlSurvey made = survey({samples::with(Verdict::blocked, "a/one", "needs M"),
                                  samples::with(Verdict::blocked, "a/two", "needs M"),
                                  samples::with(Verdict::skip, "a/three", "other model"),
                                  samples::with(Verdict::pass, "a/four")});
  ASSERT_EQ(2u, made.unexecuted.size());
  const Unexecuted& blocked = made.unexecuted.at({Verdict::blocked, "needs M"});
  EXPECT_EQ(2u, blocked.cases);
  EXPECT_THAT(blocked.ids, ElementsAre("a/one", "a/two"));
}

TEST_F(Survey, ReadingsAreCountedByWhatWasTaken) {
  auto one = samples::with(Verdict::pass, "a/one"), two = samples::with(Verdict::pass, "a/two"),
       three = samples::with(Verdict::pass, "a/three");
  one.readings = two.readings = {{"type_echo", "upper"}};
  three.readings = {{"type_echo", "as_sent"}};
  const HtmlSurvey made = survey({one, two, three});
  EXPECT_EQ(2u, made.readings.at("type_echo").at("upper").cases);
  EXPECT_EQ("a/one", made.readings.at("type_echo").at("upper").example);
  EXPECT_EQ(1u, made.readings.at("type_echo").at("as_sent").cases);
}

TEST_F(Survey, ErrataAreMetByExecutedCasesOfTheirVectors) {
  results::RunInfo run = samples::run_info();
  const auto add = [&](const char* id, const char* section, std::vector<std::string> vectors) {
    run.errata.push_back({id,
                          "wording",
                          "printed",
                          "right",
                          "why",
                          "effect",
                          "",
                          {{"m", section, "q"}},
                          {},
                          std::move(vectors)});
  };
  add("e/both", "7.10", {"a/v", "a/blocked"});
  add("e/early", "7.9", {"a/v"});
  add("e/none", "1", {"a/w"});
  add("e/blocked", "1", {"a/blocked"});
  const HtmlSurvey made =
      survey({samples::with(Verdict::pass, "a/v/first"), samples::with(Verdict::fail, "a/v/second"),
              samples::with(Verdict::pass, "a/vx"), samples::with(Verdict::blocked, "a/blocked")},
             {}, run);
  ASSERT_EQ(2u, made.errata.size());
  EXPECT_EQ("e/early", made.errata[0].first.id);
  EXPECT_EQ("e/both", made.errata[1].first.id);
  EXPECT_EQ("1 PASS, 1 FAIL", text::to_string(made.errata[1].second));
}

TEST_F(Survey, MovedCasesAreCounted) {
  auto moved = samples::with(Verdict::pass, "a/one");
  moved.notes = {"transposed: station 1 to 7", "transposed: %MW100 to %MW300"};
  EXPECT_EQ(1u, survey({moved, samples::with(Verdict::pass, "a/two")}).transposed);
}

TEST_F(Survey, WhatOneReportCannotHoldIsCounted) {
  std::vector<results::CaseResult> many;
  for (std::size_t i = 0; i < html_block_limit + 7; ++i)
    many.push_back(samples::with(Verdict::fail, fmt::format("a/n{}", i),
                                 std::string(1 + i / 2, 'k')));  // none alike, but for two
  const HtmlSurvey made = survey(many);
  EXPECT_EQ(7u, made.red_unlisted);
  EXPECT_EQ(html_block_limit + 7, made.tally.of(Verdict::fail));
  std::string blocks;
  for (const auto& [number, group] : made.red) blocks += group.blocks.str();
  EXPECT_THAT(blocks, HasSubstr(fmt::format("a/n{}<", html_block_limit - 1)));
  EXPECT_THAT(blocks, testing::Not(HasSubstr(fmt::format("a/n{}<", html_block_limit))));
  EXPECT_THAT(made.sections.begin()->second.red.str(),
              HasSubstr(fmt::format("a/n{}<", html_block_limit + 6)))
      << "its line is there";
}

}  // namespace
}  // namespace fieldproof::html
