#include "reports/csv.hpp"

#include <gmock/gmock.h>

#include "reports/testdata/samples.hpp"

namespace fieldproof::reports {
namespace {

using results::CaseResult;
using results::Verdict;

/// A case whose clock began at 2 s.
CaseResult moved() {
  CaseResult result = samples::with(Verdict::pass, "xnet/motion/one");
  result.exchange = {{results::Event::Kind::note, 2s, 2s, {}, "do MOTO 10 5 50 axis 1"}};
  result.trace.axes = {
      {"1", {{2s, 0, 0}, {2s + 3ms, 0.5, 5000}}, {{2s + 1ms, "MOTO 10, 5 \"50\""}}, {}},
      {"B:2", {{2s + 2ms, -7, 0}}, {}, {}}};
  return result;
}

class CsvReport : public testing::Test {
 protected:
  void report(const std::vector<CaseResult>& results) {
    const std::unique_ptr<results::Sink> sink = csv_report(folder_ / "csv");
    samples::hand_over(*sink, samples::run_info(), results, samples::run_end());
  }
  std::string table(const std::string& name) {
    return samples::read_file(folder_ / ("csv/" + name));
  }

  samples::Folder folder_;
};

TEST(CsvField, IsQuotedWhereItMustBe) {
  EXPECT_EQ(csv_field("MOTO 10 5 50"), "MOTO 10 5 50");
  EXPECT_EQ(csv_field(""), "");
  EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_field("say \"no\""), "\"say \"\"no\"\"\"");
  EXPECT_EQ(csv_field("a\nb"), "\"a\nb\"");
}

TEST_F(CsvReport, SamplesAndEventsStandInTheOrderOfTime) {
  report({moved()});
  EXPECT_EQ(table("xnet.motion.one.csv"),
            "time_ms,axis,position,speed,event\r\n"
            "0.000,1,0,0,\r\n"
            "1.000,1,,,\"MOTO 10, 5 \"\"50\"\"\"\r\n"
            "2.000,B:2,-7,0,\r\n"
            "3.000,1,0.5,5000,\r\n");
}

TEST_F(CsvReport, TurnsHaveAFileOfTheirOwn) {
  CaseResult result = moved();
  result.repeat = 1;
  result.trace.nets = {{3, {{2, 2s, 2s + 10ms, 6ms}, {5, 2s + 10ms, 2s + 20ms, 0ns}}}};
  report({result, samples::failure()});
  EXPECT_EQ(table("xnet.motion.one__2.token.csv"),
            "net,station,from_ms,to_ms,busy_ms\r\n"
            "3,2,0.000,10.000,6.000\r\n"
            "3,5,10.000,20.000,0.000\r\n");
  EXPECT_NE(table("xnet.motion.one__2.csv"), "");
  EXPECT_EQ(table("xgt_cnet.rss.one_word.csv"), "") << "a case on a wire has no trace";
}

TEST_F(CsvReport, AFolderThatCannotBeMadeIsNamed) {
  std::ofstream(folder_ / "csv") << "a file";
  const Status begun = csv_report(folder_ / "csv")->begin(samples::run_info());
  ASSERT_FALSE(begun);
  EXPECT_THAT(begun.error().message, testing::HasSubstr(folder_ / "csv"));
  EXPECT_THAT(begun.error().message, testing::HasSubstr("--csv"));
}

}  // namespace
}  // namespace fieldproof::reports
