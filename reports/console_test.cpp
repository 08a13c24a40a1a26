#include "reports/console.hpp"

#include <gmock/gmock.h>

#include "reports/testdata/samples.hpp"

namespace fieldproof::reports {

using results::Verdict;

namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const ConsoleOptions terminal{.terminal = true, .width = 80};

TEST(RunHead, SaysWhatIsTested) {
  EXPECT_EQ(
      "fieldproof 0.1.0  emulator:xbc-h?station=1  profile xbc-h  gate=default  line=9600-8N1  "
      "seed=7\n",
      run_head(samples::run_info()));
}

TEST(RunHead, KeepsToItsWidth) {
  results::RunInfo run = samples::run_info();
  run.properties = {{"device", "The embedded emulator as whatever model a case names"},
                    {"gate", "default"},
                    {"protocol", "xgt-cnet, modbus-rtu, modbus-ascii, ls-bus, user-frames, udata"},
                    {"response_max_ms", "500"}};
  EXPECT_EQ(
      "fieldproof 0.1.0  emulator:xbc-h?station=1  profile xbc-h\n"
      "  device=The embedded emulator as whatever model a case names  gate=default\n"
      "  protocol=xgt-cnet, modbus-rtu, modbus-ascii, ls-bus, user-frames, udata  "
      "response_max_ms=500\n",
      run_head(run));
  EXPECT_EQ(
      "fieldproof 0.1.0\n  emulator:xbc-h?station=1\n  profile xbc-h\n  device=The embedded\n"
      "    emulator as whatever\n    model a case names\n  gate=default\n  protocol=xgt-cnet,\n"
      "    modbus-rtu,\n    modbus-ascii, ls-bus,\n    user-frames, udata\n  "
      "response_max_ms=500\n",
      run_head(run, {.terminal = true, .width = 26}));
}

TEST(RunHead, AWordIsNeverBroken) {
  results::RunInfo run = samples::run_info();
  run.endpoint = "serial:/dev/" + std::string(200, 'x');
  EXPECT_THAT(run_head(run), HasSubstr('\n' + ("  " + run.endpoint) + '\n'));
}

TEST(CaseReport, AFailureIsALineAndABlock) {
  auto result = samples::failure();
  result.exchange.clear();
  result.quote.clear();
  result.notes.clear();
  EXPECT_EQ(
      R"(FAIL          xgt_cnet/rss/one_word  BCC: expected 0F, received 09 (the sum leaves out the header)
  Read one word from M100 of station 1
  clause    xgb-cnet-en-1.6, 7.1.5 (1)(e) (must, printed rule)
  expected  [ACK st 'rSS' '01' '02' '1234' ETX BCC]
            0000  06 30 31 72 53 53 30 31  30 32 31 32 33 34 03 30
            0010  46
  received  ACK '01rSS01021234' ETX '09'
            0000  06 30 31 72 53 53 30 31  30 32 31 32 33 34 03 30
            0010  39
                  ^^
  differs   field  expected  received
            BCC    0F        09        the sum leaves out the header
  timing    reply after 4.208 ms
  replay    fieldproof run --filter xgt_cnet/rss/one_word --endpoint emulator:xbc-h

)",
      case_report(result, {}));
}

TEST(CaseReport, WhatTheGateLetsPassIsQuiet) {
  for (Verdict verdict : text::Tally::verdicts) {
    EXPECT_EQ(results::gates(verdict, {}), !case_report(samples::with(verdict, "a/b"), {}).empty())
        << results::to_string(verdict);
  }
  EXPECT_THAT(case_report(samples::with(Verdict::non_strict, "a/b", "upper case"),
                          {.gate = {.strict = true}}),
              StartsWith("NON-STRICT    a/b  upper case\n"));
}

TEST(CaseReport, VerboseShowsEveryCaseWithItsExchange) {
  EXPECT_EQ("SKIP          a/b  no area P\n",
            case_report(samples::with(Verdict::skip, "a/b", "no area P"), {.verbose = true}));
  auto passed = samples::with(Verdict::pass, "a/b");
  passed.exchange = samples::failure().exchange;
  EXPECT_EQ(R"(PASS          a/b
  exchange     time ms     gap ms       frame
                 0.000             -->  ENQ '01rSS0106%MW100' EOT 'A3'
                                        0000  05 30 31 72 53 53 30 31  30 36 25 4D 57 31 30 30
                                        0010  04 41 33
                24.000      4.208  <--  ACK '01rSS01021234' ETX '09'
                                        0000  06 30 31 72 53 53 30 31  30 32 31 32 33 34 03 30
                                        0010  39
                41.708              .   silence until here

)",
            case_report(passed, {.verbose = true}));
}

