#include "reports/capture.hpp"

#include <fstream>

#include <gmock/gmock.h>

#include "reports/pcapng.hpp"
#include "reports/testdata/samples.hpp"

namespace fieldproof::reports {

using results::Event;

namespace {

using testing::HasSubstr;
using testing::StartsWith;

Event piece(Event::Kind kind, const char* hex, Time start, int step, bool surplus = false) {
  return {kind, start, start + 1ms, *from_hex(hex), "", step, surplus};
}

results::CaseResult with_exchange(std::vector<Event> exchange) {
  results::CaseResult result = samples::with(results::Verdict::pass, "a/b");
  result.recording.stimulus = "1";
  result.exchange = std::move(exchange);
  return result;
}

TEST(CapturedFrames, JoinsWhatAPortDeliversInPieces) {
  const auto frames =
      captured_frames(with_exchange({piece(Event::Kind::sent, "05 30", 0ms, 0),
                                     piece(Event::Kind::received, "06 30", 5ms, 1),
                                     {Event::Kind::note, 6ms, 6ms, {}, "a note", -1, false},
                                     piece(Event::Kind::received, "31 03", 6ms, 1)}));
  ASSERT_EQ(2u, frames.size());
  EXPECT_TRUE(frames[0].sent);
  EXPECT_FALSE(frames[1].sent);
  EXPECT_EQ(*from_hex("06 30 31 03"), frames[1].bytes);
  EXPECT_EQ(5ms, frames[1].start);
  EXPECT_EQ(7ms, frames[1].end);
  EXPECT_EQ("a/b, step 2: PASS", frames[1].comment);
}

TEST(CapturedFrames, APauseInsideAFrameIsSaid) {
  const auto frames = captured_frames(with_exchange(
      {piece(Event::Kind::sent, "05 30", 0ms, 0), piece(Event::Kind::sent, "31", 21ms, 0)}));
  ASSERT_EQ(1u, frames.size());
  EXPECT_EQ("a/b, step 1: PASS; pause of 20.000 ms after 2 bytes", frames[0].comment);
}

TEST(CapturedFrames, StepsProbesAndSurplusStayApart) {
  const auto frames = captured_frames(with_exchange(
      {piece(Event::Kind::sent, "01", 0ms, 0), piece(Event::Kind::sent, "02", 1ms, 1),
       piece(Event::Kind::received, "03", 2ms, 2),
       piece(Event::Kind::received, "04", 3ms, -1, true), piece(Event::Kind::sent, "05", 4ms, -1),
       piece(Event::Kind::sent, "06", 5ms, -1)}));
  std::vector<std::string> comments;
  for (const CapturedFrame& frame : frames) comments.push_back(frame.comment);
  EXPECT_THAT(comments,
              testing::ElementsAre("a/b, step 1: PASS", "a/b, step 2: PASS", "a/b, step 3: PASS",
                                   "a/b, surplus: PASS", "a/b, probe: PASS", "a/b, probe: PASS"));
}

TEST(CapturedFrames, OfAnExtractSayHowMuchTheyLack) {
  Event flood = piece(Event::Kind::received, "05 06", 0ms, 1);
  flood.extract = {2000, {0x07}, "5ha"};
  const auto frames =
      captured_frames(with_exchange({flood, piece(Event::Kind::received, "08", 1ms, 1)}));
  ASSERT_EQ(2u, frames.size()) << "nothing is glued to it";
  EXPECT_EQ("05 06", to_hex(frames[0].bytes));
  EXPECT_EQ(1998u, frames[0].left_out);
  EXPECT_EQ("a/b, step 2, 2000 bytes in all, sha256 5ha: PASS", frames[0].comment);
  const std::string packet = pcapng_serial_packet({0, 0, false, frames[0].bytes, "", 1998});
  const auto length = [&](std::size_t at) {
    return static_cast<unsigned char>(packet[at]) +
           256u * static_cast<unsigned char>(packet[at + 1]);
  };
  EXPECT_EQ(12u + 2, length(20)) << "captured";
  EXPECT_EQ(12u + 2000, length(24)) << "on the line";
}

TEST(CapturedFrames, OfAnOldRecordingHaveNoStep) {
  EXPECT_EQ("xgt_cnet/rss/one_word: FAIL", captured_frames(samples::failure()).front().comment);
}

TEST(Pcapng, BlocksAreWholeWordsBetweenTheirLengths) {
  const Bytes frame = *from_hex("01 02 03");
  for (const std::string& block :
       {pcapng_section("application", "hardware"), pcapng_section("", ""),
        pcapng_interface(linktype_rtac_serial, "xgt-cnet", "x"),
        pcapng_packet({0, 0, true, frame, "comment"}),
        pcapng_serial_packet({0, 0, true, frame, "comment"})}) {
    EXPECT_EQ(0u, block.size() % 4);
    EXPECT_EQ(block.substr(4, 4), block.substr(block.size() - 4));
    EXPECT_EQ(block.size(),
              static_cast<unsigned char>(block[4]) + 256u * static_cast<unsigned char>(block[5]));
  }
}

TEST(Capture, IsThereWholeOrNotAtAll) {
  const samples::Folder folder;
  samples::write_results(folder / "results.ndjson", {samples::failure()}, false);
  const auto capture = [&](const std::string& name) {
    return replay(folder / "results.ndjson", *capture_report(folder / name));
  };
  ASSERT_TRUE(capture("run.pcapng"));
  EXPECT_THAT(samples::read_file(folder / "run.pcapng"), StartsWith("\x0A\x0D\x0D\x0A"));
  std::ofstream(folder / "results.ndjson", std::ios::app) << "damage\n";
  EXPECT_FALSE(capture("other.pcapng"));
  EXPECT_EQ(2u, folder.files());
}

TEST(Capture, AFolderThatIsNotThereIsSaid) {
  const samples::Folder folder;
  const std::unique_ptr<results::Sink> sink = capture_report(folder / "no/folder.pcapng");
  ASSERT_TRUE(sink->begin(samples::run_info()));
  ASSERT_TRUE(sink->add(results::Delivery(samples::failure())));
  const Status done = sink->end({});
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error().message, HasSubstr("cannot write " + folder / "no/folder.pcapng"));
}

}  // namespace
}  // namespace fieldproof::reports
