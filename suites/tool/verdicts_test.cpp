// Each verdict and each exit code of DESIGN's tables, made once by a real run of the built tool.
#include <gmock/gmock.h>

#include <regex>

#include "reports/testdata/parsed_html.hpp"
#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;

/// A delay of 50 ms on simulated time, and a limit so near that the answer is inside the guard
/// band.
ordered_json marginal() {
  ordered_json vector = small_vector("v/marginal");
  vector["given"]["config"] = {{"rs485", true}, {"delay_ms", 50}};
  vector["steps"][1]["within"] = "53ms";
  return vector;
}

ordered_json below_floor() {
  ordered_json vector = small_vector("v/below_floor");
  vector["steps"][1]["within"] = "20ms";
  return vector;
}

/// No device of these can do it.
ordered_json unknown_action() {
  ordered_json vector = small_vector("v/unknown_action");
  vector["steps"] = {{{"do", "explode"}}};
  return vector;
}

ordered_json impossible_line() {
  ordered_json vector = small_vector("v/impossible_line");
  vector["given"]["config"]["line"] = "9600-9X9";
  return vector;
}

ordered_json alternative(const char* id) {
  return small_vector(id, {{"reading", "word"}, {"one", wrong_word}, {"zero", zero_word}});
}

struct Expectation {
  ordered_json vector;
  std::string verdict;
  std::string junit;  // element of the test case: plain, noted, failure, skipped, error
  int alone;          // exit code of a run of this case alone
  std::vector<std::string> strict_option;  // makes it red
};

const std::vector<Expectation>& expectations() {
  static const std::vector<Expectation> all{
      {small_vector("v/pass"), "PASS", "plain", 0, {}},
      {marginal(), "MARGINAL", "noted", 0, {"--fail-on", "marginal"}},
      {alternative("v/alternative"), "NON-STRICT", "noted", 0, {"--strict"}},
      {with(small_vector("v/should_missed", wrong_word), "level", "should"),
       "NON-STRICT",
       "noted",
       0,
       {"--strict"}},
      {with(small_vector("v/info", wrong_word), "level", "info"), "INFO", "noted", 0, {}},
      {small_vector("v/fail", wrong_word), "FAIL", "failure", 1, {}},
      {small_vector("v/waived", wrong_word), "XFAIL", "skipped", 0, {}},
      {small_vector("v/waived_in_vain"), "XPASS", "failure", 1, {}},
      {with(small_vector("v/other_model"), "models", {"xec-h"}), "SKIP", "skipped", 4, {}},
      {unknown_action(), "BLOCKED", "skipped", 4, {"--qualify"}},
      {below_floor(), "INCONCLUSIVE", "skipped", 4, {"--qualify"}},
      {impossible_line(), "ERROR", "error", 3, {}},
  };
  return all;
}

std::string id_of(const Expectation& one) { return one.vector.at("id"); }

/// The files of a run of all these vectors.
class Verdicts : public testing::Test {
 protected:
  Verdicts() {
    std::vector<ordered_json> vectors;
    for (const Expectation& one : expectations()) vectors.push_back(one.vector);
    vectors_ = write_vectors(folder_, vectors);
    waivers_ = folder_.write("waivers.json", R"([
      {"id": "xgt_cnet/v/waived", "reason": "known fault of this firmware", "owner": "bench", "text": "data:", "expires": "2999-01-01"},
      {"id": "xgt_cnet/v/waived_in_vain", "reason": "was a fault once", "owner": "bench", "text": "data:", "expires": "2999-01-01"}])");
  }

  Finished run(const std::string& filter, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{
        "run",     "--endpoint", "emulator:xbc-h", "--vectors", vectors_, "--waivers",    waivers_,
        "--floor", "30ms",       "--filter",       filter,      "--out",  folder_ / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(arguments);
  }
  Results results() { return read_results(folder_ / "out/results.ndjson"); }

  TestFolder folder_;
  std::string vectors_, waivers_;
};

TEST_F(Verdicts, each_is_produced) {
  const Finished finished = run("*");
  const Results all = results();
  for (const Expectation& one : expectations())
    EXPECT_EQ(all.verdict(id_of(one)), one.verdict)
        << id_of(one) << ": " << all.of(id_of(one)).dump(1);
  EXPECT_EQ(all.counts().size(), 11u) << "every verdict";
  EXPECT_EQ(finished.code, 3) << "trouble goes before failure";
  expect_reports(folder_ / "out");
}

