#include "src/modbus/modbus_plc.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "src/line/line.hpp"
#include "src/modbus/test_frames.hpp"

namespace fieldproof::modbus {

using line::LineSettings;

namespace {

using nlohmann::json;
using test::ascii;
using test::hex;
using test::operator+;
using test::part;
using test::rtu;
using ::testing::HasSubstr;

using Device = std::unique_ptr<plc::EmulatedDevice>;

Device plc_of(ModbusMode mode, const json& config, std::string_view model = "xbc-h") {
  Result<Device> plc = make_modbus_plc(mode, model, config);
  EXPECT_TRUE(plc) << (plc ? "" : plc.error().message);
  return plc ? std::move(*plc) : nullptr;
}

std::string error_of(const json& config, std::string_view model = "xbc-h") {
  const Result<Device> plc = make_modbus_plc(ModbusMode::rtu, model, config);
  return plc ? "" : plc.error().message;
}

/// What is sent until nothing more is to come.
Bytes drained(plc::EmulatedDevice& plc) {
  Bytes bytes;
  while (const auto wake = plc.line()->wake_at()) bytes = bytes + plc.line()->advance(*wake);
  return bytes;
}

Bytes ask(plc::EmulatedDevice& plc, Time start, const Bytes& frame) {
  plc.line()->receive({frame, start, 1ms});
  return drained(plc);
}

// --- Published exchanges with station 17 ---

TEST(ModbusPlc, PublishedExchanges) {
  const Device plc = plc_of(ModbusMode::rtu, {{"station", 17}});
  ASSERT_TRUE(plc->set("%MW1", "5E68759300D8"));
  ASSERT_TRUE(plc->set("%PW12", "BAC0035D"));
  ASSERT_TRUE(plc->set("%MW107", "AE4156524340"));
  ASSERT_TRUE(plc->set("%PW8", "000A"));
  constexpr std::pair<const char*, const char*> exchanges[] = {
      {"11 01 00 13 00 25 0E 84", "11 01 05 CD 6B B2 0E 1B 45 E6"},
      {"11 02 00 C4 00 16 BA A9", "11 02 03 AC DB 35 20 18"},
      {"11 03 00 6B 00 03 76 87", "11 03 06 AE 41 56 52 43 40 49 AD"},
      {"11 04 00 08 00 01 B2 98", "11 04 02 00 0A F8 F4"},
      {"11 05 00 AC FF 00 4E 8B", "11 05 00 AC FF 00 4E 8B"},
      {"11 06 00 01 00 03 9A 9B", "11 06 00 01 00 03 9A 9B"},
      {"11 0F 00 13 00 0A 02 CD 01 BF 0B", "11 0F 00 13 00 0A 26 99"},
      {"11 10 00 01 00 02 04 00 0A 01 02 C6 F0", "11 10 00 01 00 02 12 98"},
  };
  Time now{};
  for (const auto& [request, reply] : exchanges)
    EXPECT_EQ(to_hex(ask(*plc, now += 1s, hex(request))), reply) << request;
  EXPECT_EQ(*plc->get("%MW1", 8), "000A0102");
  EXPECT_EQ(*plc->get("@services", 0), "0008");
  EXPECT_EQ(*plc->get("@errors", 0), "0000");
}

TEST(ModbusPlc, PublishedAsciiExchange) {
  const Device plc = plc_of(ModbusMode::ascii, {{"station", 17}});
  ASSERT_TRUE(plc->set("%MW107", "AE4156524340"));
  EXPECT_EQ(to_text(ask(*plc, 1s, to_bytes(":1103006B00037E\r\n"))), ":110306AE4156524340CC\r\n");
  EXPECT_EQ(to_text(ask(*plc, 2s, to_bytes(":1103006b00037e\r\n"))), ":110306AE4156524340CC\r\n");
}

TEST(ModbusPlc, LongestReplies) {
  const Device plc = plc_of(ModbusMode::rtu, {{"station", 1}}),
               text = plc_of(ModbusMode::ascii, {{"station", 1}});
  EXPECT_EQ(ask(*plc, 0s, rtu("01 01 00 00 07 D0")).size(), 255u);
  EXPECT_EQ(ask(*plc, 1s, rtu("01 03 00 00 00 7D")).size(), 255u);
  EXPECT_EQ(ask(*text, 0s, ascii("01 01 00 00 07 D0")).size(), 511u);
}

TEST(ModbusPlc, LongestRequests) {
  const Bytes coils = hex("01 0F 00 00 07 B0 F6") + Bytes(246, 0xFF),
              words = hex("01 10 00 00 00 78 F0") + Bytes(240, 0xFF);
  for (const ModbusMode mode : {ModbusMode::rtu, ModbusMode::ascii}) {
    const Device plc = plc_of(mode, {{"station", 1}});
    const auto written = [&](Time at, const Bytes& content) {
      return ask(*plc, at, encode_modbus_frame(mode, content[0], ByteView(content).subspan(1)));
    };
    EXPECT_EQ(written(0s, coils), test::framed(mode, "01 0F 00 00 07 B0"));
    EXPECT_EQ(written(9s, words), test::framed(mode, "01 10 00 00 00 78"));
    // 2000 bits: 250 bytes of data no longer fit a frame.
    EXPECT_TRUE(written(20s, hex("01 0F 00 00 07 D0 FA") + Bytes(250, 0xFF)).empty());
    EXPECT_EQ(*plc->get("@status", 0), "0B");
  }
}

// --- Silence, and why ---

struct Silence {
  const char* what;
  Bytes frame;
  const char* status;
};

void expect_silence(ModbusMode mode, const std::vector<Silence>& rows) {
  for (const Silence& row : rows) {
    const Device plc = plc_of(mode, {{"station", 1}});
    EXPECT_EQ(to_hex(ask(*plc, 0s, row.frame)), "") << row.what;
    EXPECT_EQ(*plc->get("@status", 0), row.status) << row.what;
    EXPECT_EQ(*plc->get("@errors", 0), "0001") << row.what;
    EXPECT_EQ(*plc->get("%MW0", 0), "0000") << row.what;
    const Bytes good = test::framed(mode, "01 03 00 00 00 01");
    EXPECT_EQ(ask(*plc, 5s, good), test::framed(mode, "01 03 02 00 00")) << "after " << row.what;
    EXPECT_EQ(*plc->get("@status", 0), "00") << row.what;
    EXPECT_EQ(*plc->get("@services", 0), "0001") << row.what;
  }
}

TEST(ModbusPlc, RtuSilence) {
  expect_silence(ModbusMode::rtu, {
                                      {"another station", rtu("02 06 00 00 00 01"), "09"},
                                      {"station 0", rtu("00 06 00 00 00 01"), "09"},
                                      {"wrong CRC", hex("01 06 00 00 00 01 48 0B"), "0C"},
                                      {"CRC high byte first", hex("01 06 00 00 00 01 0A 48"), "0C"},
                                      {"three bytes", hex("01 7E 80"), "0C"},
                                      {"one byte", hex("01"), "0C"},
                                      {"an ASCII frame", ascii("01 06 00 00 00 01"), "0C"},
                                      {"257 bytes", Bytes(257, 1), "0B"},
                                  });
}

TEST(ModbusPlc, AsciiSilence) {
  expect_silence(ModbusMode::ascii,
                 {
                     {"another station", ascii("02 06 00 00 00 01"), "09"},
                     {"station 0", ascii("00 06 00 00 00 01"), "09"},
                     {"wrong LRC", to_bytes(":010600000001F9\r\n"), "0C"},
                     {"odd digits", to_bytes(":010600000001F\r\n"), "0D"},
                     {"no hex digit", to_bytes(":01060000000GF8\r\n"), "0D"},
                     {"no end", to_bytes(":010600000001F8"), "0C"},
                     {"no LF", to_bytes(":010600000001F8\r"), "0C"},
                     {"no CR", to_bytes(":010600000001F8\n"), "0C"},
                     {"no colon", to_bytes("010600000001F8\r\n"), "0C"},
                     {"514 characters", to_bytes(":" + std::string(511, '0') + "\r\n"), "0B"},
                 });
}

TEST(ModbusPlc, StationZeroAnswersWhereItIsItsOwn) {
  const Device plc = plc_of(ModbusMode::rtu, json::object());
  EXPECT_EQ(ask(*plc, 0s, rtu("00 06 00 00 00 01")), rtu("00 06 00 00 00 01"));
  EXPECT_TRUE(ask(*plc, 1s, rtu("01 06 00 00 00 01")).empty());
}

TEST(ModbusPlc, HighestStation) {
  const Device plc = plc_of(ModbusMode::ascii, {{"station", 255}});
  EXPECT_EQ(to_text(ask(*plc, 0s, to_bytes(":FF0600000001FA\r\n"))), ":FF0600000001FA\r\n");
}

TEST(ModbusPlc, ExceptionIsAService) {
  const Device plc = plc_of(ModbusMode::rtu, {{"station", 10}});
  EXPECT_EQ(to_hex(ask(*plc, 0s, rtu("0A 01 FF FF 00 01"))), "0A 81 02 B0 53");
  EXPECT_EQ(*plc->get("@services", 0), "0001");
  EXPECT_EQ(*plc->get("@errors", 0), "0000");
}

// --- Parameters and the back door ---

TEST(ModbusPlc, ServesInStop) {
  const Device plc = plc_of(ModbusMode::rtu, {{"station", 1}, {"mode", "stop"}});
  EXPECT_FALSE(ask(*plc, 0s, rtu("01 03 00 00 00 01")).empty());
  ASSERT_TRUE(plc->act("run"));
  ASSERT_TRUE(plc->act("stop"));
  EXPECT_FALSE(ask(*plc, 1s, rtu("01 06 00 00 00 01")).empty());
  EXPECT_THAT(plc->act("reset").error().message, HasSubstr("use run, stop or power_cycle"));
}

TEST(ModbusPlc, PowerCycleKeepsMemoryAlone) {
  for (const ModbusMode mode : {ModbusMode::rtu, ModbusMode::ascii}) {
    const Device plc = plc_of(mode, {{"station", 1}, {"delay_ms", 1000}, {"rs485", true}});
    ask(*plc, 0s, test::framed(mode, "01 06 00 00 12 34"));
    const Bytes request = test::framed(mode, "01 06 00 01 00 01");
    plc->line()->receive({request, 3s, 1ms});
    plc->line()->receive({request, 4s, 1ms});
    plc->line()->receive({part(request, 0, 3), 5s, 1ms});
    ASSERT_TRUE(plc->act("power_cycle"));
    EXPECT_EQ(plc->line()->wake_at(), std::nullopt);
    EXPECT_EQ(*plc->get("@services", 0), "0000");
    EXPECT_EQ(*plc->get("%MW0", 0), "1234");
    EXPECT_EQ(ask(*plc, 5010ms, request), request);
  }
}

TEST(ModbusPlc, DelayOnlyWithRs485) {
  const auto due = [](ModbusMode mode, const json& config) {
    const Device plc = plc_of(mode, config);
    plc->line()->receive({test::framed(mode, "01 03 00 00 00 01"), 0ms, {}});
    for (std::optional<Time> wake; (wake = plc->line()->wake_at());)
      if (!plc->line()->advance(*wake).empty()) return *wake;
    return Time(-1);
  };
  const json serial{{"station", 1}, {"delay_ms", 50}, {"inter_character_ms", 5}};
  json rs485 = serial;
  rs485["rs485"] = true;
  EXPECT_EQ(due(ModbusMode::rtu, serial), 5ms);
  EXPECT_EQ(due(ModbusMode::rtu, rs485), 55ms);
  EXPECT_EQ(due(ModbusMode::ascii, serial), 0ms);
  EXPECT_EQ(due(ModbusMode::ascii, rs485), 50ms);
}

TEST(ModbusPlc, BasesFromTheConfiguration) {
  const Device plc = plc_of(ModbusMode::rtu, {{"station", 1},
                                              {"bit_read_base", "P0100"},
                                              {"bit_write_base", "K0010"},
                                              {"word_read_base", "P020"},
                                              {"word_write_base", "D100"}});
  ASSERT_TRUE(plc->set("%PX0100", "01"));
  ASSERT_TRUE(plc->set("%PW20", "2020"));
  EXPECT_EQ(ask(*plc, 0s, rtu("01 02 00 00 00 01")), rtu("01 02 01 01"));
  EXPECT_EQ(ask(*plc, 1s, rtu("01 04 00 00 00 01")), rtu("01 04 02 20 20"));
  ask(*plc, 2s, rtu("01 05 00 00 FF 00"));
  ask(*plc, 3s, rtu("01 06 00 00 12 34"));
  EXPECT_EQ(*plc->get("%KX0010", 0), "01");
  EXPECT_EQ(*plc->get("%DW100", 0), "1234");
}

TEST(ModbusPlc, XecDefaults) {
  const Device plc = plc_of(ModbusMode::rtu, {{"station", 1}}, "xec-h");
  ASSERT_TRUE(plc->set("%IW0", "1234"));
  EXPECT_EQ(ask(*plc, 0s, rtu("01 04 00 00 00 01")), rtu("01 04 02 12 34"));
  EXPECT_EQ(ask(*plc, 1s, rtu("01 02 00 00 00 10")), rtu("01 02 02 34 12"));
  ask(*plc, 2s, rtu("01 05 00 11 FF 00"));
  EXPECT_EQ(*plc->get("%MX17", 0), "01");
}

TEST(ModbusPlc, KeysOfOthersArePassedOver) {
  EXPECT_EQ(error_of({{"neighbours", {2}},
                      {"bench_line", "1200"},
                      {"protocol", "modbus-rtu"},
                      {"model", "xbc-h"},
                      {"role", "server"}}),
            "");
}

TEST(ModbusPlc, ErrorsSayWhatIsAllowed) {
  EXPECT_EQ(error_of({{"bit_base", "P0"}}),
            "cannot read the Modbus server's configuration: there is no key 'bit_base'; the keys "
            "are bench_line, bit_read_base, "
            "bit_write_base, delay_ms, inter_character_floor_ms, inter_character_ms, line, mode, "
            "model, neighbours, protocol, "
            "role, rs485, station, word_read_base, word_write_base");
  EXPECT_THAT(error_of({{"station", 256}}), HasSubstr("station is 256"));
  EXPECT_THAT(error_of({{"delay_ms", 15}}), HasSubstr("steps of 10 ms"));
  EXPECT_THAT(error_of({{"word_read_base", 5}}),
              HasSubstr("word_read_base is 5, which is not a text"));
  EXPECT_THAT(error_of({{"word_read_base", "Z5"}}),
              HasSubstr("cannot place word_read_base 'Z5' on xbc-h"));
  EXPECT_THAT(error_of({{"word_read_base", ""}}), HasSubstr("cannot place word_read_base"));
  EXPECT_EQ(error_of({{"role", "client"}, {"p2p", json::array()}}),
            "cannot make a Modbus server of role client; leave role out, or give server");
  EXPECT_THAT(error_of({{"role", "master"}}), HasSubstr("client or server"));
  EXPECT_THAT(error_of(json::array()), HasSubstr("not a JSON object"));
  EXPECT_THAT(error_of(json::object(), "xbc"), HasSubstr("there is no such model"));
}

// --- On the simulated line ---

const std::vector<LineSettings> rtu_lines = {
    {1200, 8, 'N', 1},  {2400, 8, 'E', 1},  {4800, 8, 'O', 2},  {9600, 8, 'N', 1},
    {19200, 8, 'E', 1}, {38400, 8, 'N', 2}, {57600, 8, 'O', 1}, {115200, 8, 'E', 2}};

struct Wire {
  Wire(ModbusMode mode, const LineSettings& line, json config = {{"station", 1}})
      : settings(line), wire(line) {
    config["line"] = line::to_string(line);
    plc = plc_of(mode, config);
    wire.attach(*plc->line(), line);
  }
  Duration gap() const {
    return Duration(Duration::rep{385} * 100'000'000 / settings.baud);
  }  // 3.5 characters of 11 bits
  /// Everything until two seconds of silence.
  Bytes heard() {
    Bytes all;
    for (Bytes more; !(more = wire.receive(wire.now() + 2s).bytes).empty();) all = all + more;
    return all;
  }

