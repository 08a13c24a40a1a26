#include "src/ls_bus/inverter.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "src/line/line.hpp"

namespace fieldproof::ls_bus {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// Header, body with its sum, EOT.
Bytes framed(char head, std::string_view body) {
  unsigned sum = 0;
  for (const char c : body) sum += static_cast<unsigned char>(c);
  return to_bytes(head + std::string(body) + hex_number(sum & 0xFF, 2) + '\x04');
}

Bytes enq(std::string_view body) { return framed('\x05', body); }

/// A reply as text: "ACK 01R1234", "NAK 01RIA", "" for silence; its sum is checked and left out.
std::string shown(ByteView reply) {
  if (reply.empty()) return "";
  const std::string text = to_text(reply);
  if (text.size() < 4) return "no frame: " + to_hex(reply);
  const std::string body = text.substr(1, text.size() - 4);
  if (framed(text[0], body) != Bytes(reply.begin(), reply.end()))
    return "wrong form: " + to_hex(reply);
  return (text[0] == '\x06' ? "ACK " : text[0] == '\x15' ? "NAK " : "? ") + body;
}

std::string ask(Inverter& inverter, std::string_view body) {
  return shown(inverter.answer(enq(body)));
}

TEST(Inverter, ReadsAndWritesAsTheManualHasIt) {
  Inverter inverter({});
  ASSERT_TRUE(inverter.set("1230", "1234"));
  EXPECT_EQ(to_hex(inverter.answer(*from_hex("05 30 31 52 31 32 33 30 31 41 41 04"))),
            "06 30 31 52 31 32 33 34 37 44 04");
  EXPECT_EQ(to_hex(inverter.answer(*from_hex("05 30 31 57 31 32 33 30 31 30 30 46 46 39 42 04"))),
            "06 30 31 57 30 30 46 46 41 34 04");
  EXPECT_EQ(*inverter.get("1230", 4), "00FF");
}

TEST(Inverter, ReadsOneToEightWords) {
  Inverter inverter({});
  const std::string words =
      "12345678"
      "9ABCDEF0"
      "A55A1EE1"
      "0FF0C33C";
  ASSERT_TRUE(inverter.set("0100", words));
  for (unsigned count = 1; count <= ls_max_words; ++count)
    EXPECT_EQ(ask(inverter, "01R0100" + std::to_string(count)),
              "ACK 01R" + words.substr(0, 4 * count));
}

TEST(Inverter, WritesOneToEightWordsAndNothingBeyond) {
  const std::string words =
      "12345678"
      "9ABCDEF0"
      "A55A1EE1"
      "0FF0C33C";
  for (unsigned count = 1; count <= ls_max_words; ++count) {
    Inverter inverter({});
    ASSERT_TRUE(inverter.set("00FF",
                             "FFFF"
                             "EEEE"
                             "EEEE"
                             "EEEE"
                             "EEEE"
                             "EEEE"
                             "EEEE"
                             "EEEE"
                             "EEEE"
                             "DDDD"));
    const std::string data = words.substr(0, 4 * count);
    EXPECT_EQ(ask(inverter, "01W0100" + std::to_string(count) + data), "ACK 01W" + data);
    EXPECT_EQ(*inverter.get("0100", 4 * count), data);
    EXPECT_EQ(*inverter.get("00FF", 4), "FFFF");
    EXPECT_EQ(*inverter.get(hex_number(0x100 + count, 4), 4), count == 8 ? "DDDD" : "EEEE");
  }
}

TEST(Inverter, CountFirstIsASetting) {
  Inverter inverter({.write_order = LsWriteOrder::count_first});
  EXPECT_EQ(ask(inverter, "01W1123000FF"), "ACK 01W00FF");
  EXPECT_EQ(*inverter.get("1230", 4), "00FF");
  EXPECT_EQ(ask(inverter, "01R12301"), "ACK 01R00FF");
}

TEST(Inverter, RefusesWhatTheFrameAloneCannotTell) {
  Inverter inverter({});
  EXPECT_EQ(ask(inverter, "01R10001"), "NAK 01RIA");
  EXPECT_EQ(ask(inverter, "01R0FFF2"), "NAK 01RIA");
  EXPECT_EQ(ask(inverter, "01R13001"), "NAK 01RIA");
  EXPECT_EQ(ask(inverter, "01W100010001"), "NAK 01WIA");
  EXPECT_EQ(ask(inverter, "01W000310001"), "NAK 01WWM");
  EXPECT_EQ(ask(inverter, "01R00031"), "ACK 01R0000");
  EXPECT_EQ(ask(inverter, "01X12301"), "NAK 01XIF");
  EXPECT_EQ(ask(inverter, "01R12309"), "NAK 01RID");
}

TEST(Inverter, AWriteIsAllOrNothing) {
  Inverter inverter({});
  EXPECT_EQ(ask(inverter, "01W0008211112222"), "NAK 01WWM");
  EXPECT_EQ(ask(inverter, "01W0FFF211112222"), "NAK 01WIA");
  EXPECT_EQ(ask(inverter, "01W000821111222G"), "NAK 01WID");
  EXPECT_EQ(*inverter.get("0008", 8), "00000000");
  EXPECT_EQ(*inverter.get("0FFF", 4), "0000");
}

TEST(Inverter, DigitsAreReadInEitherCaseAndWrittenInUpperCase) {
  Inverter inverter({.station = 0xAB});
  EXPECT_EQ(ask(inverter, "abW12fe1a55a"), "ACK ABWA55A");
  EXPECT_EQ(*inverter.get("12FE", 4), "A55A");
}

TEST(Inverter, IsSilentToOtherStationsAndBrokenFrames) {
  Inverter inverter({});
  EXPECT_EQ(ask(inverter, "02R12301"), "");
  EXPECT_EQ(ask(inverter, "FFR12301"), "");
  EXPECT_EQ(ask(inverter, "00R12301"), "");
  EXPECT_EQ(shown(inverter.answer(*from_hex("05 30 32 52 31 32 33 30 31 30 30 04"))), "")
      << "the sum of another's request is not looked at";
  EXPECT_EQ(shown(inverter.answer(*from_hex("05 30 31 52 31 32 33 30 31 30 30 04"))), "NAK 01RFE");
  EXPECT_EQ(shown(inverter.answer(*from_hex("05 30 31 39 32 04"))), "");
}

TEST(Inverter, AnswersAfterItsDelayInTheOrderOfRequests) {
  Inverter inverter({.delay = 10ms});
  Bytes both = enq("01R00001");
  const Bytes second = enq("01X");
  both.insert(both.end(), second.begin(), second.end());
  inverter.receive({both, 0ms, 1ms});
  EXPECT_EQ(inverter.wake_at(), 12ms + 10ms);
  EXPECT_EQ(shown(inverter.advance(21ms)), "");
  EXPECT_EQ(shown(inverter.advance(22ms)), "ACK 01R0000");
  EXPECT_EQ(inverter.wake_at(), 19ms + 10ms);
  EXPECT_EQ(shown(inverter.advance(29ms)), "NAK 01XIF");
  EXPECT_EQ(inverter.wake_at(), std::nullopt);
}

TEST(Inverter, WaitsForTheEndOfAFrame) {
  Inverter inverter({});
  const Bytes frame = enq("01R00001");
  inverter.receive({Bytes(frame.begin(), frame.begin() + 5), 0ms, 1ms});
  EXPECT_EQ(inverter.wake_at(), std::nullopt);
  inverter.receive({Bytes(frame.begin() + 5, frame.end()), 60s, 1ms});
  EXPECT_EQ(shown(inverter.advance(61s)), "ACK 01R0000");
}

TEST(Inverter, PowerCycleLosesFramesAndKeepsParameters) {
  Inverter inverter({});
  ASSERT_TRUE(inverter.set("1230", "A55A"));
  inverter.receive({enq("01R00001"), 0ms, 1ms});
  const Bytes cut = enq("01R12301");
  inverter.receive({Bytes(cut.begin(), cut.begin() + 5), 20ms, 1ms});
  ASSERT_TRUE(inverter.act("power_cycle"));
  EXPECT_EQ(inverter.wake_at(), std::nullopt);
  inverter.receive({Bytes(cut.begin() + 5, cut.end()), 40ms, 1ms});
  EXPECT_EQ(inverter.wake_at(), std::nullopt) << "the rest of a frame whose beginning was lost";
  EXPECT_EQ(ask(inverter, "01R12301"), "ACK 01RA55A");
  EXPECT_TRUE(inverter.act("stop"));
  EXPECT_TRUE(inverter.act("run"));
  EXPECT_THAT(inverter.act("rn").error().message, HasSubstr("did you mean 'run'"));
}

TEST(Inverter, OnALineWithAnother) {
  line::SimulatedLine line(line::LineSettings{});
  Inverter first({.station = 1}), second({.station = 2});
  line.attach(first, line::LineSettings{});
  line.attach(second, line::LineSettings{});
  ASSERT_TRUE(second.set("1230", "0002"));
  line.transmit(enq("02R12301"));
  const Burst reply = line.receive(line.now() + 1s);
  EXPECT_EQ(shown(reply.bytes), "ACK 02R0002") << "the reply of one is no request to the other";
}

TEST(Inverter, BackDoor) {
  Inverter inverter({});
  EXPECT_TRUE(inverter.set("h0000", "123456789ABC")) << "rights do not bind it";
  EXPECT_EQ(*inverter.get("0001", 0), "5678");
  EXPECT_EQ(*inverter.get("H0000", 12), "123456789ABC");
  EXPECT_THAT(inverter.set("1000", "0001").error().message,
              HasSubstr("the inverter has 0000-0003"));
  EXPECT_THAT(inverter.set("0FFF", "00010002").error().message,
              HasSubstr("2 words at parameter 0FFF"));
  EXPECT_THAT(inverter.set("%MW100", "0001").error().message, HasSubstr("not four hex digits"));
  EXPECT_THAT(inverter.set("1230", "001").error().message, HasSubstr("four hex digits a word"));
  EXPECT_THAT(inverter.set("1230", "").error().message, HasSubstr("there is no value"));
  EXPECT_THAT(inverter.get("1230", 6).error().message, HasSubstr("a word has four"));
  EXPECT_THAT(inverter.get("@errors", 4).error().message, HasSubstr("no counters"));
}

TEST(InverterConfig, EveryKey) {
  const Result<InverterConfig> config = parse_inverter_config(json::parse(R"({
    "station": "32", "write_order": "count_first", "line": "19200-7E2", "delay_ms": 2.5, "bench_line": "1200", "rs485": true,
    "inter_character_floor_ms": 20, "neighbours": [2], "model": "inverter", "protocol": "ls-bus"})"));
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->station, 32u);
  EXPECT_EQ(config->write_order, LsWriteOrder::count_first);
  EXPECT_EQ(config->delay, 2500us);
}