TEST(CaseReport, ColourOnATerminalOnly) {
  EXPECT_THAT(case_report(samples::failure(), {}), Not(HasSubstr("\x1b")));
  EXPECT_THAT(case_report(samples::failure(), terminal),
              StartsWith("\x1b[1;31mFAIL\x1b[0m          xgt_cnet"));
  EXPECT_THAT(case_report(samples::failure(), {.terminal = true, .colour = false}),
              StartsWith("FAIL          xgt_cnet"));
}

TEST(CaseReport, TheDeviceCannotDriveTheTerminal) {
  auto result = samples::failure();
  result.message = "got \x1b[2J\r\n";
  EXPECT_THAT(case_report(result, {}),
              StartsWith("FAIL          xgt_cnet/rss/one_word  got [1B][2J[0D][0A]\n"));
}

TEST(CaseReport, AFloodIsCutShort) {
  auto result = samples::failure();
  result.received_bytes.assign(1 << 20, 0x55);
  EXPECT_LT(case_report(result, {}).size(), 5000u);
}

text::Tally tally_of(std::size_t passed, std::size_t failed = 0) {
  text::Tally tally;
  tally.add(Verdict::pass, passed);
  tally.add(Verdict::fail, failed);
  return tally;
}

TEST(Progress, SaysWhatIsDoneAndWhatIsLeft) {
  Progress progress(terminal);
  EXPECT_EQ("\r\x1b[K[   0/1480] 1480 to go  a/b", progress.line({}, 1480, "a/b", 0s));
  EXPECT_EQ("\r\x1b[K[  12/1480] 2 red, 1468 to go, ~4 min  a/c",
            progress.line(tally_of(10, 2), 1480, "a/c", 2s));
  EXPECT_EQ("\r\x1b[K[1479/1480] 2 red, 1 to go, ~0 s  a/c",
            progress.line(tally_of(1477, 2), 1480, "a/c", 300s));
}

TEST(Progress, EstimatesRoughly) {
  Progress progress(terminal);
  EXPECT_THAT(progress.line(tally_of(1), 90, "", 1s), HasSubstr(", ~89 s"));
  EXPECT_THAT(progress.line(tally_of(1), 91, "", 1100ms), HasSubstr(", ~2 min"));
  EXPECT_THAT(progress.line(tally_of(1), 7201, "", 2s), HasSubstr(", ~4 h"));
  EXPECT_THAT(progress.line(tally_of(7300), 7201, "", 3s), HasSubstr("] 0 to go, ~0 s"));
}

TEST(Progress, IsDrawnAgainWhenTimeHasPassed) {
  Progress progress(terminal);
  EXPECT_NE("", progress.line({}, 9, "a/1", 100ms));
  EXPECT_EQ("", progress.line({}, 9, "a/2", 119ms));
  EXPECT_NE("", progress.line({}, 9, "a/3", 120ms));
  EXPECT_NE("", progress.erase());
  EXPECT_NE("", progress.line({}, 9, "a/4", 121ms)) << "what was erased is drawn again";
}

TEST(Progress, IsErasedOnce) {
  Progress progress(terminal);
  EXPECT_EQ("", progress.erase());
  progress.line({}, 9, "a/1", 0s);
  EXPECT_EQ("\r\x1b[K", progress.erase());
  EXPECT_EQ("", progress.erase());
}

TEST(Progress, FitsTheTerminal) {
  Progress progress({.terminal = true, .width = 18});
  EXPECT_EQ("\r\x1b[K[0/9] 9 to go  xx", progress.line({}, 9, std::string(200, 'x'), 0s));
}

TEST(Progress, NeedsATerminal) {
  Progress progress({});
  EXPECT_EQ("", progress.line({}, 9, "a/b", 0s));
  EXPECT_EQ("", progress.erase());
}