  LineSettings settings;
  line::SimulatedLine wire;
  Device plc;
};

TEST(ModbusOnALine, RtuReplyFollowsTheSilence) {
  for (const LineSettings& line : rtu_lines) {
    Wire w(ModbusMode::rtu, line);
    const auto sent = w.wire.transmit(rtu("01 03 00 00 00 01"));
    const Burst reply = w.wire.receive(sent.end + 2s);
    EXPECT_EQ(reply.bytes, rtu("01 03 02 00 00")) << line::to_string(line);
    EXPECT_EQ(reply.start, sent.end + w.gap() + line.character_time()) << line::to_string(line);
  }
}

/// The request in two parts, with a silence between them.
bool answered(Wire& w, const Bytes& request, std::size_t cut, Duration silence) {
  const auto sent = w.wire.transmit(part(request, 0, cut));
  EXPECT_TRUE(w.wire.receive(sent.end + silence).bytes.empty());
  w.wire.transmit(part(request, cut, request.size()));
  return !w.heard().empty();
}

TEST(ModbusOnALine, RtuGapsAtEverySpeed) {
  const Bytes request = rtu("01 03 00 00 00 01");
  for (const LineSettings& line : rtu_lines) {
    const Duration c = line.character_time();
    for (std::size_t cut = 1; cut < request.size(); ++cut) {
      Wire short_gap(ModbusMode::rtu, line), just(ModbusMode::rtu, line),
          equal(ModbusMode::rtu, line), longer(ModbusMode::rtu, line);
      EXPECT_TRUE(answered(short_gap, request, cut, c * 14 / 10))
          << line::to_string(line) << ' ' << cut;
      EXPECT_TRUE(answered(just, request, cut, just.gap() - 1ns))
          << line::to_string(line) << ' ' << cut;
      EXPECT_FALSE(answered(equal, request, cut, equal.gap()))
          << line::to_string(line) << ' ' << cut;
      EXPECT_FALSE(answered(longer, request, cut, c * 45 / 10))
          << line::to_string(line) << ' ' << cut;
      EXPECT_EQ(*longer.plc->get("@errors", 0), "0002");  // two parts that are no frames
    }
  }
}

TEST(ModbusOnALine, InterCharacterParameterAndItsFloor) {
  const Bytes request = rtu("01 03 00 00 00 01");
  const auto with = [&](const json& config, Duration silence) {
    Wire w(ModbusMode::rtu, {}, config);
    return answered(w, request, 4, silence);
  };
  EXPECT_TRUE(with({{"station", 1}, {"inter_character_ms", 10}}, 10ms - 1ns));
  EXPECT_FALSE(with({{"station", 1}, {"inter_character_ms", 10}}, 10ms));
  EXPECT_TRUE(with({{"station", 1}, {"inter_character_ms", 10}, {"inter_character_floor_ms", 20}},
                   20ms - 1ns));
  EXPECT_FALSE(
      with({{"station", 1}, {"inter_character_ms", 10}, {"inter_character_floor_ms", 20}}, 20ms));
}

TEST(ModbusOnALine, TwoRtuRequestsNeedASilence) {
  const Bytes first = rtu("01 06 00 00 00 01"), second = rtu("01 06 00 01 00 02");
  Wire together(ModbusMode::rtu, {});
  together.wire.transmit(first + second);
  EXPECT_TRUE(together.heard().empty());
  Wire apart(ModbusMode::rtu, {});
  const auto sent = apart.wire.transmit(first);
  apart.wire.receive(sent.end + apart.gap());
  apart.wire.transmit(second);
  EXPECT_EQ(apart.heard(), first + second);
}

TEST(ModbusOnALine, RtuStationsShareALine) {
  Wire one(ModbusMode::rtu, {});
  const Device two = plc_of(ModbusMode::rtu, {{"station", 2}});
  one.wire.attach(*two->line(), {});
  one.wire.transmit(rtu("02 06 00 00 00 01"));
  EXPECT_EQ(one.heard(), rtu("02 06 00 00 00 01"));  // which station 1 hears, too
  one.wire.transmit(rtu("01 06 00 00 00 02"));
  EXPECT_EQ(one.heard(), rtu("01 06 00 00 00 02"));
  EXPECT_EQ(*one.plc->get("%MW0", 0), "0002");
  EXPECT_EQ(*two->get("%MW0", 0), "0001");
}

TEST(ModbusOnALine, AsciiRepliesAtOnceWith7And8DataBits) {
  for (const LineSettings& line : {LineSettings{9600, 7, 'E', 1}, LineSettings{1200, 7, 'N', 2},
                                   LineSettings{115200, 8, 'N', 1}}) {
    Wire w(ModbusMode::ascii, line);
    const auto sent = w.wire.transmit(to_bytes(":010600000001F8\r\n"));
    const Burst reply = w.wire.receive(sent.end + 2s);
    EXPECT_EQ(to_text(reply.bytes), ":010600000001F8\r\n") << line::to_string(line);
    EXPECT_EQ(reply.start, sent.end) << line::to_string(line);
  }
}

TEST(ModbusOnALine, AsciiSecondBetweenCharacters) {
  const Bytes request = ascii("01 03 00 00 00 01");
  for (std::size_t cut = 1; cut < request.size(); ++cut) {
    Wire in_time(ModbusMode::ascii, {9600, 7, 'E', 1}), late(ModbusMode::ascii, {9600, 7, 'E', 1});
    EXPECT_TRUE(answered(in_time, request, cut, 1s)) << cut;
    EXPECT_FALSE(answered(late, request, cut, 1s + 1ns)) << cut;
  }
}

TEST(ModbusOnALine, AsciiRequestsBackToBack) {
  Wire w(ModbusMode::ascii, {});
  const Bytes first = ascii("01 06 00 00 00 01"), second = ascii("01 06 00 01 00 02");
  w.wire.transmit(first + second);
  EXPECT_EQ(w.heard(), first + second);
}

}  // namespace
}  // namespace fieldproof::modbus
