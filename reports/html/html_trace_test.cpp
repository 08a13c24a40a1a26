#include "reports/html/html_trace.hpp"

#include <gmock/gmock.h>

#include "reports/html/html_survey.hpp"
#include "reports/testdata/parsed_html.hpp"

namespace fieldproof::html {
namespace {

using results::CaseResult;
using samples::ParsedHtml;
using testing::HasSubstr;

/// Two axes; the first up against a limit.
CaseResult two_axes() {
  CaseResult result;
  result.id = "xnet/motion/two";
  result.verdict = results::Verdict::pass;
  result.exchange = {{results::Event::Kind::note, 2s, 2s, {}, "do"}};
  AxisTrace first{"1", {}, {}, {}};
  first.samples = {{2s, 0, 0}, {2s + 100ms, 0, 0}, {2s + 200ms, 500, 10000}, {3s, 9000, 0}};
  first.events = {{2s + 97ms, "MOTO <9000> 5000 50"}, {3s, "error 20001"}};
  first.limits = {{"max position limit", 9000, 9000}, {"far", 1e6, 1e6}};
  AxisTrace second{"B:2", {{2s, 0, 0}, {3s, -400, -800}}, {}, {{"origin switch", -300, -200}}};
  second.limits.push_back(first.limits.front());  // is drawn once
  result.trace.axes = {first, second};
  return result;
}

ParsedHtml pictures(const CaseResult& result) {
  HtmlWriter out;
  out.element("body", {}, [&] { write_trace(out, result); });
  return ParsedHtml(out.take());
}

TEST(HtmlTrace, EachAxisHasALineInBothPlots) {
  const ParsedHtml page = pictures(two_axes());
  EXPECT_EQ(page.count("//svg"), 1u);
  EXPECT_EQ(page.count("//svg/polyline[@class='a0']"), 2u);
  EXPECT_EQ(page.count("//svg/polyline[@class='a1']"), 2u);
  EXPECT_EQ(page.text("//figcaption/b[@class='a1']"), "axis B:2");
  EXPECT_EQ(page.text("//svg/text[not(@class)][1]"), "position, pulses");
  EXPECT_EQ(page.text("//svg/text[not(@class)][2]"), "speed, pulses/s");
  EXPECT_EQ(page.count("//svg//tspan[contains(., ' ms')]"), 1u) << "the unit of time";
}

TEST(HtmlTrace, EventsAreNumberedAndEscaped) {
  const ParsedHtml page = pictures(two_axes());
  EXPECT_EQ(page.count("//svg//tspan[. = '1' or . = '2']"), 2u);
  EXPECT_EQ(page.text("//figcaption/ol/li[1]"), "97 ms axis 1: MOTO <9000> 5000 50");
  EXPECT_EQ(page.text("//figcaption/ol/li[2]"), "1000 ms axis 1: error 20001");
  CaseResult crowd = two_axes();
  for (int i = 0; i < 60; ++i) crowd.trace.axes[1].events.push_back({3s, "again"});
  const ParsedHtml crowded = pictures(crowd);
  EXPECT_EQ(crowded.count("//li"), 40u);
  EXPECT_THAT(crowded.text("//figcaption"), HasSubstr("... and 22 more"));
  EXPECT_EQ(crowded.count("//svg//tspan[. = '2-62']"), 1u) << "one number for all at one place";
}

TEST(HtmlTrace, LimitsAreDashedWhereThePictureReaches) {
  const ParsedHtml page = pictures(two_axes());
  EXPECT_EQ(page.count("//svg/path[@class='limit']"), 2u) << "not the far one";
  EXPECT_EQ(page.count("//svg/path[@class='on']"), 1u) << "where the switch is on";
  EXPECT_EQ(page.count("//svg/text[. = 'max position limit']"), 1u);
  EXPECT_THAT(page.text("//figcaption"), HasSubstr("far 1000000;")) << "it is said all the same";
}

TEST(HtmlTrace, StationsHaveABandDarkerWhereTheyCarry) {
  CaseResult result;
  result.trace.nets = {{1, {{2, 0ns, 10ms, 6ms}, {5, 10ms, 20ms, 0ns}, {2, 20ms, 25ms, 0ns}}}};
  const ParsedHtml page = pictures(result);
  EXPECT_EQ(page.count("//svg/path[@class='had']"), 2u);
  EXPECT_EQ(page.count("//svg/path[@class='carried']"), 1u);
  EXPECT_EQ(page.text("//svg/g/text[1]"), "2");
  EXPECT_EQ(page.text("//svg/g/text[2]"), "5");
}

TEST(HtmlTrace, ForeignTracesAreDrawnToo) {
  CaseResult result;
  EXPECT_EQ(pictures(result).count("//figure"), 0u);
  result.trace.axes = {{"1", {}, {}, {}}, {"2", {{1ms, 7, 7}}, {}, {}}};
  result.trace.nets = {{1, {}}, {2, {{1, 5ms, 5ms, 0ns}}}};
  result.trace.axes.push_back({"3", {{2ms, 1e308, -1e308}, {1ms, -1e308, 1e308}}, {}, {}});
  result.trace.axes.push_back({"4", {{2ms, 1e17, 0}}, {}, {{"wide", -1e300, 1e300}}});
  EXPECT_EQ(pictures(result).count("//figure"), 2u);
}

TEST(HtmlTrace, LinesHaveSoManyPicturesAndNoMore) {
  const auto drawn = [](std::size_t cases) {
    HtmlSurveyor surveyor{results::Gate{}};
    for (std::size_t i = 0; i < cases; ++i) surveyor.add(two_axes());
    const HtmlSurvey survey = surveyor.finish({});
    const std::string lines = "<t>" + survey.sections.begin()->second.passes.str() + "</t>";
    return ParsedHtml(lines).count("//tr/td/details//svg");
  };
  EXPECT_EQ(drawn(2), 2u);
  EXPECT_EQ(drawn(html_picture_limit + 3), html_picture_limit);
}

}  // namespace
}  // namespace fieldproof::html
