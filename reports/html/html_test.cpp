#include "reports/html/html.hpp"

#include <gmock/gmock.h>

#include <fmt/format.h>

#include "reports/html/html_case.hpp"
#include "reports/html/html_survey.hpp"
#include "reports/results/sha256.hpp"
#include "reports/testdata/parsed_html.hpp"
#include "reports/testdata/samples.hpp"

namespace fieldproof::html {

using results::CaseResult;
using results::Gate;
using results::RunEnd;
using results::RunInfo;
using results::Verdict;

namespace {

using samples::ParsedHtml;
using samples::with;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// As a healthy device leaves them: about what a case of the suites has.
CaseResult passed(std::size_t number) {
  CaseResult result = samples::failure();
  result.id = fmt::format("xgt_cnet/rss/a_case_with_an_id_of_usual_length/lower/number_{}", number);
  result.title =
      "Read one word from M100 and one from P001 of station 1: ACK, two blocks of two bytes, 1234 "
      "and 5678";
  result.verdict = Verdict::pass;
  result.message = result.expected = result.expected_hex = result.received = "";
  result.expected_bytes = result.received_bytes = {};
  result.differences = {};
  result.notes = {};
  return result;
}

class Html : public testing::Test {
 protected:
  std::string report(const std::vector<CaseResult>& results, const results::Gate& gate = {},
                     bool end = true) {
    samples::write_results(results_, results, end, gate);
    return render();
  }

  std::string report(RunInfo run, const std::vector<CaseResult>& results, const RunEnd& end,
                     const Gate& gate = {}) {
    run.properties["gate"] = text::to_string(gate);
    {
      auto writer = results::NdjsonWriter::create(results_);
      EXPECT_TRUE(writer);
      samples::hand_over(*writer, run, results, end);
    }
    return render();
  }

  std::string render() {
    const auto log = replay(results_, *html_report(report_));
    EXPECT_TRUE(log) << log.error().message;
    return samples::read_file(report_);
  }

