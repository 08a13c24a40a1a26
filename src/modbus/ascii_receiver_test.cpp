#include "src/modbus/ascii_receiver.hpp"

#include <gtest/gtest.h>

#include <random>

#include "src/modbus/test_frames.hpp"
#include "src/plc/counters.hpp"

namespace fieldproof::modbus {
namespace {

using plc::test::Broken;
using plc::test::Frames;
using plc::test::Log;
using test::character;

constexpr std::uint16_t broken = plc::service_status::not_modbus;

class AsciiReceiverTest : public ::testing::Test {
 protected:
  void at(Time start, std::string_view text) {
    receiver.receive({to_bytes(text), start, character}, log);
  }

  AsciiReceiver receiver;
  Log log;
};

TEST_F(AsciiReceiverTest, ColonToCrLf) {
  at(10ms, ":0107F8\r\n");
  EXPECT_EQ(log.frames, Frames{to_bytes(":0107F8\r\n")});
  EXPECT_EQ(log.ends, std::vector<Time>{19ms});
  EXPECT_EQ(receiver.wake_at(), std::nullopt);
  EXPECT_TRUE(log.broken.empty());
}

TEST_F(AsciiReceiverTest, ColonRestarts) {
  at(0ms, ":0103000:0107F8\r\n");
  EXPECT_EQ(log.frames, Frames{to_bytes(":0107F8\r\n")});
  EXPECT_EQ(log.broken, Broken{broken});
  at(1ms, "\r::0107F8\r\n");
  EXPECT_EQ(log.frames.size(), 2u);
}

TEST_F(AsciiReceiverTest, OnlyCrLfTogetherEnd) {
  at(0ms, ":0107F8\r");
  at(9ms, "0\n\n\r\r");
  EXPECT_TRUE(log.frames.empty());
  at(15ms, "\n");
  EXPECT_EQ(log.frames,
            Frames{to_bytes(":0107F8\r0\n\n\r\r\n")});  // no hex: counted when it is decoded
}

TEST_F(AsciiReceiverTest, BytesBeforeTheColonCountOnceARun) {
  at(0ms, "noise");
  at(5ms, "\r\n:0107F8\r\n");
  EXPECT_EQ(log.frames, Frames{to_bytes(":0107F8\r\n")});
  EXPECT_EQ(log.broken, Broken{broken});
  at(3s, "a");
  at(3001ms + 1s, "b");
  EXPECT_EQ(log.broken, (Broken{broken, broken}));
  at(6s, "c");
  EXPECT_EQ(log.broken, (Broken{broken, broken, broken}));
}

TEST_F(AsciiReceiverTest, OneSecondBetweenCharactersIsAllowed) {
  at(0ms, ":0107");
  at(5ms + 1s, "F8\r\n");
  EXPECT_EQ(log.frames.size(), 1u);
}

TEST_F(AsciiReceiverTest, MoreEndsTheFrame) {
  at(0ms, ":0107");
  at(5ms + 1s + 1ns, "F8\r\n");
  EXPECT_TRUE(log.frames.empty());
  EXPECT_EQ(log.broken, (Broken{broken, broken}));  // no end; then characters outside a frame
}

TEST_F(AsciiReceiverTest, SilenceEndsTheFrameByTheClock) {
  at(0ms, ":0107");
  const Time wake = 5ms + 1s + character + 1ns;
  EXPECT_EQ(receiver.wake_at(), wake);
  receiver.advance(wake - 1ns, log);
  EXPECT_TRUE(log.broken.empty());
  receiver.advance(wake, log);
  EXPECT_EQ(log.broken, Broken{broken});
  EXPECT_EQ(receiver.wake_at(), std::nullopt);
}

TEST_F(AsciiReceiverTest, LongestFrameAndOnePast) {
  const std::string longest = ":" + std::string(ascii_max_frame - 3, '0') + "\r\n";
  at(0ms, longest);
  EXPECT_EQ(log.frames, Frames{to_bytes(longest)});
  at(1s, ":0" + longest.substr(1));
  EXPECT_EQ(log.frames.size(), 1u);
  EXPECT_EQ(log.broken, Broken{plc::service_status::too_long});
  at(2s, ":0107F8\r\n");
  EXPECT_EQ(log.frames.size(), 2u);
}

TEST_F(AsciiReceiverTest, ResetForgets) {
  at(0ms, ":0107");
  receiver.reset();
  EXPECT_EQ(receiver.wake_at(), std::nullopt);
  at(5ms, "F8\r\n");
  EXPECT_TRUE(log.frames.empty());
}

TEST(AsciiReceiverFuzz, HowBytesAreCutIntoBurstsDoesNotMatter) {
  std::mt19937 random(1979);
  constexpr std::string_view likely = "::\r\n\r\n0123AF\r\n";
  for (int round = 0; round < 2000; ++round) {
    Bytes bytes(random() % 60);
    for (Byte& b : bytes) b = static_cast<Byte>(likely[random() % likely.size()]);
    AsciiReceiver whole, cut;
    Log at_once, in_parts;
    whole.receive({bytes, 0ms, character}, at_once);
    for (std::size_t from = 0; from < bytes.size();) {
      const std::size_t size = std::min<std::size_t>(1 + random() % 5, bytes.size() - from);
      cut.receive(
          {test::part(bytes, from, from + size), character * static_cast<int>(from), character},
          in_parts);
      from += size;
    }
    ASSERT_EQ(at_once.frames, in_parts.frames) << to_hex(bytes);
    ASSERT_EQ(at_once.ends, in_parts.ends) << to_hex(bytes);
    ASSERT_EQ(at_once.broken, in_parts.broken) << to_hex(bytes);
  }
}

}  // namespace
}  // namespace fieldproof::modbus