TEST_F(Verdicts, junit_shows_each_as_the_design_says) {
  run("*");
  Junit junit;
  read_junit(folder_ / "out/junit.xml", junit);
  for (const Expectation& one : expectations()) {
    const pugi::xml_node node =
        junit
            .cases["fieldproof.xgt_cnet.v " + id_of(one).substr(std::string("xgt_cnet/v/").size())];
    ASSERT_TRUE(node) << id_of(one);
    std::string element = "plain";
    for (const char* name : {"failure", "skipped", "error"})
      if (node.child(name)) element = name;
    const bool noted =
        std::string(node.child_value("system-out")).find(one.verdict) != std::string::npos;
    EXPECT_EQ(element == "plain" && noted ? "noted" : element, one.junit) << id_of(one);
    if (element == "plain") continue;
    EXPECT_EQ(node.child(element.c_str()).attribute("type").value(), one.verdict) << id_of(one);
  }
}

/// Console, JSON, JUnit, HTML and exit code tell of the same run.
TEST_F(Verdicts, every_report_counts_alike) {
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{}, {"--strict", "--qualify", "--fail-on", "marginal"}}) {
    const Finished finished = run("*", options);
    const std::map<std::string, std::size_t> counts = results().counts();
    const std::string html = read_text(folder_ / "out/report.html");
    const samples::ParsedHtml page(html);
    EXPECT_TRUE(samples::xmllint_accepts(folder_ / "out/report.html"));
    const auto written = nlohmann::json::parse(read_text(folder_ / "out/results.json"))["counts"];
    Junit junit;
    read_junit(folder_ / "out/junit.xml", junit);
    ASSERT_EQ(counts.size(), 11u);
    std::size_t red = 0;
    for (const auto& [verdict, count] : counts) {
      EXPECT_EQ(page.tile(verdict), count) << verdict;
      EXPECT_EQ(written[verdict], count) << verdict;
      EXPECT_TRUE(std::regex_search(
          finished.out, std::regex(" +" + std::to_string(count) + "  " + verdict + " ")))
          << verdict << '\n'
          << finished.out;
      const std::string cell =
          "//details[@class='section']/summary/span[@data-verdict='" + verdict + "']";
      EXPECT_EQ(page.text(cell), std::to_string(count))
          << verdict << ": all vectors of these tests are of one section";
      const bool always = verdict == "FAIL" || verdict == "XPASS" || verdict == "ERROR";
      const bool judged = verdict == "NON-STRICT" || verdict == "MARGINAL",
                 unjudged = verdict == "BLOCKED" || verdict == "INCONCLUSIVE";
      if (always || (!options.empty() && (judged || unjudged))) red += count;
    }
    EXPECT_EQ(page.text("//h2[@id='red']"), std::to_string(red) + " cases turn the gate red");
    const std::size_t not_judged =
        options.empty() ? 0 : counts.at("BLOCKED") + counts.at("INCONCLUSIVE");
    EXPECT_EQ(results().gate_cases(), options.empty() ? 0u : 1u) << "not qualified";
    const std::size_t by_cases = junit.failures + junit.errors - results().gate_cases();
    EXPECT_EQ(by_cases + not_judged, red);
    EXPECT_THAT(page.text("//p[@class='detail']"),
                HasSubstr("(exit " + std::to_string(finished.code) + ")"));
    EXPECT_EQ(page.count("//section[@class='sheet']"), options.empty() ? 0u : 1u);
  }
}

TEST_F(Verdicts, exit_code_of_each_alone) {
  for (const Expectation& one : expectations()) {
    const Finished finished = run(id_of(one));
    EXPECT_EQ(finished.code, one.alone) << id_of(one) << '\n' << finished.out << finished.err;
    EXPECT_THAT(finished.out, HasSubstr("exit " + std::to_string(one.alone) + ": ")) << id_of(one);
    EXPECT_EQ(results().end.at("exit_code"), one.alone) << id_of(one);
  }
}

TEST_F(Verdicts, option_turns_each_red) {
  for (const Expectation& one : expectations()) {
    if (one.strict_option.empty()) continue;
    const Finished finished = run(id_of(one), one.strict_option);
    EXPECT_EQ(finished.code, 1) << id_of(one) << " with " << one.strict_option.front() << '\n'
                                << finished.out;
  }
}

TEST_F(Verdicts, strict_shows_non_strict_as_failure) {
  run("xgt_cnet/v/alternative", {"--strict"});
  Junit junit;
  read_junit(folder_ / "out/junit.xml", junit);
  EXPECT_EQ(junit.with("failure"), 1u);
  expect_reports(folder_ / "out");
}

