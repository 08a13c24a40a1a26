// What a model did, in the reports of the built tool: pictures, tables, results.
#include <gmock/gmock.h>

#include <cmath>

#include "reports/results/test_json_schema.hpp"
#include "reports/testdata/parsed_html.hpp"
#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using nlohmann::json;
using samples::ParsedHtml;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

// The worked example of MOTOS: from 5000 to 15000, 41000, back to 21000, and on to 46000.
constexpr const char* motion_case = "xnet/instruction_motos/application_relative";
constexpr const char* token_case = "xnet/timing_token/leaves";
constexpr const char* wire_case = "modbus_tcp/xinje/*";

class HtmlReportOfAModel : public testing::Test {
 protected:
  void run(const std::string& filter) {
    const Finished finished = run_tool({"run", "--profile", "emulator", "--filter", filter, "--out",
                                        folder_ / "out", "--csv", folder_ / "csv"});
    ASSERT_EQ(finished.code, 0) << finished.out << finished.err;
    EXPECT_THAT(finished.out, HasSubstr(folder_ / "csv"));
  }
  std::string page() { return read_text(folder_ / "out/report.html"); }
  /// By the schema, in both files.
  void expect_sound_results() {
    const json schema =
        json::parse(read_text(FIELDPROOF_SOURCE_DIR "/reports/results.schema.json"));
    const json written = json::parse(read_text(folder_ / "out/results.json"));
    EXPECT_THAT(results::test::JsonSchema(schema).problems(written), IsEmpty());
  }
  /// The same reports from the file of results, and from what is judged again.
  void expect_alike_again(const std::string& table) {
    const Finished again = run_tool({"report", folder_ / "out/results.ndjson", "--html",
                                     folder_ / "again.html", "--csv", folder_ / "again"});
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(read_text(folder_ / "again.html"), page());
    EXPECT_EQ(read_text(folder_ / ("again/" + table)), read_text(folder_ / ("csv/" + table)));
    run_tool({"judge", folder_ / "out/results.ndjson", "--out", folder_ / "judged"});
    const ParsedHtml judged(read_text(folder_ / "judged/report.html"));
    EXPECT_EQ(judged.count("//figure[@class='trace']"), 1u);
  }

  TestFolder folder_;
};

TEST_F(HtmlReportOfAModel, a_motion_case_shows_position_and_speed) {
  run(motion_case);
  const ParsedHtml html(page());
  EXPECT_EQ(html.count("//figure[@class='trace']/svg/polyline"), 2u);
  EXPECT_THAT(html.texts("//figure//li"), testing::Contains(EndsWith("ms MOTOS D0 D1000")));
  const json trace = read_results(folder_ / "out/results.ndjson").of(motion_case).at("trace");
  const json samples = trace.at("axes").at(0).at("samples");
  EXPECT_LE(samples.size(), 300u);
  EXPECT_EQ(samples.back().at("position"), 46000.0);
  for (const double end : {5000.0, 15000.0, 41000.0, 21000.0})
    EXPECT_TRUE(std::ranges::any_of(samples, [&](const json& one) {
      return std::abs(one.at("position").get<double>() - end) < 250;
    })) << end;
  const std::string table =
      read_text(folder_ / "csv/xnet.instruction_motos.application_relative.csv");
  EXPECT_THAT(table, AllOf(StartsWith("time_ms,axis,position,speed,event\r\n"),
                           HasSubstr(",1,,,MOTOS D0 D1000\r\n"), HasSubstr(",1,46000,0,\r\n")));
  expect_sound_results();
  expect_alike_again("xnet.instruction_motos.application_relative.csv");
}

TEST_F(HtmlReportOfAModel, a_token_case_shows_who_had_it) {
  run(token_case);
  const ParsedHtml html(page());
  EXPECT_EQ(html.texts("//figure//g/text"), (std::vector<std::string>{"1", "2", "3"}));
  EXPECT_EQ(html.count("//figure//path[@class='had']"), 3u);
  const std::string table = read_text(folder_ / "csv/xnet.timing_token.leaves.token.csv");
  EXPECT_THAT(table, StartsWith("net,station,from_ms,to_ms,busy_ms\r\n"
                                "1,1,0.000,10.000,0.000\r\n"
                                "1,2,10.000,20.000,0.000\r\n"
                                "1,3,20.000,35.000,0.000\r\n"));
  expect_sound_results();
  expect_alike_again("xnet.timing_token.leaves.token.csv");
}

TEST_F(HtmlReportOfAModel, a_case_on_a_wire_has_no_picture) {
  run(wire_case);
  EXPECT_FALSE(read_results(folder_ / "out/results.ndjson").cases.empty());
  EXPECT_EQ(ParsedHtml(page()).count("//figure"), 0u);
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "csv"));
  for (const json& one : read_results(folder_ / "out/results.ndjson").cases)
    EXPECT_FALSE(one.contains("trace"));
}

TEST_F(HtmlReportOfAModel, a_folder_that_cannot_be_made_is_named) {
  folder_.write("file", "");
  const Finished finished = run_tool({"run", "--profile", "emulator", "--filter", token_case,
                                      "--out", folder_ / "out", "--csv", folder_ / "file/csv"});
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err, AllOf(HasSubstr("file/csv"), HasSubstr("--csv")));
  EXPECT_EQ(read_results(folder_ / "out/results.ndjson").verdict(token_case), "PASS");
}

}  // namespace
}  // namespace fieldproof::tool_tests
