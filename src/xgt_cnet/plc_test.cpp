#include "src/xgt_cnet/plc.hpp"

#include <gmock/gmock.h>

#include "src/line/line.hpp"
#include "src/xgt_cnet/test_frames.hpp"

namespace fieldproof {
namespace {

using test::ack;
using test::enq;
using test::shown;
using ::testing::HasSubstr;

std::unique_ptr<Plc> plc_of(const PlcConfig& config) {
  Result<std::unique_ptr<Plc>> plc = make_plc(config);
  EXPECT_TRUE(plc) << (plc ? "" : plc.error().message);
  return plc ? std::move(*plc) : nullptr;
}

std::string error_of(const PlcConfig& config) {
  const Result<std::unique_ptr<Plc>> plc = make_plc(config);
  return plc ? "" : plc.error().message;
}

PlcConfig client_config() {
  return {{.station = 0, .role = PlcConfig::Role::client}, 1, {{"%MX00000", "%MW100", "%MW200", 2, 1}}};
}

/// A request at `start` and what is answered at the moment the PLC asks for.
std::string ask(Plc& plc, Time start, std::string_view body, Duration character = 1ms) {
  plc.receive({enq(body), start, character});
  const auto wake = plc.wake_at();
  return wake ? shown(plc.advance(*wake)) : "";
}

TEST(Plc, ServesItsMemory) {
  const auto plc = plc_of({{.model = "xbc-h", .station = 1}});
  ASSERT_TRUE(plc->set("%MW100", "123456789ABC"));
  EXPECT_EQ(ask(*plc, 0ms, "01rSB06%MW10003"), "ACK 01rSB0106123456789ABC");
  EXPECT_EQ(ask(*plc, 1s, "01wSS0108%MX0010A01"), "ACK 01wSS");
  EXPECT_EQ(*plc->get("%MW10", 0), "0400");
  EXPECT_EQ(*plc->get("%MW100", 12), "123456789ABC");
}

TEST(Plc, ServesInStop) {
  const auto plc = plc_of({{.station = 1, .run = false}});
  EXPECT_EQ(ask(*plc, 0ms, "01RSS0104%MW0"), "ACK 01RSS01020000");
  ASSERT_TRUE(plc->act("stop"));
  EXPECT_EQ(ask(*plc, 1s, "01RSS0104%MW0"), "ACK 01RSS01020000");
}

TEST(Plc, Counters) {
  const auto plc = plc_of({{.station = 1}});
  ask(*plc, 0ms, "01RSS0104%MW0");
  ask(*plc, 1s, "02RSS0104%MW0");
  EXPECT_EQ(*plc->get("@status", 0), "09");
  EXPECT_EQ(*plc->get("@status", 4), "0009");
  EXPECT_EQ(*plc->get("@errors", 0), "0001");
  EXPECT_EQ(*plc->get("@services", 2), "01");
  EXPECT_THAT(plc->get("@error", 0).error().message, HasSubstr("did you mean '@errors'"));
}

TEST(Plc, CountersTakeTheDigitsTheyNeed) {
  const auto plc = plc_of({{.station = 1}});
  for (int i = 0; i < 256; ++i) ask(*plc, i * 1s, "01RSS0104%MW0");
  EXPECT_EQ(*plc->get("@services", 2), "100");
  EXPECT_EQ(*plc->get("@services", 0), "0100");
}

TEST(Plc, PowerCycleKeepsMemoryAlone) {
  const auto plc = plc_of({{.station = 1}});
  ASSERT_TRUE(plc->set("%MW0", "1234"));
  EXPECT_EQ(ask(*plc, 0ms, "01X00RSS0104%MW0"), "ACK 01X00");
  plc->receive({to_bytes("\x05" "01"), 1s, 1ms});
  ASSERT_TRUE(plc->act("power_cycle"));
  EXPECT_EQ(plc->wake_at(), std::nullopt);
  EXPECT_EQ(*plc->get("@services", 0), "0000");
  EXPECT_EQ(ask(*plc, 2s, "01Y00"), "NAK 01Y000090");
  EXPECT_EQ(ask(*plc, 3s, "01RSS0104%MW0"), "ACK 01RSS01021234");
  EXPECT_THAT(plc->act("reset").error().message, HasSubstr("use run, stop or power_cycle"));
}

TEST(Plc, DelayOnlyWithRs485) {
  const Bytes request = enq("01RSS0104%MW0");
  const auto due = [&request](bool rs485) {
    const auto plc = plc_of({{.station = 1, .delay = 50ms, .rs485 = rs485}});
    plc->receive({request, 0ms, 0ms});
    return plc->wake_at();
  };
  EXPECT_EQ(due(true), 50ms);
  EXPECT_EQ(due(false), 0ms);
}

TEST(Plc, InterCharacterTimeAndItsFloor) {
  const auto answers = [](const PlcConfig& config, Duration silence) {
    const auto plc = plc_of(config);
    plc->receive({to_bytes("\x05" "01RSS"), 0ms, 1ms});
    plc->receive({to_bytes("0104%MW0\x04"), 6ms + silence, 1ms});
    const auto wake = plc->wake_at();
    return wake && !plc->advance(*wake).empty();
  };
  EXPECT_TRUE(answers({{.station = 1}}, Duration(4'010'416)));  // 38.5 bits at 9600 bit/s
  EXPECT_FALSE(answers({{.station = 1}}, Duration(4'010'417)));
  EXPECT_TRUE(answers({{.station = 1, .inter_character = 10ms}}, 10ms));
  EXPECT_FALSE(answers({{.station = 1, .inter_character = 10ms}}, 10ms + 1ns));
  EXPECT_TRUE(answers({{.station = 1, .inter_character = 10ms, .inter_character_floor = 20ms}}, 20ms));
  EXPECT_FALSE(answers({{.station = 1, .inter_character = 10ms, .inter_character_floor = 20ms}}, 20ms + 1ns));
}

TEST(Plc, ClientAsksWhenTheBackDoorRaisesItsFlag) {
  const auto plc = plc_of(client_config());
  EXPECT_EQ(plc->wake_at(), std::nullopt);
  ASSERT_TRUE(plc->set("%MX00000", "01"));
  ASSERT_TRUE(plc->wake_at());
  EXPECT_EQ(plc->advance(5s), enq("02rSS0106%MW100"));
  plc->receive({ack("02rSS01021234"), 5s + 50ms, 1ms});
  EXPECT_EQ(*plc->get("%MW200", 0), "1234");
  EXPECT_EQ(*plc->get("%LX5120", 0), "01");
  EXPECT_EQ(*plc->get("@services", 0), "0001");
}

TEST(Plc, ClientTimesOut) {
  PlcConfig config = client_config();
  config.time_out = 3;
  const auto plc = plc_of(config);
  ASSERT_TRUE(plc->set("%MX00000", "01"));
  const Bytes request = plc->advance(0s);
  const Duration sent = config.line.character_time() * static_cast<int>(request.size());
  EXPECT_EQ(plc->wake_at(), sent + 400ms);
  EXPECT_TRUE(plc->advance(sent + 400ms).empty());
  EXPECT_EQ(*plc->get("%LX5121", 0), "01");
  EXPECT_EQ(*plc->get("%LW513", 0), "000A");
}

TEST(Plc, ClientObeysRunAndStop) {
  const auto plc = plc_of(client_config());
  ASSERT_TRUE(plc->act("stop"));
  ASSERT_TRUE(plc->set("%MX00000", "01"));
  EXPECT_EQ(plc->wake_at(), std::nullopt);
  ASSERT_TRUE(plc->act("run"));
  ASSERT_TRUE(plc->set("%MX00000", "00"));
  ASSERT_TRUE(plc->set("%MX00000", "01"));
  EXPECT_EQ(plc->advance(1s), enq("02rSS0106%MW100"));
}

// --- On the simulated line ---

TEST(PlcOnALine, OnlyTheAddressedStationAnswersAndAtOnce) {
  const LineSettings line;
  const auto one = plc_of({{.station = 1}}), two = plc_of({{.station = 2}});
  SimulatedLine wire(line);
  wire.attach(*one, line);
  wire.attach(*two, line);
  ASSERT_TRUE(two->set("%MW0", "2222"));
  const auto sent = wire.transmit(enq("02rSS0104%MW0"));
  const Burst reply = wire.receive(sent.end + 1s);
  EXPECT_EQ(shown(reply.bytes), "ACK 02rSS01022222");
  EXPECT_EQ(reply.start, sent.end);
  EXPECT_TRUE(wire.receive(wire.now() + 1s).bytes.empty());
}

/// Two parts of a request with a silence between them, at both sides of the inter-character time.
TEST(PlcOnALine, GapsAreJudgedToTheNanosecond) {
  const LineSettings line;
  const Bytes request = enq("01RSS0104%MW0");
  for (const Duration longer : {Duration(0), Duration(1)}) {
    for (std::size_t cut = 1; cut < request.size(); ++cut) {
      const auto plc = plc_of({{.station = 1, .line = line, .inter_character = 10ms}});
      SimulatedLine wire(line);
      wire.attach(*plc, line);
      const auto at = request.begin() + static_cast<std::ptrdiff_t>(cut);
      const auto sent = wire.transmit(Bytes(request.begin(), at));
      ASSERT_TRUE(wire.receive(sent.end + 10ms + longer).bytes.empty());
      wire.transmit(Bytes(at, request.end()));
      EXPECT_EQ(!wire.receive(wire.now() + 1s).bytes.empty(), longer == Duration(0)) << cut;
      EXPECT_EQ(*plc->get("@services", 0), longer == Duration(0) ? "0001" : "0000") << cut;
    }
  }
}

TEST(PlcOnALine, MissingTailIsCountedBySilenceAlone) {
  const LineSettings line;
  const auto plc = plc_of({{.station = 1}});
  SimulatedLine wire(line);
  wire.attach(*plc, line);
  wire.transmit(to_bytes("\x05" "01RSS0104%MW0"));
  EXPECT_TRUE(wire.receive(wire.now() + 1s).bytes.empty());
  EXPECT_EQ(*plc->get("@status", 0), "02");
}

TEST(PlcOnALine, ServerAndClientTalkToEachOther) {
  const LineSettings line{.baud = 38400, .data_bits = 7, .parity = 'E'};
  PlcConfig asking = client_config();
  asking.line = line;
  const auto client = plc_of(asking), server = plc_of({{.model = "xbm-s", .station = 2, .line = line}});
  SimulatedLine wire(line);
  wire.attach(*client, line);
  wire.attach(*server, line);
  ASSERT_TRUE(server->set("%MW100", "CAFE"));
  ASSERT_TRUE(client->set("%MX00000", "01"));
  for (int i = 0; i < 4; ++i) wire.receive(wire.now() + 100ms);
  EXPECT_EQ(*client->get("%MW200", 0), "CAFE");
  EXPECT_EQ(*client->get("%LD257", 0), "00000001");
}

// --- Configurations that make no PLC ---

TEST(MakePlc, ErrorsNameTheParameter) {
  EXPECT_EQ(error_of({{.model = "xbc_h"}}),
            "cannot make a PLC 'xbc_h': there is no such model; use one of xbc-h, xbm-s, xec-h; did you mean 'xbc-h'?");
  EXPECT_THAT(error_of({{.station = 256}}), HasSubstr("station is not 0 to 255"));
  EXPECT_THAT(error_of({{.delay = 15ms}}), HasSubstr("steps of 10 ms"));
  EXPECT_THAT(error_of({{.delay = 2560ms}}), HasSubstr("0 to 2550 ms"));
  EXPECT_THAT(error_of({{.inter_character = -1ms}}), HasSubstr("inter-character time"));
  EXPECT_THAT(error_of({{}, 51}), HasSubstr("time_out"));
  EXPECT_THAT(error_of({{.role = PlcConfig::Role::client}}), HasSubstr("no p2p blocks"));
  EXPECT_THAT(error_of({{}, 1, {{"%MX0", "%MW0", "%MW1", 2, 1}}}), HasSubstr("give role client"));
}

TEST(MakePlc, ErrorsNameTheP2pBlock) {
  const auto error = [](const P2pConfig& block) {
    PlcConfig config = client_config();
    config.p2p.push_back(block);
    return error_of(config);
  };
  EXPECT_EQ(error({"%MW0", "%MW0", "%MW1", 2, 1}), "cannot set up p2p block 1: flag '%MW0' is no bit; name one such as %MX00000");
  EXPECT_THAT(error({"%ZX0", "%MW0", "%MW1", 2, 1}), HasSubstr("flag '%ZX0' is wrong on xbc-h: the model has no such area"));
  EXPECT_THAT(error({"%MX0", "MW0", "%MW1", 2, 1}), HasSubstr("read 'MW0' is no device name"));
  EXPECT_THAT(error({"%MX0", "%MD0", "%MW1", 2, 1}), HasSubstr("different types"));
  EXPECT_THAT(error({"%MX0", "%MW0", "%MW1024", 2, 1}), HasSubstr("save '%MW1024' is wrong"));
  EXPECT_THAT(error({"%MX0", "%MW0", "%MW1023", 2, 2}), HasSubstr("the save area ends"));
  EXPECT_THAT(error({"%MX0", "%MW0", "%MW1", 256, 1}), HasSubstr("station"));
  EXPECT_THAT(error({"%MX0", "%MW0", "%MW1", 2, 0}), HasSubstr("count"));
  EXPECT_THAT(error({"%MX0", "%MW0", "%MW1", 2, 61}), HasSubstr("count"));
  EXPECT_THAT(error({"%MX0", "%MX0", "%MX1", 2, 2}), HasSubstr("one block a bit"));
  EXPECT_EQ(error({"%MX0", "%MW0", "%MW1", 2, 60}), "");
}

}  // namespace
}  // namespace fieldproof
