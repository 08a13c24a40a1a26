// The HTML report and the bench file, by runs of the built tool.
#include <gmock/gmock.h>

#include "reports/testdata/parsed_html.hpp"
#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using samples::ParsedHtml;
using testing::HasSubstr;

constexpr const char* bench_file = R"({"devices": {
  "stand_in": {"endpoint": "emulator:xbc-h", "profile": "xbc-h", "station": 5, "line": "19200-8N1",
               "identity": {"maker": "LS ELECTRIC", "model": "XBC-DN32H", "serial": "S7", "firmware": "V1.8"},
               "allow_write": ["M100-M199"], "operator": "J. Kim", "notes": "a <note>"}}})";

class HtmlReport : public testing::Test {
 protected:
  HtmlReport()
      : vectors_(write_vectors(folder_, {small_vector("v/pass")})),
        bench_(folder_.write("bench.json", bench_file)) {}

  Finished run(std::vector<std::string> more) {
    std::vector<std::string> arguments{"run", "--vectors", vectors_, "--out", folder_ / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(arguments);
  }
  std::string page() { return read_text(folder_ / "out/report.html"); }
  static std::string fact(const ParsedHtml& page, const std::string& name) {
    return page.text("//table[@class='facts']//tr[th='" + name + "']/td");
  }

  TestFolder folder_;
  std::string vectors_, bench_;
};

TEST_F(HtmlReport, the_whole_suite_stays_small) {
  const std::string path = default_run().out() + "/report.html", html = read_text(path);
  const std::size_t cases = default_run().results.cases.size();
  EXPECT_GT(cases, 1000u);
  EXPECT_LT(html.size() / cases, (2u << 20) / 3000u) << "2 MiB for 3,000 cases";
  EXPECT_TRUE(samples::xmllint_accepts(path));
  const ParsedHtml page(html);
  EXPECT_EQ(page.count("//table[@class='passes']//tr"), page.tile("PASS"));
}

TEST_F(HtmlReport, goes_where_it_is_told) {
  EXPECT_EQ(run({"--html", folder_ / "mine.html"}).code, 0);
  EXPECT_EQ(ParsedHtml(read_text(folder_ / "mine.html")).tile("PASS"), 1u);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/report.html"));
}

TEST_F(HtmlReport, is_derived_alike_from_the_results) {
  run({"--qualify"});
  const Finished report =
      run_tool({"report", folder_ / "out/results.ndjson", "--html", folder_ / "again.html"});
  EXPECT_EQ(report.code, 0) << report.err;
  EXPECT_EQ(read_text(folder_ / "again.html"), page());
}

TEST_F(HtmlReport, sheet_has_the_hashes_of_what_was_run) {
  run({"--qualify", "--profile", "xbc-h"});
  const ParsedHtml sheet(page());
  const auto sum = [](const std::string& path) {
    return run_program({"sha256sum", path}).out.substr(0, 64);
  };
  const auto row = [&](const std::string& name) {
    return sheet.text("//section[@class='sheet']//tr[th='SHA-256 of " + name + "']/td");
  };
  EXPECT_EQ(row("tool"), sum(FIELDPROOF_TOOL));
  EXPECT_EQ(row("profile xbc-h"), sum(FIELDPROOF_SOURCE_DIR "/suites/profiles/xbc-h.json"));
  EXPECT_EQ(row("the log"), sum(folder_ / "out/results.ndjson"));
  const std::string list =
      "cd " + fieldproof::tool_tests::quoted(vectors_) +
      " && find . -type f -printf '%P\\n' | LC_ALL=C sort | xargs sha256sum | sha256sum";
  EXPECT_EQ(row("vectors"), run_program({"bash", "-c", list}).out.substr(0, 64));
}

TEST_F(HtmlReport, errata_of_the_cases_that_ran_are_listed) {
  nlohmann::ordered_json vector = small_vector("v/erratum");
  vector["statement"] = "m/2";
  folder_.write("vectors/manuals.json",
                R"([{"id": "m", "file": "m.txt", "title": "T", "edition": ""}])");
  folder_.write("vectors/statements/m.json",
                R"([{"id": "m/1", "section": "1", "quote": "as it is printed here"},
                    {"id": "m/2", "section": "2", "quote": "the name is six characters"}])");
  folder_.write("vectors/errata/m.json", R"([{"id": "m/name", "kind": "wrong bytes",
    "places": ["m/2"], "printed": "H2550", "right": "H255057", "proof": ["m/1"],
    "why": "the name is six characters", "effect": "sends a name of five"}])");
  const std::string vectors = write_vectors(folder_, {small_vector("v/pass"), vector});
  run_tool({"run", "--vectors", vectors, "--out", folder_ / "out"});
  EXPECT_EQ(ParsedHtml(page()).text("//table[@class='list errata']/tbody//small"),
            "m/name: wrong bytes");
  run_tool({"run", "--vectors", vectors, "--out", folder_ / "out", "--filter", "*/pass"});
  EXPECT_EQ(ParsedHtml(page()).count("//h2[@id='errata']"), 0u);
}

TEST_F(HtmlReport, device_of_the_bench_file_is_run_and_named) {
  const Finished finished = run({"--bench", bench_, "--dut", "stand_in"});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  const ParsedHtml report(page());
  EXPECT_EQ(report.text("//p[@class='device']"),
            "Conformance of LS ELECTRIC XBC-DN32H, firmware V1.8");
  EXPECT_EQ(fact(report, "serial number"), "S7");
  EXPECT_EQ(fact(report, "station"), "5");
  EXPECT_EQ(fact(report, "line"), "19200-8N1");
  EXPECT_EQ(fact(report, "profile"), "xbc-h");
  EXPECT_EQ(fact(report, "operator"), "J. Kim");
  EXPECT_EQ(fact(report, "notes"), "a <note>");
  EXPECT_EQ(fact(report, "bench entry"), "stand_in");
  const nlohmann::json one = read_results(folder_ / "out/results.ndjson").of("xgt_cnet/v/pass");
  EXPECT_THAT(one.at("replay").get<std::string>(),
              HasSubstr("--endpoint 'emulator:xbc-h?station=5&line=19200-8N1' --profile xbc-h"))
      << "it needs no bench file";
}

TEST_F(HtmlReport, options_win_over_the_bench_file) {
  const Finished finished = run({"--bench", bench_, "--dut", "stand_in", "--endpoint",
                                 "emulator:xbm-s", "--profile", "xbm-s"});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  const ParsedHtml report(page());
  EXPECT_EQ(fact(report, "profile"), "xbm-s");
  EXPECT_EQ(fact(report, "station"), "1") << "the station belongs to the other endpoint";
  EXPECT_EQ(fact(report, "model"), "XBC-DN32H") << "the identity is still what was named";
}

TEST_F(HtmlReport, wrong_bench_files_are_exit_2) {
  const Finished unknown = run({"--bench", bench_, "--dut", "standin"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'stand_in'?"));
  EXPECT_EQ(run({"--bench", bench_}).code, 2);
  EXPECT_EQ(run({"--dut", "stand_in"}).code, 2);
  const Finished broken =
      run({"--bench",
           folder_.write("broken.json",
                         R"({"devices": {"d": {"endpoint": "emulator:", "statoin": 1}}})"),
           "--dut", "d"});
  EXPECT_EQ(broken.code, 2);
  EXPECT_THAT(broken.err, HasSubstr("devices.d: unknown key 'statoin'; did you mean 'station'?"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out")) << "nothing was run";
}

}  // namespace
}  // namespace fieldproof::tool_tests