TEST_F(Verdicts, expired_waiver_is_red) {
  const std::string expired = folder_.write(
      "expired.json",
      R"([{"id": "xgt_cnet/v/fail", "reason": "known fault", "owner": "bench", "text": "data:", "expires": "2020-01-01"}])");
  const Finished finished = run_tool({"run", "--vectors", vectors_, "--filter", "xgt_cnet/v/fail",
                                      "--waivers", expired, "--out", folder_ / "out"});
  EXPECT_EQ(finished.code, 1);
  EXPECT_EQ(results().verdict("xgt_cnet/v/fail"), "FAIL");
  EXPECT_THAT(finished.out, HasSubstr("expired on 2020-01-01"));
}

TEST_F(Verdicts, waiver_for_another_failure_is_red) {
  const std::string other = folder_.write(
      "other.json",
      R"([{"id": "xgt_cnet/v/fail", "reason": "known fault", "owner": "bench", "text": "no answer", "expires": "2999-01-01"}])");
  const Finished finished = run_tool({"run", "--vectors", vectors_, "--filter", "xgt_cnet/v/fail",
                                      "--waivers", other, "--out", folder_ / "out"});
  EXPECT_EQ(finished.code, 1);
  EXPECT_EQ(results().verdict("xgt_cnet/v/fail"), "FAIL");
}

TEST_F(Verdicts, mixed_readings_are_non_strict) {
  ordered_json other = alternative("v/other_reading");
  other["steps"][1]["expect"] = {{"reading", "word"}, {"one", zero_word}, {"zero", wrong_word}};
  const TestFolder folder;
  const std::string vectors = write_vectors(folder, {alternative("v/a_reading"), other});
  const Finished finished = run_tool({"run", "--vectors", vectors, "--out", folder / "out"});
  EXPECT_EQ(finished.code, 0) << finished.out;
  const Results mixed = read_results(folder / "out/results.ndjson");
  EXPECT_EQ(mixed.verdict("xgt_cnet/v/other_reading"), "NON-STRICT");
  EXPECT_THAT(mixed.of("xgt_cnet/v/other_reading").at("message").get<std::string>(),
              HasSubstr("mixes readings"));
}

TEST(ExitCodes, usage_is_2) { EXPECT_EQ(run_tool({"run", "--no-such-option"}).code, 2); }

TEST(ExitCodes, absent_hardware_is_3_and_77_when_it_may_be_absent) {
  const TestFolder folder;
  const std::vector<std::string> arguments{
      "run",         "--endpoint", "serial:" + (folder / "no_such_port"),           "--profile",
      "xbc-h",       "--vectors",  write_vectors(folder, {small_vector("v/pass")}), "--out",
      folder / "out"};
  std::vector<std::string> tolerant = arguments;
  tolerant.push_back("--skip-absent");
  const Finished strict = run_tool(arguments);
  EXPECT_EQ(strict.code, 3);
  EXPECT_THAT(strict.err, HasSubstr("there is no such port"));
  EXPECT_EQ(run_tool(tolerant).code, 77);
}

/// A real device is not written to unless that is allowed, and what was not written is told apart
/// from what passed.
TEST(ExitCodes, fence_blocks_and_nothing_executed_is_4) {
  ordered_json write = small_vector("v/write", "[ACK st 'wSS' ETX BCC]");
  write["steps"][0]["send"] = "[ENQ st 'wSS' '01' name(%MW100) '1234' EOT BCC]";
  const TestFolder folder;
  const std::string device =
      "exec:/usr/bin/python3 " FIELDPROOF_SOURCE_DIR "/suites/tool/testdata/device.py good {tty}";
  const Finished finished =
      run_tool({"run", "--endpoint", device, "--profile", "xbc-h", "--read-only", "--vectors",
                write_vectors(folder, {write}), "--out", folder / "out"});
  EXPECT_EQ(finished.code, 4) << finished.out << finished.err;
  const Results results = read_results(folder / "out/results.ndjson");
  EXPECT_EQ(results.verdict("xgt_cnet/v/write"), "BLOCKED");
  EXPECT_THAT(results.of("xgt_cnet/v/write").at("message").get<std::string>(),
              HasSubstr("--allow-write M100"));
}

/// Silence at the start is trouble of the bench, not failure of the device.
TEST(ExitCodes, silence_at_the_start_is_3) {
  const TestFolder folder;
  const Finished finished =
      run_tool({"run", "--endpoint", "exec:cat {tty} >/dev/null", "--profile", "xbc-h", "--vectors",
                write_vectors(folder, {small_vector("v/pass")}), "--out", folder / "out"});
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err, HasSubstr("nothing answers on exec:"));
  expect_reports(folder / "out");
}

}  // namespace
}  // namespace fieldproof::tool_tests
