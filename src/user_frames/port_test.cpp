#include "src/user_frames/port.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "src/user_frames/definition.hpp"

namespace fieldproof::user_frames {
namespace {

using testing::HasSubstr;

constexpr const char* talker = R"j({
  "title": "a port that hears and answers",
  "groups": {
    "OUT": {"type": "send", "head": [{"hex": "05"}], "tail": [{"hex": "04"}, {"check": "byte_sum", "ascii": true}],
            "frames": {"DATA": {"body": [{"variable": 2, "memory": "%MW100", "convert": "hex_to_ascii"}]},
                       "TEXT": {"body": [{"variable": 4, "memory": "%MW300", "convert": "ascii_to_hex"}]}}},
    "ACK": {"type": "send", "frames": {"OK": {"body": [{"hex": "06"}, {"variable": 2, "memory": "%MW200"}]}}},
    "IN": {"type": "receive", "head": [{"hex": "02"}], "tail": [{"hex": "03"}, {"check": "byte_sum"}],
           "frames": {"SET": {"body": [{"text": "S"}, {"fixed": 2, "memory": "%MW200"}], "answer": "ACK.OK"},
                      "HEX": {"body": [{"text": "H"}, {"fixed": 4, "memory": "%MW210", "convert": "ascii_to_hex", "swap": 2}]},
                      "ALL": {"body": [{"text": "A"}, {"variable": true, "memory": "%MW220"}]}}},
    "OPEN": {"type": "receive", "head": [{"text": "LOG"}], "frames": {"LINE": {"body": [{"variable": true, "memory": "%MB500"}]}}}
  }
})j";

class Port {
 public:
  explicit Port(const char* text = talker, nlohmann::json config = nlohmann::json::object()) {
    const auto definition = user_frames::parse_frame_definition(text, "talker.json");
    if (!definition) throw std::runtime_error(definition.error().message);
    auto made = make_user_frame_device(*definition, config);
    if (!made) throw std::runtime_error(made.error().message);
    device_ = std::move(*made);
  }

  /// Sends after a pause, and what comes back within 3 s.
  std::string say(std::string_view hex, Duration pause = 100ms) {
    now_ += pause;
    const Bytes bytes = *from_hex(hex);
    device_->line()->receive({bytes, now_, character});
    now_ += character * static_cast<Duration::rep>(bytes.size());
    return hear();
  }

  /// Until nothing happens any more.
  std::string hear() {
    Bytes out;
    while (const auto wake = device_->line()->wake_at()) {
      if (*wake > now_ + 3s) break;
      if (*wake > now_ && out.empty()) spoke_after = *wake - now_;
      const Bytes part = device_->line()->advance(std::max(*wake, now_));
      out.insert(out.end(), part.begin(), part.end());
    }
    return to_hex(out);
  }

  std::string get(std::string_view address, std::size_t digits = 0) const {
    const auto value = device_->get(address, digits);
    return value ? *value : value.error().message;
  }
  void set(std::string_view address, std::string_view hex) {
    ASSERT_TRUE(device_->set(address, hex));
  }
  plc::EmulatedDevice& device() { return *device_; }
  std::string act(std::string_view action) {
    const Status done = device_->act(action);
    return done ? hear() : done.error().message;
  }

  static constexpr Duration character = 1ms;
  Duration spoke_after{};

 private:
  std::unique_ptr<plc::EmulatedDevice> device_;
  Time now_{};
};

TEST(UserFramePort, SendsWhatItsMemoryHolds) {
  Port port;
  port.set("%MW100", "12AB");
  EXPECT_EQ(port.act("send OUT.DATA"), "05 31 32 41 42 04 45 46");  // 05+31+32+41+42+04 = EF
  EXPECT_EQ(port.get("@services"), "0001");
}

TEST(UserFramePort, AMemoryWithoutHexDigitsIsNotSent) {
  Port port;
  port.set("%MW300", "31324758");
  EXPECT_THAT(port.act("send OUT.TEXT"), HasSubstr("cannot send OUT.TEXT: body 0 at %MW300 holds "
                                                   "31 32 47 58, which are not ASCII hex digits"));
}

