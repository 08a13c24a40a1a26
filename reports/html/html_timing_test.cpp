#include "reports/html/html_timing.hpp"

#include <gmock/gmock.h>

#include "reports/testdata/parsed_html.hpp"

namespace fieldproof::html {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string timing(const std::map<std::string, std::vector<double>>& response_ms, double limit_ms) {
  std::map<std::string, results::ResponseTimes> times;
  for (const auto& [group, each] : response_ms)
    for (const double ms : each) times[group].add(ms);
  HtmlWriter out;
  write_timing(out, times, limit_ms);
  return out.take();
}

TEST(HtmlTiming, ARowSaysCountLeastMedian99thAndGreatest) {
  const samples::ParsedHtml page(
      timing({{"xgt_cnet/rss", {3, 1, 2}}, {"xgt_cnet/wss", {40}}}, 500));
  EXPECT_THAT(page.texts("//tbody/tr[1]/td[not(@class='plot')]"),
              ElementsAre("xgt_cnet/rss", "3", "1.000", "2.000", "3.000", "3.000"));
  EXPECT_THAT(page.texts("//tbody/tr[2]/td[not(@class='plot')]"),
              ElementsAre("xgt_cnet/wss", "1", "40.000", "40.000", "40.000", "40.000"));
  EXPECT_EQ(2u, page.count("//path[@class='limit']"));
}

// From 1 to 1000 ms are three decades over 384 units from 8 on: 10 ms stands at 136, 100 ms at 264.
TEST(HtmlTiming, TheScaleIsLogarithmic) {
  const std::string html = timing({{"a", {10, 10, 10, 1000}}}, 100);
  EXPECT_THAT(html, HasSubstr("class=\"median\" d=\"M136.0 "));
  EXPECT_THAT(html, HasSubstr("class=\"limit\" d=\"M264.0 "));
}

TEST(HtmlTiming, WithoutALimitThereIsNoLine) {
  EXPECT_EQ(std::string::npos, timing({{"a", {10}}}, 0).find("limit"));
}

TEST(HtmlTiming, ZeroNegativeAndAbsurdTimesStayInThePlot) {
  const std::string html = timing({{"a", {0, -1, 1e-9, 1e300}}, {"b", {0}}}, 1e300);
  const samples::ParsedHtml page(html);
  EXPECT_EQ(2u, page.count("//tbody//svg"));
  EXPECT_EQ(std::string::npos, html.find("nan"));
  EXPECT_EQ(std::string::npos, html.find("inf"));
  // The median of the first row is no positive time, its greatest and the limit are beyond any
  // scale.
  EXPECT_THAT(html, HasSubstr("class=\"median\" d=\"M8.0 "));
  EXPECT_THAT(html, HasSubstr("class=\"limit\" d=\"M392.0 "));
}

}  // namespace
}  // namespace fieldproof::html
