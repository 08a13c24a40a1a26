#include "src/xgt_cnet/receiver.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "src/plc/test_frame_log.hpp"
#include "src/xgt_cnet/test_frames.hpp"

namespace fieldproof::xgt_cnet {
namespace {

using plc::test::Broken;
using plc::test::Frames;
using plc::test::Log;
using test::ack;
using test::character;
using test::enq;
using test::gap;
using test::nak;
using test::operator+;

class FrameReceiverTest : public ::testing::Test {
 protected:
  void at(Time start, const Bytes& bytes) { receiver.receive({bytes, start, character}, log); }
  void text_at(Time start, std::string_view text) { at(start, to_bytes(text)); }

  FrameReceiver receiver{FrameReceiver::Side::server, gap};
  Log log;
};

TEST_F(FrameReceiverTest, FrameEndsAtItsTail) {
  at(10ms, enq("01RSS0106%MW100"));
  EXPECT_EQ(log.frames, Frames{enq("01RSS0106%MW100")});
  EXPECT_EQ(log.ends, std::vector<Time>{10ms + 17 * character});
  EXPECT_EQ(receiver.wake_at(), std::nullopt);
}

TEST_F(FrameReceiverTest, LowerCaseFrameEndsAtItsBcc) {
  const Bytes frame = enq("01y01");
  at(0ms, Bytes(frame.begin(), frame.end() - 2));
  EXPECT_TRUE(log.frames.empty());
  at(7ms, Bytes(frame.end() - 2, frame.end() - 1));
  EXPECT_TRUE(log.frames.empty());
  at(8ms, Bytes(frame.end() - 1, frame.end()));
  EXPECT_EQ(log.frames, Frames{frame});
  EXPECT_EQ(log.ends, std::vector<Time>{9ms});
}

TEST_F(FrameReceiverTest, TrailingBytesDoNotMoveTheEnd) {
  at(0ms, enq("01Y01") + to_bytes("\r\n"));
  EXPECT_EQ(log.ends, std::vector<Time>{7ms});
  EXPECT_EQ(log.broken, Broken{1});
}

TEST_F(FrameReceiverTest, BytesBeforeTheHeaderCountOnceARun) {
  at(0ms, to_bytes("noise") + enq("01Y01"));
  EXPECT_EQ(log.frames, Frames{enq("01Y01")});
  EXPECT_EQ(log.broken, Broken{1});
  text_at(100ms, "a");
  text_at(101ms, "b");  // the same run
  text_at(101ms + character + gap, "c");
  EXPECT_EQ(log.broken, (Broken{1, 1}));
  text_at(200ms, "d");  // after a gap: another
  EXPECT_EQ(log.broken, (Broken{1, 1, 1}));
}

TEST_F(FrameReceiverTest, HeaderInsideAFrameRestartsIt) {
  at(0ms, to_bytes("\x05"
                   "01RSS0106%M") +
              enq("01Y01"));
  EXPECT_EQ(log.frames, Frames{enq("01Y01")});
  EXPECT_EQ(log.broken, Broken{2});
}

TEST_F(FrameReceiverTest, HeaderInPlaceOfTheBccRestartsIt) {
  at(0ms, to_bytes("\x05"
                   "01y01\x04"
                   "4") +
              enq("01Y01"));
  EXPECT_EQ(log.frames, Frames{enq("01Y01")});
  EXPECT_EQ(log.broken, Broken{3});
}

TEST_F(FrameReceiverTest, TwoFramesBackToBack) {
  at(0ms, enq("01y01") + enq("01Y02"));
  EXPECT_EQ(log.frames, (Frames{enq("01y01"), enq("01Y02")}));
  EXPECT_EQ(log.ends, (std::vector<Time>{9ms, 16ms}));
  EXPECT_TRUE(log.broken.empty());
}

TEST_F(FrameReceiverTest, GapEqualToTheTimeIsOneFrame) {
  text_at(0ms,
          "\x05"
          "01");
  text_at(3ms + gap, "Y01\x04");
  EXPECT_EQ(log.frames, Frames{enq("01Y01")});
}

TEST_F(FrameReceiverTest, LongerGapEndsTheFrame) {
  text_at(0ms,
          "\x05"
          "01");
  text_at(3ms + gap + 1ns, "Y01\x04");
  EXPECT_TRUE(log.frames.empty());
  EXPECT_EQ(log.broken, (Broken{2, 1}));  // no tail; then bytes without a header
}

TEST_F(FrameReceiverTest, SilenceEndsTheFrameByTheClock) {
  text_at(0ms,
          "\x05"
          "01");
  const Time wake =
      3ms + gap + character + 1ns;  // a character that begins in time has arrived by then
  EXPECT_EQ(receiver.wake_at(), wake);
  receiver.advance(wake - 1ns, log);
  EXPECT_TRUE(log.broken.empty());
  receiver.advance(wake, log);
  EXPECT_EQ(log.broken, Broken{2});
  EXPECT_EQ(receiver.wake_at(), std::nullopt);
}

TEST_F(FrameReceiverTest, SilenceInPlaceOfTheBcc) {
  text_at(0ms,
          "\x05"
          "01y01\x04"
          "4");
  ASSERT_TRUE(receiver.wake_at());
  receiver.advance(*receiver.wake_at(), log);
  EXPECT_EQ(log.broken, Broken{3});
}

TEST_F(FrameReceiverTest, BufferHolds1024Bytes) {
  const std::string filling(FrameReceiver::max_frame - 5, 'x');
  text_at(0ms,
          "\x05"
          "01Y" +
              filling + "\x04");
  ASSERT_EQ(log.frames.size(), 1u);
  EXPECT_EQ(log.frames[0].size(), FrameReceiver::max_frame);
  text_at(2s,
          "\x05"
          "01Y" +
              filling + "x\x04");
  EXPECT_EQ(log.frames.size(), 1u);
  EXPECT_EQ(log.broken, Broken{2});
}

TEST_F(FrameReceiverTest, LongFrameMayHaveItsBcc) {
  const Bytes frame = enq("01y" + std::string(FrameReceiver::max_frame - 5, 'x'));
  at(0ms, frame);
  EXPECT_EQ(log.frames, Frames{frame});
}

TEST_F(FrameReceiverTest, ShortestFrames) {
  text_at(0ms, "\x05\x04");
  text_at(100ms,
          "\x05"
          "01\x04");
  EXPECT_EQ(log.frames.size(), 2u);
}

TEST(FrameReceiverOfClient, AckAndNakEndWithEtx) {
  FrameReceiver receiver(FrameReceiver::Side::client, gap);
  Log log;
  receiver.receive({ack("01rSS01021234") + nak("01RSS1132") + enq("01Y01"), 0ms, character}, log);
  EXPECT_EQ(log.frames, (Frames{ack("01rSS01021234"), nak("01RSS1132")}));
  EXPECT_EQ(log.broken, Broken{1});
}

TEST(FrameReceiverFuzz, HowBytesAreCutIntoBurstsDoesNotMatter) {
  std::mt19937 random(1965);
  constexpr std::string_view likely =
      "\x05\x05\x04\x04"
      "01rSRXyw%MW19";
  for (int round = 0; round < 2000; ++round) {
    Bytes bytes(random() % 80);
    for (Byte& b : bytes) b = static_cast<Byte>(likely[random() % likely.size()]);
    FrameReceiver whole(FrameReceiver::Side::server, gap), cut(FrameReceiver::Side::server, gap);
    Log at_once, in_parts;
    whole.receive({bytes, 0ms, character}, at_once);
    for (std::size_t from = 0; from < bytes.size();) {
      const std::size_t size = std::min<std::size_t>(1 + random() % 5, bytes.size() - from);
      const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(from);
      const Bytes part(first, first + static_cast<std::ptrdiff_t>(size));
      cut.receive({part, character * static_cast<int>(from), character}, in_parts);
      from += size;
    }
    ASSERT_EQ(at_once.frames, in_parts.frames) << to_hex(bytes);
    ASSERT_EQ(at_once.ends, in_parts.ends) << to_hex(bytes);
    ASSERT_EQ(at_once.broken, in_parts.broken) << to_hex(bytes);
  }
}

}  // namespace
}  // namespace fieldproof::xgt_cnet