TEST(UserFramePort, WithoutABlockOpenMemoryIsNotSentAndNotStored) {
  Port port(R"j({"title": "open", "groups": {
    "OUT": {"type": "send", "tail": [{"hex": "0D"}], "frames": {"A": {"body": [{"variable": 2, "memory": true}]},
                                                               "B": {"body": [{"variable": true, "memory": true}]}}},
    "IN": {"type": "receive", "head": [{"text": "I"}], "frames": {"C": {"body": [{"fixed": 2, "memory": true}]}}}}})j");
  for (const char* action : {"send OUT.A", "send OUT.B"})
    EXPECT_THAT(port.act(action),
                HasSubstr("the memory of body 0 is given by a P2P block, and there is none"));
  port.say("49 41 42");
  EXPECT_EQ(port.get("@services"), "0001");
}

TEST(UserFramePort, AnUnknownFrameIsAnErrorThatNamesTheNearest) {
  Port port;
  EXPECT_THAT(
      port.act("send OUT.DATE"),
      HasSubstr(
          "there is no such frame; the first one to send is OUT.DATA; did you mean 'OUT.DATA'?"));
  EXPECT_THAT(port.act("send IN.SET"), HasSubstr("this frame is received"));
  EXPECT_THAT(port.act("sned OUT.DATA"), HasSubstr("send GROUP.FRAME"));
}

TEST(UserFramePort, StoresAndAnswers) {
  Port port;
  EXPECT_EQ(port.say("02 53 12 34 03 9E"), "06 12 34");
  EXPECT_EQ(port.get("%MW200"), "1234");
  EXPECT_EQ(port.get("@services"), "0002");
  EXPECT_EQ(port.get("@status"), "00");
}

TEST(UserFramePort, AWrongCheckIsDropped) {
  Port port;
  EXPECT_EQ(port.say("02 53 12 34 03 9F"), "");
  EXPECT_EQ(port.get("%MW200"), "0000");
  EXPECT_EQ(port.get("@status"), "03");
  EXPECT_EQ(port.get("@errors"), "0001");
  EXPECT_EQ(port.say("02 53 12 34 03 9E"), "06 12 34");
}

TEST(UserFramePort, BytesOfNoFrameArePassedOver) {
  Port port;
  EXPECT_EQ(port.say("FF FE 02 02 53 12 34 03 9E FF"), "06 12 34");
  EXPECT_EQ(port.get("@errors"), "0002");  // before the frame, and behind it
  EXPECT_EQ(port.get("@status"), "01");
}

TEST(UserFramePort, WhatIsPassedOverIsOneErrorARun) {
  Port port;
  (void)port.say("FF FE");
  (void)port.say("FD", 1ms);
  EXPECT_EQ(port.get("@errors"), "0001");
  (void)port.say("FD");
  EXPECT_EQ(port.get("@errors"), "0002");
}

TEST(UserFramePort, TwoFramesInARowAreBothAnswered) {
  Port port;
  EXPECT_EQ(port.say("02 53 12 34 03 9E 02 53 00 01 03 59"), "06 12 34 06 00 01");
}

TEST(UserFramePort, AFrameMayComeInPieces) {
  Port port;
  EXPECT_EQ(port.say("02 53 12"), "");
  EXPECT_EQ(port.say("34 03 9E"), "");  // 100 ms later: two broken pieces
  EXPECT_EQ(port.get("@status"), "01");
  EXPECT_EQ(port.get("@errors"), "0002");
}

TEST(UserFramePort, TheInterCharacterTimeEndsAFrame) {
  const auto second_piece_after = [](Duration pause) {
    Port port(talker, {{"inter_character_ms", 50}});
    port.device().line()->receive({{0x02, 0x53, 0x12}, 1s, 1ms});
    port.device().line()->receive({{0x34, 0x03, 0x9E}, 1s + 3ms + pause, 1ms});
    return port.get("%MW200");
  };
  EXPECT_EQ(second_piece_after(50ms), "1234");
  EXPECT_EQ(second_piece_after(51ms), "0000");
}