  samples::Folder folder_;
  std::string results_ = folder_ / "results.ndjson";
  std::string report_ = folder_ / "report.html";
};

TEST_F(Html, TheVerdictOfTheGateStandsAtTheTop) {
  results::RunEnd end = samples::run_end();
  end.add({1, "verdicts", "conformance failed: 1 FAIL"});
  const ParsedHtml page(report(samples::run_info(),
                               {samples::failure(), samples::with(Verdict::pass, "a/one"),
                                samples::with(Verdict::skip, "a/two", "other model")},
                               end));
  EXPECT_EQ("\u2717 Conformance failed", page.text("//body/main/*[1]/h1"));
  EXPECT_EQ("conformance failed: 1 FAIL (exit 1)", page.text("//p[@class='detail']"));
  EXPECT_EQ(1u, page.tile("FAIL"));
  EXPECT_EQ(1u, page.tile("PASS"));
  EXPECT_EQ(1u, page.tile("SKIP"));
  EXPECT_EQ(0u, page.tile("ERROR"));
  EXPECT_TRUE(samples::xmllint_accepts(report_));
}

TEST_F(Html, AMetGateSaysSo) {
  const ParsedHtml page(
      report(samples::run_info(), {samples::with(Verdict::pass, "a/one")}, samples::run_end(0)));
  EXPECT_EQ("\u2713 Gate met", page.text("//h1"));
  EXPECT_EQ("gate met: 1 of 1 judged (exit 0)", page.text("//p[@class='detail']"));
  EXPECT_EQ(0u, page.count("//h2[@id='red']"));
}

TEST_F(Html, AKilledRunIsNoSuccess) {
  const ParsedHtml page(report({samples::with(Verdict::pass, "a/one")}, {}, false));
  EXPECT_EQ("\u2717 Killed before its end", page.text("//h1"));
  EXPECT_THAT(page.text("//p[@class='detail']"),
              HasSubstr("the run was killed: 1 results were written before"));
}

TEST_F(Html, ARunWithoutAResultHasAReport) {
  results::RunEnd end = samples::run_end(3);
  end.add({3, "trouble", "bench trouble: nothing answers on serial:/dev/ttyUSB0"});
  const ParsedHtml page(report(samples::run_info(), {}, end));
  EXPECT_EQ("\u2717 Bench trouble", page.text("//h1"));
  EXPECT_EQ("bench trouble: nothing answers on serial:/dev/ttyUSB0 (exit 3)",
            page.text("//p[@class='detail']"));
}

TEST_F(Html, IdentityAndRunAreNamed) {
  results::RunInfo run = samples::run_info();
  run.identity = {"c41a", "LS ELECTRIC", "XBL-C41A", "2219-00417", "V1.41", "J. Kim", "port 2", {},
                  {}};
  const ParsedHtml page(report(run, {samples::with(Verdict::pass, "a/one")}, samples::run_end(0)));
  const auto fact = [&](const std::string& name) {
    return page.text("//table[@class='facts']//tr[th='" + name + "']/td");
  };
  EXPECT_EQ("Conformance of LS ELECTRIC XBL-C41A, firmware V1.41",
            page.text("//p[@class='device']"));
  EXPECT_EQ("LS ELECTRIC", fact("maker"));
  EXPECT_EQ("XBL-C41A", fact("model"));
  EXPECT_EQ("2219-00417", fact("serial number"));
  EXPECT_EQ("V1.41", fact("firmware"));
  EXPECT_EQ("J. Kim", fact("operator"));
  EXPECT_EQ("port 2", fact("notes"));
  EXPECT_EQ("9600-8N1", fact("line"));
  EXPECT_EQ("emulator:xbc-h?station=1", fact("endpoint"));
  EXPECT_EQ("2026-11-21T12:39:03+00:00", fact("date"));
  EXPECT_EQ("2.2 s", fact("duration"));
  EXPECT_EQ("0.1.0", fact("fieldproof"));
  EXPECT_EQ("a1b2", fact("vectors"));
  EXPECT_EQ("7", fact("seed"));
}

TEST_F(Html, AFailureTellsItsWholeStory) {
  const ParsedHtml page(report({samples::failure()}));
  const std::string block = "//h2[@id='red']/following::details[1]";
  EXPECT_EQ("open", page.text(block).empty() ? "" : "open");
  EXPECT_EQ(1u, page.count("//details[@id='red-1' and @open='open']"));
  EXPECT_EQ("xgt_cnet/rss/one_word", page.text(block + "/summary/b"));
  EXPECT_EQ("BCC: expected 0F, received 09 (the sum leaves out the header)",
            page.text(block + "/summary/span[@class='message']"));
  EXPECT_EQ("xgb-cnet-en-1.6, 7.1.5 (1)(e)", page.text(block + "/p[@class='clause']/b"));
  EXPECT_EQ("BCC is the low byte of the sum from ENQ to EOT", page.text(block + "//q"));
  EXPECT_THAT(page.texts(block + "/table[@class='differences']/tbody/tr/td"),
              ElementsAre("BCC", "0F", "09", "the sum leaves out the header"));
  EXPECT_THAT(page.texts(block + "/table[@class='monitor']/tbody/tr/@class/.."),
              testing::SizeIs(4));
  EXPECT_EQ("ENQ '01rSS0106%MW100' EOT 'A3'",
            page.text(block + "//tr[@class='sent']//code[@class='notation']"));
  EXPECT_EQ("[ACK st 'rSS' '01' '02' '1234' ETX BCC]",
            page.text(block + "//tr[@class='expected']//code[@class='notation']"));
  EXPECT_THAT(page.texts(block + "//tr[@class='judged']/td[@class='num']"),
              ElementsAre("24.000", "4.208"));
  EXPECT_THAT(page.texts(block + "//tr[@class='judged']//mark"), ElementsAre("39"));
  EXPECT_EQ("fieldproof run --filter xgt_cnet/rss/one_word --endpoint emulator:xbc-h",
            page.text(block + "/pre[@class='replay']"));
  EXPECT_THAT(page.text(block + "/ul"), HasSubstr("reply after 4.208 ms"));
  EXPECT_EQ(
      "#red-1",
      std::string(page.count("//table[@class='lines']//a[@href='#red-1']") == 1 ? "#red-1" : ""))
      << "its section leads here";
}

TEST_F(Html, TheSameFailureIsToldOnce) {
  std::vector<CaseResult> results;
  for (int i = 1; i <= 20; ++i) {
    results.push_back(samples::failure());
    results.back().id = "xgt_cnet/rss/n" + std::to_string(i);
  }
  const ParsedHtml page(report(results));
  EXPECT_EQ("20 \u00D7 " + samples::failure().message, page.text("//section[@class='cause']/h3"));
  EXPECT_THAT(page.texts("//section[@class='cause']/details/summary/b"),
              ElementsAre("xgt_cnet/rss/n1", "xgt_cnet/rss/n2", "xgt_cnet/rss/n3"));
  EXPECT_EQ(1u, page.count("//section[@class='cause']/details[@open='open']")) << "in full";
  EXPECT_EQ("17 more are alike; their sections list them",
            page.text("//section[@class='cause']/p[@class='ids']"));
  EXPECT_EQ(20u, page.count("//table[@class='lines']//tr")) << "each stands in its section";
  EXPECT_EQ(18u, page.count("//table[@class='lines']//a[@href='#red-1']"));
}

TEST_F(Html, CausesOfManyCasesStandFirst) {
  std::vector<CaseResult> results;
  const auto add = [&](const char* id, const char* message) {
    results.push_back(with(Verdict::fail, id, message));
  };
  add("a/1", "no answer within 500 ms");
  add("a/2", "BCC: expected 0F, got 09");
  add("a/3", "BCC: expected 1A, got 14");
  const ParsedHtml page(report(results));
  EXPECT_EQ("2 \u00D7 BCC: expected \u2026, got \u2026", page.text("//section[@class='cause']/h3"));
  EXPECT_THAT(page.texts("//details[starts-with(@id, 'red-')]/summary/b"),
              ElementsAre("a/2", "a/3", "a/1"));
}

TEST_F(Html, BlockedIsGroupedByWhatWouldUnblock) {
  const ParsedHtml page(
      report({with(Verdict::blocked, "a/1", "needs delay_ms = 50; the profile declares 0"),
              with(Verdict::blocked, "a/2", "needs neighbours = 2; the profile declares nothing"),
              with(Verdict::blocked, "a/3",
                   "needs a device fresh from power-on; give "
                   "--power-cycle COMMAND"),
              with(Verdict::skip, "a/4", "for xec-h; the profile declares xbc-h")}));
  EXPECT_THAT(page.texts("//h3[span[contains(@class, 'verdict')]]"),
              ElementsAre("BLOCKED 3 blocked, by what would let them run",
                          "SKIP 1 skipped: outside the profile of the device"));
  EXPECT_THAT(page.texts("//table[@class='list unjudged'][1]//td[1]"), ElementsAre("2", "1"));
  EXPECT_THAT(
      page.texts("//table[@class='list unjudged'][1]//summary"),
      ElementsAre(
          "other settings: marks in the command of exec:, --control, \"config\" of the profile",
          "a device fresh from power-on: --power-cycle COMMAND"));
  EXPECT_THAT(page.texts("//table[@class='list unjudged'][1]//tr[1]//p"),
              ElementsAre("1 \u00D7 needs delay_ms = 50; the profile declares 0a/1",
                          "1 \u00D7 needs neighbours = 2; the profile declares nothinga/2"));
}

TEST_F(Html, SectionsHaveTheirTitles) {
  RunInfo run = samples::run_info();
  run.sections = {{"xgb-cnet-en-1.6", {{"7.1.5", "Detail of instruction"}}}};
  const ParsedHtml page(report(run, {samples::failure()}, samples::run_end()));
  EXPECT_EQ("7.1.5 (1)(e)Detail of instruction",
            page.text("//details[@class='section']/summary/span[@class='name']"));
  EXPECT_EQ("Detail of instruction", page.text("//p[@class='clause']/span[@class='of']"));
}

TEST_F(Html, OfAFloodThereIsAnExtract) {
  CaseResult flooded = samples::failure();
  flooded.received_bytes.assign(64, 0x41);
  flooded.received_extract = {16'500, Bytes(64, 0x42), std::string(64, 'a')};
  flooded.exchange[1].bytes = flooded.received_bytes;
  flooded.exchange[1].extract = flooded.received_extract;
  const ParsedHtml page(report({flooded}));
  const std::string hex = "//tr[@class='judged']//code[@class='hex']";
  EXPECT_THAT(page.text(hex),
              AllOf(HasSubstr("... 16,372 bytes left out ..."), HasSubstr("42 42 42"),
                    HasSubstr("16,500 bytes in all, sha256 " + std::string(64, 'a'))));
  EXPECT_LT(std::filesystem::file_size(report_), 40'000u);
}

TEST_F(Html, NoAnswerIsShownWhereItWasExpected) {
  CaseResult silent = samples::failure();
  silent.received = "";
  silent.received_bytes = {};
  silent.exchange.resize(1);
  const ParsedHtml page(report({silent}));
  EXPECT_THAT(page.texts("//table[@class='monitor']/tbody/tr/td[3]"),
              ElementsAre("\u2192", "expected", "\u2190"));
  EXPECT_EQ("nothing", page.text("//tr[@class='judged']//code"));
}

TEST_F(Html, APassIsOneLineWithItsBytes) {
  const ParsedHtml page(report({passed(1)}));
  EXPECT_EQ(
      "\u2192 05 30 31 72 53 53 30 31 30 36 25 4D 57 31 30 30 04 41 33 \u2190 06 30 31 72 53 53 30 "
      "31 30 32 31 32 33 34 03 30 39",
      page.text("//table[@class='passes']//td[1]"));
  EXPECT_EQ("4.208", page.text("//table[@class='passes']//td[2]"));
}

TEST_F(Html, ACaseOfAModelSaysItsKindInItsLine) {
  CaseResult one = passed(1);
  one.on_model = "timing";
  const ParsedHtml page(report({one}));
  EXPECT_EQ("timing, on a model", page.text("//table[@class='passes']//small[@class='kind']"));
}

TEST_F(Html, SectionsCountByVerdict) {
  auto other = samples::with(Verdict::pass, "a/two");
  other.manual = "xgb-cnet-en-1.6";
  other.section = "7.1.10";
  const ParsedHtml page(report({other, samples::failure()}));
  EXPECT_THAT(page.texts("//details[@class='section']/summary/span[@class='name']"),
              ElementsAre("7.1.5 (1)(e)", "7.1.10"));
  EXPECT_THAT(page.texts("//details[@class='section'][1]/summary/span[@data-verdict]"),
              ElementsAre("\u00B7", "1"));
  EXPECT_THAT(page.texts("//details[@class='section'][2]/summary/span[@data-verdict]"),
              ElementsAre("1", "\u00B7"));
  EXPECT_EQ("\u00B7", page.text("//details[@class='section'][2]/summary/span[@class='none']"));
}

TEST_F(Html, TheQualificationSheetCanBeSigned) {
  results::RunInfo run = samples::run_info();
  run.identity.fingerprint = {{"areas", "PML"}};
  run.identity.fingerprint_found = {{"areas", "PM"}};
  run.hashes = {{"tool", "00ff"}, {"vectors", "11ee"}};
  const ParsedHtml page(report(run, {samples::with(Verdict::blocked, "a/one", "needs M")},
                               samples::run_end(1), {.qualify = true}));
  const std::string sheet = "//section[@class='sheet']";
  EXPECT_EQ(1u, page.count(sheet));
  EXPECT_THAT(page.texts(sheet + "//div[@class='signatures']//p"),
              ElementsAre("Name", "Date", "Signature", "Name", "Date", "Signature"));
  EXPECT_THAT(page.texts(sheet + "//tr[th='areas']/td"), ElementsAre("PML", "PM (differs)"));
  EXPECT_EQ("00ff", page.text(sheet + "//tr[th='SHA-256 of tool']/td"));
  EXPECT_EQ(*results::sha256_of_file(results_),
            page.text(sheet + "//tr[th='SHA-256 of the log']/td"));
  EXPECT_THAT(page.texts(sheet + "//table[@class='list one-line']//td"),
              ElementsAre("BLOCKED", "1", "needs M"));
  EXPECT_THAT(page.text("//table[@class='list unjudged']//details"), HasSubstr("a/one"));
}

TEST_F(Html, TheSheetHasALineAReasonAndNoListOfOtherModels) {
  std::vector<CaseResult> results;
  for (int station = 0; station < 60; ++station) {
    const std::string n = std::to_string(station);
    results.push_back(with(Verdict::blocked, "a/b" + n, "is about station " + n));
    results.push_back(with(Verdict::skip, "a/s" + n, "for model " + n));
    results.push_back(with(Verdict::fail, "a/f" + n, "BCC: expected " + n + "0, got 00"));
  }
  const ParsedHtml page(report(results, {.qualify = true}));
  const std::string sheet = "//section[@class='sheet']";
  EXPECT_THAT(
      page.texts(sheet + "//table[@class='list one-line']//td"),
      ElementsAre(
          "BLOCKED", "60",
          "the station that the case is about: {station} in the command of exec:, --control",
          "SKIP", "60", "other models and protocols: outside the profile of the device"));
  EXPECT_THAT(page.texts(sheet + "//table[@class='list']//tbody/tr[1]/td"),
              ElementsAre("60", "BCC: expected \u2026, got \u2026", "a/f0"));
}

TEST_F(Html, WithoutQualifyThereIsNothingToSign) {
  const ParsedHtml page(report({samples::with(Verdict::pass, "a/one")}));
  EXPECT_EQ(0u, page.count("//section[@class='sheet']"));
  EXPECT_EQ(0u, page.count("//div[@class='signatures']"));
}

TEST_F(Html, EachVerdictIsExplained) {
  const ParsedHtml page(report({samples::with(Verdict::pass, "a/one")}));
  EXPECT_EQ(text::Tally::verdicts.size(), page.count("//ul[@class='legend']/li"));
  EXPECT_EQ("NON-STRICT an allowed alternative, or a SHOULD missed; red with --strict",
            page.text("//ul[@class='legend']/li[3]"));
}

TEST_F(Html, HostileBytesSurvive) {
  const std::string hostile =
      "</td></script><script>alert(1)</script> ]]> <!-- &#5; \x05\x7F\xFF\xC3\x28 \xED\xA0\x80 "
      "\"'&\r\n";
  results::RunInfo run = samples::run_info();
  run.endpoint = run.command = run.profile = hostile;
  run.identity = {
      hostile, hostile, hostile, hostile, hostile, hostile, hostile, {{hostile, hostile}}, {}};
  run.hashes = {{hostile, hostile}};
  run.errata = {{hostile,
                 hostile,
                 hostile,
                 hostile,
                 hostile,
                 hostile,
                 hostile,
                 {{hostile, hostile, hostile}},
                 {},
                 {"bad"}}};
  std::vector<CaseResult> results;
  for (Verdict verdict : text::Tally::verdicts) {
    CaseResult result = samples::failure();
    result.verdict = verdict;
    result.id = "bad/" + hostile + std::string(results::to_string(verdict));
    result.protocol = result.title = result.level = result.basis = result.manual = result.section =
        result.quote = hostile;
    result.message = result.expected = result.received = result.replay = hostile;
    result.notes = {hostile, "transposed: " + hostile};
    result.differences = {{hostile, hostile, hostile, hostile}};
    result.readings = {{hostile, hostile}};
    for (results::Event& event : result.exchange) event.text = hostile;
    results.push_back(result);
  }
  for (const bool qualify : {false, true}) {
    const std::string html =
        report(run, results, {hostile, 1, 3, false, hostile}, {.qualify = qualify});
    EXPECT_EQ(html.find("<script"), html.rfind("<script")) << "ours alone";
    EXPECT_THAT(html, Not(HasSubstr("<script>alert")));
    EXPECT_THAT(html, Not(HasSubstr("<!--")));
    const ParsedHtml page(html);
    for (Verdict verdict : text::Tally::verdicts)
      EXPECT_GE(page.tile(results::to_string(verdict)), 1u);
    EXPECT_TRUE(samples::xmllint_accepts(report_));
  }
}

TEST_F(Html, AFrameOfAMebibyteIsCutAndSaysSo) {
  CaseResult large = samples::failure();
  large.received_bytes.assign(1 << 20, 0xFF);
  large.received = std::string(1 << 22, 'x');
  large.exchange[1].bytes = large.received_bytes;
  large.exchange[1].text = large.received;
  CaseResult large_pass = passed(1);
  large_pass.exchange[1].bytes = large.received_bytes;
  const std::string html = report({large, large_pass});
  EXPECT_LT(html.size(), 64u << 10);
  const ParsedHtml page(html);
  EXPECT_EQ(fmt::format(" ... {} more bytes", (1 << 20) - block_frame_limit),
            page.text("//tr[@class='judged']//em"));
  const std::size_t request = large_pass.exchange[0].bytes.size();
  EXPECT_EQ(fmt::format(" ... {} more bytes", (1 << 20) + request - line_bytes_limit),
            page.text("//table[@class='passes']//em"));
}

TEST_F(Html, ThreeThousandPassesStayBelowTwoMebibytes) {
  std::vector<CaseResult> results;
  for (std::size_t i = 0; i < 3000; ++i) results.push_back(passed(i));
  // Every tenth has far more bytes than a line shows.
  for (std::size_t i = 0; i < 3000; i += 10) results[i].exchange[1].bytes.assign(5000, 0x30);
  const std::string html = report(results);
  EXPECT_LT(html.size(), 2u << 20);
  EXPECT_EQ(3000u, ParsedHtml(html).count("//table[@class='passes']//tr"));
}

TEST_F(Html, BeyondTheLimitOfLinesCasesAreCounted) {
  std::vector<CaseResult> results(html_line_limit + 5, samples::with(Verdict::pass, "a/one"));
  const ParsedHtml page(report(results));
  EXPECT_EQ(html_line_limit, page.count("//table[@class='passes']//tr"));
  EXPECT_EQ(html_line_limit + 5, page.tile("PASS"));
  EXPECT_EQ("5 more are counted, not listed; `results.ndjson` has them.",
            page.text("//details[@class='section']/p[@class='cut']"));
}

TEST_F(Html, NothingIsLoadedFromElsewhere) {
  const std::string html = report({samples::failure()}, {.qualify = true});
  for (const char* loads : {"src=", "url(", "@import", "<link", "http-equiv", "javascript:"})
    EXPECT_THAT(html, Not(HasSubstr(loads))) << loads;
}

TEST_F(Html, WhatCannotBeWrittenIsSaid) {
  samples::write_results(results_, {with(Verdict::pass, "a/one")});
  const auto log = replay(results_, *html_report(folder_ / "none/report.html"));
  ASSERT_FALSE(log);
  EXPECT_THAT(log.error().message, HasSubstr("cannot write"));
  EXPECT_EQ(1u, folder_.files()) << "no half report is left";
}

}  // namespace
}  // namespace fieldproof::html
