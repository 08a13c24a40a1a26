#include "src/modbus/rtu_receiver.hpp"

#include <gtest/gtest.h>

#include "src/modbus/test_frames.hpp"
#include "src/plc/counters.hpp"

namespace fieldproof::modbus {
namespace {

using plc::test::Broken;
using plc::test::Frames;
using plc::test::Log;
using test::character;
using test::gap;
using test::hex;
using test::operator+;

class RtuReceiverTest : public ::testing::Test {
 protected:
  void at(Time start, const Bytes& bytes) { receiver.receive({bytes, start, character}, log); }
  void silence() {
    const auto wake = receiver.wake_at();
    ASSERT_TRUE(wake);
    receiver.advance(*wake, log);
  }

  RtuReceiver receiver{gap};
  Log log;
};

TEST_F(RtuReceiverTest, SilenceEndsTheFrame) {
  EXPECT_EQ(receiver.wake_at(), std::nullopt);
  at(10ms, hex("01 03 00"));
  const Time known =
      13ms + gap + character;  // a character that began within the time has arrived by then
  EXPECT_EQ(receiver.wake_at(), known);
  receiver.advance(known - 1ns, log);
  EXPECT_TRUE(log.frames.empty());
  receiver.advance(known, log);
  EXPECT_EQ(log.frames, Frames{hex("01 03 00")});
  EXPECT_EQ(log.ends, std::vector<Time>{known});
  EXPECT_EQ(receiver.wake_at(), std::nullopt);
}

TEST_F(RtuReceiverTest, ShorterGapIsOneFrame) {
  at(0ms, hex("01 03"));
  at(2ms + gap - 1ns, hex("04"));
  silence();
  EXPECT_EQ(log.frames, Frames{hex("01 03 04")});
}

TEST_F(RtuReceiverTest, EqualGapEndsTheFrame) {
  at(0ms, hex("01 03"));
  at(2ms + gap, hex("04"));
  EXPECT_EQ(log.frames, Frames{hex("01 03")});
  EXPECT_EQ(log.ends, std::vector<Time>{2ms + gap + character});
  silence();
  EXPECT_EQ(log.frames, (Frames{hex("01 03"), hex("04")}));
}

// 9.3.2 (1)(d) would end the frame here; Cnet KO 4.3.1 is followed.
TEST_F(RtuReceiverTest, BetweenOneAndAHalfCharactersAndTheTimeIsOneFrame) {
  at(0ms, hex("01"));
  at(1ms + 3 * character / 2, hex("02"));
  at(3500us + 3 * character, hex("03"));
  silence();
  EXPECT_EQ(log.frames, Frames{hex("01 02 03")});
}

TEST_F(RtuReceiverTest, LateHostStillSeparates) {
  at(0ms, hex("01"));
  at(1s, hex("02"));
  EXPECT_EQ(log.ends, std::vector<Time>{1ms + gap + character});
}

TEST_F(RtuReceiverTest, LongestFrameAndOnePast) {
  at(0ms, Bytes(rtu_max_frame, 1));
  silence();
  EXPECT_EQ(log.frames, Frames{Bytes(rtu_max_frame, 1)});
  at(1s, Bytes(rtu_max_frame + 1, 1));
  silence();
  at(2s, Bytes(rtu_max_frame, 1));
  at(2s + 256ms, Bytes(2, 1));
  silence();
  EXPECT_EQ(log.frames.size(), 1u);
  EXPECT_EQ(log.broken, (Broken{plc::service_status::too_long, plc::service_status::too_long}));
  at(5s, hex("01"));
  silence();
  EXPECT_EQ(log.frames.back(), hex("01"));
}

TEST_F(RtuReceiverTest, BehindAPtyBytesComeWithoutCharacterTime) {
  RtuReceiver pty(20ms);
  pty.receive({hex("01 03"), 5ms, {}}, log);
  pty.receive({hex("04"), 24ms, {}}, log);
  EXPECT_EQ(pty.wake_at(), 44ms);
  pty.advance(44ms, log);
  EXPECT_EQ(log.frames, Frames{hex("01 03 04")});
}

TEST_F(RtuReceiverTest, ResetForgets) {
  at(0ms, hex("01 03"));
  receiver.reset();
  EXPECT_EQ(receiver.wake_at(), std::nullopt);
  at(3ms, hex("04"));
  silence();
  EXPECT_EQ(log.frames, Frames{hex("04")});
}

}  // namespace
}  // namespace fieldproof::modbus