TEST(RunSummary, CountsWhatOccurs) {
  Summary summary;
  summary.tally.add(Verdict::pass, 1402);
  summary.tally.add(Verdict::non_strict);
  summary.tally.add(Verdict::fail, 2);
  summary.tally.add(Verdict::blocked, 12);
  summary.end = samples::run_end(1);
  summary.end.reasons = text::reasons_of(summary.tally, {});
  summary.red.add(samples::with(Verdict::fail, "a/b", "late"));
  results::CaseResult second = samples::with(Verdict::fail, "a/c", "wrong");
  second.repeat = 1;
  summary.red.add(second);
  summary.reports = {{"results", "out/results.ndjson"}, {"junit", "out/junit.xml"}};
  EXPECT_EQ(R"(
1417 cases in 2.2 s
  1402  PASS          as the manual says
     1  NON-STRICT    an allowed alternative, or a SHOULD missed; red with --strict
     2  FAIL          violates a MUST
    12  BLOCKED       needs a permission, fixture or mode not given; red with --qualify

red:
  a/b
  a/c #2

results  out/results.ndjson
junit    out/junit.xml

exit 1: conformance failed: 2 FAIL
)",
            run_summary(summary, {}));
}

TEST(RunSummary, OfAGreenRunIsShort) {
  Summary summary;
  summary.tally.add(Verdict::pass);
  summary.end = samples::run_end(0);
  EXPECT_EQ(
      "\n1 case in 2.2 s\n  1  PASS          as the manual says\n\nexit 0: gate met: 1 of 1 "
      "judged\n",
      run_summary(summary, {}));
  EXPECT_THAT(run_summary(summary, terminal),
              HasSubstr("exit 0: \x1b[32mgate met: 1 of 1 judged\x1b[0m\n"));
}

TEST(RunSummary, SaysWhyARunStoppedEarly) {
  Summary summary;
  summary.end = samples::run_end(3);
  summary.end.add({3, "trouble", "bench trouble: nothing answers; check station and line"});
  EXPECT_EQ(
      "\n0 cases in 2.2 s\n\nexit 3: bench trouble: nothing answers; check station and line\n",
      run_summary(summary, {}));
}

TEST(RunSummary, NamesTheFirstOfManyRedCases) {
  Summary summary;
  for (int i = 0; i < 25; ++i)
    summary.red.add(samples::with(Verdict::fail, "a/" + std::to_string(i + 1),
                                  std::string(1, static_cast<char>('k' + i % 10)) + " is wrong"));
  const std::string text = run_summary(summary, {});
  EXPECT_THAT(text, HasSubstr("  a/20\n  ... and 5 more\n"));
  EXPECT_THAT(text, Not(HasSubstr("a/21")));
}

TEST(RunSummary, TellsTheSameFailureOnce) {
  Summary summary;
  for (int i = 1; i <= 40; ++i)
    summary.red.add(
        samples::with(Verdict::fail, "a/" + std::to_string(i), "no answer within 500 ms"));
  summary.red.add(samples::with(Verdict::fail, "b/other", "wrong"));
  EXPECT_THAT(run_summary(summary, {}),
              HasSubstr("red:\n  40 cases: no answer within 500 ms (first: a/1, a/2, a/3)\n"
                        "  b/other\n"));
}

TEST(CaseReport, ALineOfItsOwnWhereItShallBeOne) {
  text::Failures failures;
  EXPECT_EQ(case_report(samples::failure(), {}, &failures.add(samples::failure()), false),
            "FAIL          xgt_cnet/rss/one_word  " + samples::failure().message + "\n");
}

TEST(RunSummary, SaysWhyNothingWasJudged) {
  Summary summary;
  const auto add = [&](Verdict verdict, const std::string& id, const std::string& message) {
    summary.tally.add(verdict);
    summary.not_judged.add(samples::with(verdict, id, message));
  };
  add(Verdict::blocked, "a/0", "needs --power-cycle");
  for (int i = 1; i <= 4; ++i) add(Verdict::skip, "a/" + std::to_string(i), "is another protocol");
  EXPECT_THAT(run_summary(summary, {}),
              HasSubstr("\nnothing was judged, or what it takes:\n"
                        "  1  BLOCKED       a device fresh from power-on: --power-cycle COMMAND\n"
                        "  4  SKIP          is another protocol\n"));
  summary.tally.add(Verdict::pass);
  EXPECT_THAT(run_summary(summary, {}), Not(HasSubstr("nothing was judged")));
  EXPECT_THAT(run_summary(summary, {}),
              HasSubstr("\nnot judged, and why, or what it takes:\n"
                        "  1  BLOCKED       a device fresh from power-on: --power-cycle COMMAND\n"
                        "  4  SKIP          is another protocol\n"));
}

