#include "reports/text/case_text.hpp"

#include <gmock/gmock.h>

#include "reports/testdata/samples.hpp"
#include "reports/text/xml_text.hpp"

namespace fieldproof::text {

using results::CaseResult;

namespace {

using testing::HasSubstr;
using testing::Not;

TEST(CaseBlock, SaysWhatABenchEngineerNeeds) {
  EXPECT_EQ(R"(Read one word from M100 of station 1
clause    xgb-cnet-en-1.6, 7.1.5 (1)(e) (must, printed rule)
          "BCC is the low byte of the sum from ENQ to EOT"
sent      ENQ '01rSS0106%MW100' EOT 'A3'
          0000  05 30 31 72 53 53 30 31  30 36 25 4D 57 31 30 30
          0010  04 41 33
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
notes     addresses moved: %MW100 -> %MW300
replay    fieldproof run --filter xgt_cnet/rss/one_word --endpoint emulator:xbc-h
)",
            case_block(samples::failure()));
}

TEST(CaseBlock, OfACaseThatNeverStartedIsEmpty) {
  EXPECT_EQ("", case_block(samples::with(results::Verdict::blocked, "a/b", "needs --allow-write")));
}

TEST(CaseBlock, SilenceInsteadOfAnAnswer) {
  CaseResult result;
  result.expected = "[ACK]";
  result.expected_hex = "06";
  EXPECT_EQ("expected  [ACK]\n          06\nreceived  nothing\n", case_block(result));
}

CaseResult answer(const std::string& expected_hex, const std::string& received) {
  CaseResult result;
  result.expected_hex = expected_hex;
  result.received_bytes = *from_hex(received);
  return result;
}

TEST(CaseBlock, MarksEachByteThatDiffers) {
  EXPECT_EQ(
      "expected  06 30 ?? 31\n"
      "received  06 31 99 32\n             ^^    ^^\n",
      case_block(answer("06 30 ?? 31", "06 31 99 32")));
}

TEST(CaseBlock, MarksTheFirstByteOnlyWhereTheRestHasMoved) {
  EXPECT_EQ("expected  06 30 31\nreceived  06 31\n             ^^\n",
            case_block(answer("06 30 31", "06 31")));
  EXPECT_EQ("expected  06 30\nreceived  06 30 31 32\n                ^^\n",
            case_block(answer("06 30", "06 30 31 32")));
  EXPECT_EQ("expected  06 30 31\nreceived  06 30 --\n                ^^\n",
            case_block(answer("06 30 31", "06 30")));
}

TEST(CaseBlock, ExpectedAndReceivedStandByteBelowByte) {
  EXPECT_THAT(case_block(answer("06 30", "06 30 31 32 33 34 35 36 37 38 39 30 31 32 33 34 35")),
              HasSubstr("expected  0000  06 30\nreceived  0000  06 30 31"));
}

TEST(CaseBlock, AlternativesInWordsStayWords) {
  EXPECT_EQ("expected  as_sent 06, upper 15\nreceived  07\n",
            case_block(answer("as_sent 06, upper 15", "07")));
}

TEST(CaseBlock, TheRequestIsTheOneThatWasAnswered) {
  auto result = samples::failure();
  result.exchange.push_back({results::Event::Kind::sent, 4s, 4s, {0x05}, "SANITY"});
  EXPECT_THAT(case_block(result), HasSubstr("sent      ENQ '01rSS0106%MW100' EOT 'A3'"));
  result.received_bytes.clear();
  EXPECT_THAT(case_block(result), HasSubstr("sent      SANITY"))
      << "no answer: the last that was sent";
}

TEST(CaseBlock, OfSeveralRequestsWithOneAnswerTheJudgedOneIsShown) {
  auto result = samples::failure();
  const results::Event answer = result.exchange.at(1);
  ASSERT_EQ(answer.bytes, result.received_bytes);
  result.exchange.clear();
  for (const auto& [at, text] : {std::pair{1s, "FIRST"}, {2s, "SECOND"}, {3s, "THIRD"}}) {
    result.exchange.push_back({results::Event::Kind::sent, at, at, {0x05}, text, 0});
    result.exchange.push_back(answer);
    result.exchange.back().start = result.exchange.back().end = at + 1ms;
  }
  result.due = {2s, 2500ms};
  EXPECT_THAT(case_block(result), HasSubstr("sent      SECOND"));
}

TEST(CaseBlock, SeveralFramesShowTheExchange) {
  auto result = samples::failure();
  EXPECT_THAT(case_block(result), Not(HasSubstr("exchange")));
  EXPECT_THAT(case_block(result, {.exchange = true}),
              HasSubstr("exchange     time ms     gap ms       frame"));
  result.exchange.push_back(result.exchange[0]);
  EXPECT_THAT(case_block(result), HasSubstr("exchange     time ms"));
}

TEST(CaseBlock, DifferencesAreAligned) {
  CaseResult result;
  result.differences = {{"block count", "01", "00", ""},
                        {"국번", "00", "01", "station"},
                        {"data", std::string(50, '1'), "2", "long"}};
  EXPECT_EQ(
      "differs   field        expected                                  received\n"
      "          block count  01                                        00\n"
      "          국번         00                                        01        station\n"
      "          data         " +
          std::string(50, '1') + "  2         long\n",
      case_block(result));
}

TEST(CaseBlock, Timing) {
  CaseResult result;
  result.response_ms = {1, 2.5};
  EXPECT_EQ("timing    replies after 1.000, 2.500 ms\n", case_block(result));
  result.response_ms = {5, 1, 4, 2, 3};
  EXPECT_EQ("timing    5 replies after 1.000 to 5.000 ms, median 3.000 ms\n", case_block(result));
}

TEST(CaseBlock, LongFramesAreCutWhereAskedAndWholeElsewhere) {
  CaseResult result;
  result.received_bytes.assign(4096, 0x41);
  result.received = "'" + std::string(4096, 'A') + "'";
  const std::string cut = case_block(result, {.limit = 32});
  EXPECT_LT(cut.size(), 500u);
  EXPECT_THAT(cut, HasSubstr("AAA ...\n"));
  EXPECT_THAT(cut, HasSubstr("0010  41"));
  EXPECT_THAT(cut, HasSubstr("... 4064 more bytes\n"));
  const std::string whole = case_block(result);
  EXPECT_THAT(whole, HasSubstr("\n          0FF0  41"));
  EXPECT_THAT(whole, HasSubstr(result.received));
}

TEST(CaseBlock, OfAFloodThereIsAnExtract) {
  CaseResult result;
  result.received_bytes.assign(1'234'567, 0x41);
  result.received = "'" + std::string(1'234'567, 'A') + "'";
  result.exchange.push_back(
      {results::Event::Kind::received, 0s, 1s, result.received_bytes, "A..."});
  const std::string block = case_block(result, {.exchange = true});
  EXPECT_LT(block.size(), 3000u);
  EXPECT_THAT(block, HasSubstr("... 1,234,439 bytes left out\n"));
  EXPECT_THAT(block, HasSubstr("1,234,567 bytes in all, sha256 "));
}

TEST(CaseBlock, AnExtractIsShownAsSuch) {
  CaseResult result = samples::failure();
  result.received_bytes.resize(3);
  result.received_extract = {16'500, {0x42, 0x43}, "5ha"};
  result.exchange = {{results::Event::Kind::received, 0s, 1s, result.received_bytes, "ACK '01"}};
  result.exchange[0].extract = result.received_extract;
  const std::string block = case_block(result, {.limit = 256, .exchange = true});
  const std::string extract =
      "0000  06 30 31\nEXTRA... 16,495 bytes left out\nEXTRA4072  42 43\nEXTRA16,500 bytes in all, "
      "sha256 5ha\n";
  for (const int column : {10, 38}) {
    std::string shown = extract;
    for (std::size_t at; (at = shown.find("EXTRA")) != shown.npos;)
      shown.replace(at, 5, std::string(static_cast<std::size_t>(column), ' '));
    EXPECT_THAT(block, HasSubstr(shown)) << "no mark where it only goes on";
  }
}

TEST(CaseBlock, KeepsToTheTerminal) {
  CaseResult result = samples::failure();
  result.exchange.push_back({results::Event::Kind::sent, 3s, 3s, Bytes(20, 0x41), "'AAAA'"});
  result.exchange.push_back({results::Event::Kind::note,
                             3s,
                             3s,
                             {},
                             "a note that does not fit beside what is left of it"});
  result.differences = {{"error code", "1132 device memory: no such area, or not writable",
                         "0011 data error", "another word for it"}};
  const std::string block = case_block(result, {.width = 78});
  for (std::size_t at = 0, end = 0; (end = block.find('\n', at)) != block.npos; at = end + 1) {
    const std::string line = block.substr(at, end - at);
    EXPECT_TRUE(line.size() <= 78 || line.starts_with("replay")) << line;
  }
  EXPECT_THAT(block, HasSubstr(R"(
differs   field       expected                  received
          error code  1132 device memory: no    0011 data error
                      such area, or not
                      writable
            another word for it
)"));
  EXPECT_THAT(block,
              HasSubstr("-->  'AAAA'\n                                      0000  41 41 41 41 "
                        "41 41 41 41\n"));
  EXPECT_THAT(block, HasSubstr(".   a note that does not fit beside what is\n"
                               "                                      left of it\n"));
}

TEST(CaseBlock, ShowsAFrameOnce) {
  const std::string block = case_block(samples::failure(), {.exchange = true});
  EXPECT_THAT(block, HasSubstr("-->  as sent above\n"));
  EXPECT_THAT(block, HasSubstr("<--  as received above\n"));
  for (const char* once : {"05 30 31 72", "ENQ '01rSS0106%MW100'", "0010  39", "ETX '09'"})
    EXPECT_EQ(block.find(once), block.rfind(once)) << once;
}

TEST(CaseBlock, NothingInItHarmsATerminalOrXml) {
  auto result = samples::failure();
  std::string every;
  for (int b = 0; b < 256; ++b) every += static_cast<char>(b);
  result.title = result.manual = result.section = result.level = result.basis = result.quote =
      result.expected = result.received = result.replay = every;
  result.expected_hex = every;
  result.notes = {every};
  result.readings = {{every, every}};
  result.differences = {{every, every, every, every}};
  for (results::Event& event : result.exchange) event.text = every;
  const std::string block = case_block(result, {.exchange = true});
  EXPECT_EQ(block, xml_text(block));
}

TEST(FrameMonitor, ShowsTimeGapDirectionAndFrame) {
  EXPECT_EQ(R"(   time ms     gap ms       frame
     0.000             -->  ENQ '01rSS0106%MW100' EOT 'A3'
                            0000  05 30 31 72 53 53 30 31  30 36 25 4D 57 31 30 30
                            0010  04 41 33
    24.000      4.208  <--  ACK '01rSS01021234' ETX '09'
                            0000  06 30 31 72 53 53 30 31  30 32 31 32 33 34 03 30
                            0010  39
    41.708              .   silence until here
)",
            frame_monitor(samples::failure()));
}

TEST(CaseLabel, CountsRepetitionsFromTwo) {
  auto result = samples::with(results::Verdict::pass, "a/b");
  EXPECT_EQ("a/b", case_label(result));
  result.repeat = 1;
  EXPECT_EQ("a/b #2", case_label(result));
}

}  // namespace
}  // namespace fieldproof::text
