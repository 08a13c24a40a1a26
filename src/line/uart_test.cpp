#include "src/line/uart.hpp"

#include <gtest/gtest.h>

#include "src/line/test_settings.hpp"

namespace fieldproof::line {
namespace {

using test::n81;

Burst burst_of(Bytes bytes, const LineSettings& sender, Time start = 1ms) {
  return {std::move(bytes), start, sender.character_time()};
}

/// All bytes in order, the bursts joined.
Bytes bytes_of(const Reading& reading) {
  Bytes all;
  for (const Burst& burst : reading.bursts)
    all.insert(all.end(), burst.bytes.begin(), burst.bytes.end());
  return all;
}

Reading read(Bytes bytes, const LineSettings& sender, const LineSettings& receiver) {
  return read_burst(burst_of(std::move(bytes), sender), sender, receiver);
}

TEST(Uart, EqualSettingsAreTheIdentity) {
  const Reading reading = read({0x05, 0x30, 0xFF}, n81, n81);
  ASSERT_EQ(reading.bursts.size(), 1u);
  EXPECT_EQ(reading.bursts[0].bytes, (Bytes{0x05, 0x30, 0xFF}));
  EXPECT_EQ(reading.bursts[0].start, 1ms);
  EXPECT_EQ(reading.errors, LineErrors{});
}

TEST(Uart, SevenDataBitsDropBitSeven) {
  const LineSettings e71{9600, 7, 'E', 1};
  EXPECT_EQ(bytes_of(read({0xC1, 0x41}, e71, e71)), (Bytes{0x41, 0x41}));
}

// Start, 1 0 0 0 0 0 1 0, stop: bit 7 stands where 7E1 expects its parity.
TEST(Uart, EightBitsReadAsSevenEven) {
  const LineSettings e71{9600, 7, 'E', 1};
  EXPECT_EQ(bytes_of(read({0x41}, n81, e71)), (Bytes{0x41}));  // two ones, bit 7 is 0: even
  EXPECT_EQ(bytes_of(read({0xC3}, n81, e71)), (Bytes{0x43}));  // three ones, bit 7 is 1: even
  const Reading odd = read({0x43}, n81, e71);                  // three ones, bit 7 is 0
  EXPECT_TRUE(odd.bursts.empty());
  EXPECT_EQ(odd.errors, (LineErrors{.parity = 1, .framing = 0}));
}

TEST(Uart, SevenEvenReadAsEightBitsCarriesParityInBitSeven) {
  const Reading reading = read({0x41, 0x43}, {9600, 7, 'E', 1}, n81);
  EXPECT_EQ(bytes_of(reading), (Bytes{0x41, 0xC3}));
  EXPECT_EQ(reading.errors, LineErrors{});
}

TEST(Uart, ParityBitReadAsStopBit) {
  const LineSettings e81{9600, 8, 'E', 1};
  EXPECT_EQ(bytes_of(read({0x43}, e81, n81)), (Bytes{0x43}));  // parity 1 passes as stop bit
  const Reading low = read({0x41}, e81, n81);                  // parity 0 does not
  EXPECT_TRUE(low.bursts.empty());
  EXPECT_EQ(low.errors, (LineErrors{.parity = 0, .framing = 1}));
}

// The receiver takes the stop bit as parity and the next start bit as stop bit. It then finds an
// edge inside the second character: 0 0 0 1 0 and the idle line, 0xE8 with four ones and parity 1.
TEST(Uart, MissingParityShiftsIntoTheNextCharacter) {
  const Reading reading = read({0x43, 0x43}, n81, {9600, 8, 'E', 1});
  EXPECT_TRUE(reading.bursts.empty());
  EXPECT_EQ(reading.errors, (LineErrors{.parity = 1, .framing = 1}));
}

TEST(Uart, EvenReadAsOddIsAlwaysAParityError) {
  Bytes every;
  for (int b = 0; b < 256; ++b) every.push_back(static_cast<Byte>(b));
  const Reading reading = read(every, {9600, 8, 'E', 1}, {9600, 8, 'O', 1});
  EXPECT_TRUE(reading.bursts.empty());
  EXPECT_EQ(reading.errors, (LineErrors{.parity = 256, .framing = 0}));
}

// 0x55 at 9600 is 00 11 00 11 00 11 00 11 00 11 in bits of 19200: the first ten end in a low stop
// bit. The next edge is that of bit 12: 0 0 1 1 0 0 1 1, then idle: 0xE6.
TEST(Uart, HalfSpeedReadAtDoubleSpeed) {
  const LineSettings fast{19200, 8, 'N', 1};
  const Reading reading = read({0x55}, n81, fast);
  EXPECT_EQ(bytes_of(reading), (Bytes{0xE6}));
  EXPECT_EQ(reading.bursts[0].start, 1ms + 625us);  // 12 / 19200 s
  EXPECT_EQ(reading.bursts[0].character_time, fast.character_time());
  EXPECT_EQ(reading.errors, (LineErrors{.parity = 0, .framing = 1}));
  EXPECT_EQ(bytes_of(read({0xFF}, n81, fast)), (Bytes{0xFE}));  // the start bit is also its bit 0
}

// The receiver samples the sender's bits 1, 4, 7, 10 ...: start 0, then bits 3 and 6 of the byte,
// then the idle line.
TEST(Uart, TripleSpeedReadSlowly) {
  const LineSettings sender{57600, 8, 'N', 1}, receiver{19200, 8, 'N', 1};
  EXPECT_EQ(bytes_of(read({0x80}, sender, receiver)), (Bytes{0xFC}));
  EXPECT_EQ(bytes_of(read({0x88}, sender, receiver)), (Bytes{0xFD}));
}

TEST(Uart, AStartBitThatIsTooShortIsAGlitch) {
  const Reading reading = read({0xFF, 0xFF}, {57600, 8, 'N', 1}, {19200, 8, 'N', 1});
  EXPECT_TRUE(reading.bursts.empty());
  EXPECT_EQ(reading.errors, LineErrors{});
}

TEST(Uart, ALongLowLevelIsOneFramingError) {
  const Reading reading = read({0x00}, {1200, 8, 'N', 1}, {115200, 8, 'N', 1});
  EXPECT_TRUE(reading.bursts.empty());
  EXPECT_EQ(reading.errors, (LineErrors{.parity = 0, .framing = 1}));
}

TEST(Uart, StopBitsMayDiffer) {
  const LineSettings n82{9600, 8, 'N', 2};
  const Reading to_one = read({0x41, 0x42}, n82, n81);
  ASSERT_EQ(to_one.bursts.size(), 2u);  // one bit of silence between them
  EXPECT_EQ(to_one.bursts[1].start, 1ms + n82.character_time());
  EXPECT_EQ(bytes_of(to_one), (Bytes{0x41, 0x42}));
  EXPECT_EQ(bytes_of(read({0x41, 0x42}, n81, n82)), (Bytes{0x41, 0x42}));
}

TEST(Uart, BitByBitEqualsTheIdentityAtEverySetting) {
  Bytes every;
  for (int b = 0; b < 256; ++b) every.push_back(static_cast<Byte>(b));
  for (const int baud : {1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200}) {
    for (const int data : {7, 8}) {
      for (const char parity : {'N', 'E', 'O'}) {
        for (const int stop : {1, 2}) {
          const LineSettings settings{baud, data, parity, stop};
          Burst burst = burst_of(every, settings);
          drop_unsent_bits(burst.bytes, settings);
          Waveform wave;
          wave.add(burst, settings);
          Time from = burst.start;
          for (std::size_t i = 0; i < every.size(); ++i) {
            const auto c = next_character(wave, settings, from);
            ASSERT_TRUE(c) << to_string(settings) << " byte " << i;
            ASSERT_TRUE(c->good()) << to_string(settings) << " byte " << i;
            ASSERT_EQ(c->value, burst.bytes[i]) << to_string(settings);
            ASSERT_EQ(c->start, burst.start + static_cast<Duration::rep>(i) * burst.character_time);
            from = c->hunt_from;
          }
          EXPECT_FALSE(next_character(wave, settings, from));
        }
      }
    }
  }
}

TEST(Uart, LowWinsWhereTwoTransmit) {
  const Burst a = burst_of({0xF5}, n81), b = burst_of({0x5F}, n81);
  Waveform wave;
  wave.add(a, n81);
  wave.add(b, n81);
  const auto c = next_character(wave, n81, 0ns);
  ASSERT_TRUE(c);
  EXPECT_EQ(c->value, 0x55);  // F5 & 5F
}

TEST(Uart, AMutedReceiverReadsIdle) {
  const Burst a = burst_of({0x41, 0x42}, n81);
  Waveform wave;
  wave.add(a, n81);
  wave.mute(a.start, a.start + a.character_time);
  const auto c = next_character(wave, n81, 0ns);
  ASSERT_TRUE(c);
  EXPECT_EQ(c->value, 0x42);
  EXPECT_EQ(c->start, a.start + a.character_time);
}

}  // namespace
}  // namespace fieldproof::line