TEST(InverterConfig, Defaults) {
  const Result<InverterConfig> config = parse_inverter_config(json::object());
  ASSERT_TRUE(config);
  EXPECT_EQ(config->station, 1u);
  EXPECT_EQ(config->write_order, LsWriteOrder::address_first);
  EXPECT_EQ(config->delay, 0ms);
}

TEST(InverterConfig, ErrorsNameTheKey) {
  const auto error_of = [](const json& config) {
    const Result<std::unique_ptr<plc::EmulatedDevice>> inverter = make_inverter(config);
    return inverter ? "" : inverter.error().message;
  };
  EXPECT_THAT(error_of({{"station", 256}}), HasSubstr("station is 256"));
  EXPECT_THAT(error_of({{"write_order", "adress_first"}}),
              HasSubstr("address_first or count_first"));
  EXPECT_THAT(error_of({{"line", "9600-9N1"}}), HasSubstr("9600-9N1"));
  EXPECT_THAT(error_of({{"delay_ms", -1}}), HasSubstr("delay_ms"));
  EXPECT_THAT(error_of({{"write_oder", "count_first"}}), HasSubstr("did you mean 'write_order'"));
  EXPECT_EQ(error_of({{"write_order", "count_first"}}), "");
}

}  // namespace
}  // namespace fieldproof::ls_bus