TEST(RunSummary, ReasonsAreFewLines) {
  Summary summary;
  summary.reports = {{"html", "out/report.html"}};
  for (char letter = 'p'; letter < 'x'; ++letter)
    summary.not_judged.add(samples::with(Verdict::skip, "a/b", std::string(3, letter)));
  EXPECT_THAT(run_summary(summary, {}),
              HasSubstr("  1  SKIP          ttt\n"
                        "  ... and 3 more reasons, each in full in out/report.html\n"));
}

TEST(RunSummary, SaysWhereTheRestIs) {
  Summary summary;
  for (int i = 0; i < 25; ++i)
    summary.red.add(samples::with(Verdict::fail, "a/" + std::to_string(i + 1),
                                  std::string(1, static_cast<char>('k' + i % 10)) + " is wrong"));
  summary.reports = {{"html", "out/report.html"}};
  EXPECT_THAT(run_summary(summary, {}),
              HasSubstr("  ... and 5 more, each in full in out/report.html\n"));
}

std::string printed;

std::size_t count_in_printed(const std::string& text) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = printed.find(text, at)) != printed.npos; ++at) ++count;
  return count;
}

/// 60 failures of 30 kinds.
void print_many(const ConsoleOptions& options) {
  printed.clear();
  ConsoleReport report(options, [](const std::string& text) { printed += text; });
  for (int i = 0; i < 60; ++i) {
    results::CaseResult result = samples::failure();
    result.id = "a/" + std::to_string(i);
    result.message = std::string(1 + static_cast<std::size_t>(i % 30), 'k') + " is wrong";
    [[maybe_unused]] const Status done = report.add(results::Delivery(result));
  }
}

TEST(ConsoleReport, OfAFloodOnlyTheFirstAreTold) {
  print_many({});
  EXPECT_EQ(count_in_printed("\n  clause  "), 20u) << "in full";
  EXPECT_EQ(count_in_printed("FAIL "), 40u) << "and as many by a line";
  EXPECT_EQ(count_in_printed("further failures are counted; the reports have each in full\n"), 1u);
  print_many({.verbose = true});
  EXPECT_EQ(count_in_printed("\n  clause  "), 60u);
}

TEST(ConsoleReport, KeepsToTheTerminal) {
  print_many({.width = 60});
  for (std::size_t at = 0, end = 0; (end = printed.find('\n', at)) != printed.npos; at = end + 1)
    EXPECT_LE(end - at, 60u) << printed.substr(at, end - at);
  EXPECT_THAT(printed, HasSubstr("  replay    fieldproof run --filter xgt_cnet/rss/one_word \\\n"
                                 "              --endpoint emulator:xbc-h\n"));
}

TEST(ConsoleReport, TellsTheFirstOfAKindInFull) {
  const auto run = [](bool verbose) {
    printed.clear();
    ConsoleReport report({.verbose = verbose}, [](const std::string& text) { printed += text; });
    for (int i = 1; i <= 5; ++i) {
      results::CaseResult result = samples::failure();
      result.id = "a/" + std::to_string(i);
      [[maybe_unused]] const Status done = report.add(results::Delivery(result));
    }
    std::size_t blocks = 0;
    for (std::size_t at = 0; (at = printed.find("  clause  ", at)) != printed.npos; ++at) ++blocks;
    return blocks;
  };
  EXPECT_EQ(run(false), 3u);
  EXPECT_THAT(printed, HasSubstr("FAIL          a/5  " + samples::failure().message +
                                 "  (7.1.5 (1)(e), as a/1)\n"));
  EXPECT_EQ(run(true), 5u) << "-v shows every exchange";
}

}  // namespace
}  // namespace fieldproof::reports