TEST(UserFramePort, ReceivingConvertsThenSwaps) {
  Port port;
  EXPECT_EQ(port.say("02 48 31 32 61 42 03 53"), "");
  EXPECT_EQ(port.get("%MW210"), "AB12");
}

TEST(UserFramePort, DigitsThatAreNotHexAreDropped) {
  Port port;
  EXPECT_EQ(port.say("02 48 31 32 33 47 03 2A"), "");
  EXPECT_EQ(port.get("%MW210"), "0000");
  EXPECT_EQ(port.get("@status"), "0D");
}

TEST(UserFramePort, AVariableEndsAtItsTail) {
  Port port;
  (void)port.say("02 41 11 22 33 44 55 03 45");
  EXPECT_EQ(port.get("%MW220", 12), "112233445500");
}

TEST(UserFramePort, AnOddByteFillsTheHighByteAlone) {
  Port port;
  port.set("%MW220", "AAAA");
  (void)port.say("02 41 11 03 57");
  EXPECT_EQ(port.get("%MW220"), "11AA");
}

TEST(UserFramePort, WithoutATailTheSilenceEndsTheFrame) {
  Port port;
  (void)port.say("4C 4F 47 31 32 33");
  EXPECT_EQ(port.get("%MB500"), "31");
  EXPECT_EQ(port.get("%MW250"), "3231");
  EXPECT_EQ(port.get("%MB502"), "33");
  EXPECT_EQ(port.get("@services"), "0001");
}

TEST(UserFramePort, AFrameHasAtMost1024Bytes) {
  Port port;
  const auto long_line = [](std::size_t size) {
    Bytes line = to_bytes("LOG");
    line.resize(size, 'x');
    return to_hex(line);
  };
  (void)port.say(long_line(1024));
  EXPECT_EQ(port.get("%MB1520"), "78");  // the last of 1021
  EXPECT_EQ(port.get("%MB1521"), "00");
  EXPECT_EQ(port.get("@errors"), "0000");
  (void)port.say(long_line(1025));
  EXPECT_EQ(port.get("@errors"), "0001");
  EXPECT_EQ(port.get("@status"), "02");
}

TEST(UserFramePort, InStopItIsDeafAndDumb) {
  Port port;
  EXPECT_EQ(port.act("stop"), "");
  EXPECT_EQ(port.act("send OUT.DATA"), "");
  EXPECT_EQ(port.say("02 53 12 34 03 9E"), "");
  EXPECT_EQ(port.get("%MW200"), "0000");
  EXPECT_EQ(port.act("run"), "");
  EXPECT_EQ(port.say("02 53 12 34 03 9E"), "06 12 34");
}

TEST(UserFramePort, APowerCycleForgetsWhatWasHalfReceived) {
  Port port(talker, {{"inter_character_ms", 500}});
  port.set("%MW100", "1234");
  port.device().line()->receive({{0x02, 0x53, 0x12}, 1s, 1ms});
  ASSERT_TRUE(port.device().act("power_cycle"));
  port.device().line()->receive({{0x34, 0x03, 0x9E}, 1s + 3ms, 1ms});
  EXPECT_EQ(port.get("%MW200"), "0000");
  EXPECT_EQ(port.get("%MW100"), "1234");
}

TEST(UserFramePort, TheDelayIsThatOfTheAnswer) {
  Port port(talker, {{"rs485", true}, {"delay_ms", 100}});
  EXPECT_EQ(port.say("02 53 12 34 03 9E"), "06 12 34");
  EXPECT_EQ(port.spoke_after, 100ms);
}

TEST(UserFramePort, AnUnknownConfigurationKeyIsAnError) {
  const auto definition = user_frames::parse_frame_definition(talker, "talker.json");
  ASSERT_TRUE(definition);
  const auto made = make_user_frame_device(*definition, {{"mod", "run"}});
  ASSERT_FALSE(made);
  EXPECT_THAT(made.error().message, HasSubstr("did you mean 'mode'"));
}

}  // namespace
}  // namespace fieldproof::user_frames
