#include "reports/json_report.hpp"

#include <fstream>

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "reports/console.hpp"
#include "reports/junit.hpp"
#include "reports/results/test_as_json.hpp"
#include "reports/testdata/samples.hpp"

namespace fieldproof::reports {

using results::Verdict;

namespace {

using nlohmann::json;
using results::test::as_json;
using samples::with;

class JsonReport : public testing::Test {
 protected:
  json report(const std::vector<results::CaseResult>& results, bool end = true) {
    samples::write_results(results_, results, end);
    const auto log = replay(results_, *json_report(report_));
    EXPECT_TRUE(log) << log.error().message;
    return json::parse(samples::read_file(report_));
  }

  samples::Folder folder_;
  std::string results_ = folder_ / "results.ndjson";
  std::string report_ = folder_ / "report.json";
};

TEST_F(JsonReport, HoldsTheWholeRun) {
  const json document = report({samples::failure(), samples::with(Verdict::pass, "a/b")});
  EXPECT_EQ(1, document["schema"]);
  EXPECT_EQ(as_json(samples::run_info()), document["run"]);
  EXPECT_EQ(as_json(samples::run_end()), document["end"]);
  ASSERT_EQ(2u, document["cases"].size());
  EXPECT_EQ(as_json(samples::failure()), document["cases"][0]);
  EXPECT_EQ(2, document["counts"]["total"]);
  EXPECT_EQ(1, document["counts"]["FAIL"]);
  EXPECT_EQ(0, document["counts"]["ERROR"]);
}

TEST_F(JsonReport, AKilledRunHasNoEnd) {
  const json document = report({samples::with(Verdict::pass, "a/b")}, false);
  EXPECT_TRUE(document.contains("end"));
  EXPECT_TRUE(document["end"].is_null());
  EXPECT_EQ(1u, document["cases"].size());
}

TEST_F(JsonReport, WithoutResultsIsStillADocument) {
  const json document = report({});
  EXPECT_EQ(json::array(), document["cases"]);
  EXPECT_EQ(0, document["counts"]["total"]);
}

TEST_F(JsonReport, EveryByteComesBack) {
  auto result = samples::failure();
  result.received_bytes.clear();
  for (int b = 0; b < 256; ++b) result.received_bytes.push_back(static_cast<Byte>(b));
  result.message = "<script> ]]> \x05 \xFF";
  const json document = report({result});
  EXPECT_EQ(result.received_bytes, document["cases"][0].get<results::CaseResult>().received_bytes);
  EXPECT_EQ("<script> ]]> \x05 \xEF\xBF\xBD", document["cases"][0]["message"]);
}

TEST_F(JsonReport, DamageLeavesNoReport) {
  samples::write_results(results_, {samples::with(Verdict::pass, "a/b")});
  std::ofstream(results_, std::ios::app) << "rubbish\n";
  EXPECT_FALSE(replay(results_, *json_report(report_)));
  EXPECT_EQ(1u, folder_.files());
}

/// 100 results with verdicts in uneven numbers, so that no two counts are alike by chance.
std::vector<results::CaseResult> uneven_results() {
  std::vector<results::CaseResult> results;
  for (std::size_t i = 0; i < text::Tally::verdicts.size(); ++i) {
    for (std::size_t n = 0; n <= i * 2; ++n) {
      results.push_back(samples::with(text::Tally::verdicts[i],
                                      "xgt_cnet/v" + std::to_string(i) + "/n" + std::to_string(n),
                                      "because"));
    }
  }
  return results;
}

TEST_F(JsonReport, AllReportsCountAlike) {
  const auto results = uneven_results();
  const json document = report(results);
  const results::Gate gate{.strict = true};
  const std::string junit_path = folder_ / "junit.xml";
  samples::hand_over(*junit_report(junit_path), samples::run_info(gate), results,
                     samples::run_end());
  text::Tally tally;
  for (const results::CaseResult& result : results) tally.add(result.verdict);

  pugi::xml_document junit;
  ASSERT_TRUE(junit.load_file(junit_path.c_str()));
  const pugi::xml_node root = junit.child("testsuites");
  const auto count = [&](Verdict verdict) {
    return document["counts"].at(std::string(results::to_string(verdict))).get<unsigned>();
  };
  EXPECT_EQ(document["counts"]["total"].get<unsigned>(), root.attribute("tests").as_uint());
  EXPECT_EQ(count(Verdict::fail) + count(Verdict::xpass) + count(Verdict::non_strict),
            root.attribute("failures").as_uint());
  EXPECT_EQ(count(Verdict::error), root.attribute("errors").as_uint());

  const std::string text = run_summary({tally, {}, {}, {}}, {.gate = gate});
  EXPECT_THAT(text, testing::HasSubstr("\n" + std::to_string(results.size()) + " cases in"));
  for (Verdict verdict : text::Tally::verdicts) {
    EXPECT_THAT(text, testing::ContainsRegex(" " + std::to_string(count(verdict)) + "  " +
                                             std::string(results::to_string(verdict)) + " "));
  }
}

}  // namespace
}  // namespace fieldproof::reports
