#include "src/xgt_cnet/plc.hpp"

#include <gmock/gmock.h>

#include "src/line/line.hpp"
#include "src/xgt_cnet/test_frames.hpp"

namespace fieldproof::xgt_cnet {
namespace {

using test::ack;
using test::enq;
using test::shown;
using ::testing::HasSubstr;

std::unique_ptr<plc::Plc> plc_of(const plc::PortConfig& config) {
  Result<std::unique_ptr<plc::Plc>> plc = make_plc(config);
  EXPECT_TRUE(plc) << (plc ? "" : plc.error().message);
  return plc ? std::move(*plc) : nullptr;
}

std::string error_of_plc(const plc::PortConfig& config) {
  const Result<std::unique_ptr<plc::Plc>> plc = make_plc(config);
  return plc ? "" : plc.error().message;
}

/// A request at `start` and what is answered at the moment the PLC asks for.
std::string ask(plc::Plc& plc, Time start, std::string_view body, Duration character = 1ms) {
  plc.line()->receive({enq(body), start, character});
  const auto wake = plc.line()->wake_at();
  return wake ? shown(plc.line()->advance(*wake)) : "";
}

TEST(Plc, ServesItsMemory) {
  const auto plc = plc_of({.model = "xbc-h", .station = 1});
  ASSERT_TRUE(plc->set("%MW100", "123456789ABC"));
  EXPECT_EQ(ask(*plc, 0ms, "01rSB06%MW10003"), "ACK 01rSB0106123456789ABC");
  EXPECT_EQ(ask(*plc, 1s, "01wSS0108%MX0010A01"), "ACK 01wSS");
  EXPECT_EQ(*plc->get("%MW10", 0), "0400");
  EXPECT_EQ(*plc->get("%MW100", 12), "123456789ABC");
}

TEST(Plc, ServesInStop) {
  const auto plc = plc_of({.station = 1, .run = false});
  EXPECT_EQ(ask(*plc, 0ms, "01RSS0104%MW0"), "ACK 01RSS01020000");
  ASSERT_TRUE(plc->act("stop"));
  EXPECT_EQ(ask(*plc, 1s, "01RSS0104%MW0"), "ACK 01RSS01020000");
}

TEST(Plc, Counters) {
  const auto plc = plc_of({.station = 1});
  ask(*plc, 0ms, "01RSS0104%MW0");
  ask(*plc, 1s, "02RSS0104%MW0");
  EXPECT_EQ(*plc->get("@status", 0), "09");
  EXPECT_EQ(*plc->get("@status", 4), "0009");
  EXPECT_EQ(*plc->get("@errors", 0), "0001");
  EXPECT_EQ(*plc->get("@services", 2), "01");
  EXPECT_THAT(plc->get("@error", 0).error().message, HasSubstr("did you mean '@errors'"));
}

TEST(Plc, CountersTakeTheDigitsTheyNeed) {
  const auto plc = plc_of({.station = 1});
  for (int i = 0; i < 256; ++i) ask(*plc, i * 1s, "01RSS0104%MW0");
  EXPECT_EQ(*plc->get("@services", 2), "100");
  EXPECT_EQ(*plc->get("@services", 0), "0100");
}

TEST(Plc, PowerCycleKeepsMemoryAlone) {
  const auto plc = plc_of({.station = 1});
  ASSERT_TRUE(plc->set("%MW0", "1234"));
  EXPECT_EQ(ask(*plc, 0ms, "01X00RSS0104%MW0"), "ACK 01X00");
  plc->line()->receive({to_bytes("\x05"
                                 "01"),
                        1s, 1ms});
  ASSERT_TRUE(plc->act("power_cycle"));
  EXPECT_EQ(plc->line()->wake_at(), std::nullopt);
  EXPECT_EQ(*plc->get("@services", 0), "0000");
  EXPECT_EQ(ask(*plc, 2s, "01Y00"), "NAK 01Y000090");
  EXPECT_EQ(ask(*plc, 3s, "01RSS0104%MW0"), "ACK 01RSS01021234");
  EXPECT_THAT(plc->act("reset").error().message, HasSubstr("use run, stop or power_cycle"));
}

TEST(Plc, DelayOnlyWithRs485) {
  const Bytes request = enq("01RSS0104%MW0");
  const auto due = [&request](bool rs485) {
    const auto plc = plc_of({.station = 1, .delay = 50ms, .rs485 = rs485});
    plc->line()->receive({request, 0ms, 0ms});
    return plc->line()->wake_at();
  };
  EXPECT_EQ(due(true), 50ms);
  EXPECT_EQ(due(false), 0ms);
}

TEST(Plc, InterCharacterTimeAndItsFloor) {
  const auto answers = [](const plc::PortConfig& config, Duration silence) {
    const auto plc = plc_of(config);
    plc->line()->receive({to_bytes("\x05"
                                   "01RSS"),
                          0ms, 1ms});
    plc->line()->receive({to_bytes("0104%MW0\x04"), 6ms + silence, 1ms});
    const auto wake = plc->line()->wake_at();
    return wake && !plc->line()->advance(*wake).empty();
  };
  EXPECT_TRUE(answers({.station = 1}, Duration(4'010'416)));  // 38.5 bits at 9600 bit/s
  EXPECT_FALSE(answers({.station = 1}, Duration(4'010'417)));
  EXPECT_TRUE(answers({.station = 1, .inter_character = 10ms}, 10ms));
  EXPECT_FALSE(answers({.station = 1, .inter_character = 10ms}, 10ms + 1ns));
  EXPECT_TRUE(
      answers({.station = 1, .inter_character = 10ms, .inter_character_floor = 20ms}, 20ms));
  EXPECT_FALSE(
      answers({.station = 1, .inter_character = 10ms, .inter_character_floor = 20ms}, 20ms + 1ns));
}

// --- On the simulated line ---

TEST(PlcOnALine, OnlyTheAddressedStationAnswersAndAtOnce) {
  const line::LineSettings line;
  const auto one = plc_of({.station = 1}), two = plc_of({.station = 2});
  line::SimulatedLine wire(line);
  wire.attach(*one->line(), line);
  wire.attach(*two->line(), line);
  ASSERT_TRUE(two->set("%MW0", "2222"));
  const auto sent = wire.transmit(enq("02rSS0104%MW0"));
  const Burst reply = wire.receive(sent.end + 1s);
  EXPECT_EQ(shown(reply.bytes), "ACK 02rSS01022222");
  EXPECT_EQ(reply.start, sent.end);
  EXPECT_TRUE(wire.receive(wire.now() + 1s).bytes.empty());
}

/// Two parts of a request with a silence between them, at both sides of the inter-character time.
TEST(PlcOnALine, GapsAreJudgedToTheNanosecond) {
  const line::LineSettings line;
  const Bytes request = enq("01RSS0104%MW0");
  for (const Duration longer : {Duration(0), Duration(1)}) {
    for (std::size_t cut = 1; cut < request.size(); ++cut) {
      const auto plc = plc_of({.station = 1, .line = line, .inter_character = 10ms});
      line::SimulatedLine wire(line);
      wire.attach(*plc->line(), line);
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
  const line::LineSettings line;
  const auto plc = plc_of({.station = 1});
  line::SimulatedLine wire(line);
  wire.attach(*plc->line(), line);
  wire.transmit(
      to_bytes("\x05"
               "01RSS0104%MW0"));
  EXPECT_TRUE(wire.receive(wire.now() + 1s).bytes.empty());
  EXPECT_EQ(*plc->get("@status", 0), "02");
}

// --- Configurations that make no PLC ---

TEST(MakePlc, ErrorsNameTheParameter) {
  EXPECT_EQ(error_of_plc({.model = "xbc_h"}),
            "cannot make a PLC 'xbc_h': there is no such model; use one of xbc-h, xbm-s, xec-h; "
            "did you mean 'xbc-h'?");
  EXPECT_THAT(error_of_plc({.station = 256}), HasSubstr("station is not 0 to 255"));
  EXPECT_THAT(error_of_plc({.delay = 15ms}), HasSubstr("steps of 10 ms"));
  EXPECT_THAT(error_of_plc({.delay = 2560ms}), HasSubstr("0 to 2550 ms"));
  EXPECT_THAT(error_of_plc({.inter_character = -1ms}), HasSubstr("inter-character time"));
}

}  // namespace
}  // namespace fieldproof::xgt_cnet
