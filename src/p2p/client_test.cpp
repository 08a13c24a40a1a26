#include "src/p2p/client.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "src/p2p/test_driver.hpp"

namespace fieldproof::p2p {
namespace {

constexpr Duration character = 1ms, time_out = 200ms;

/// A client on P2P 1, channel 1, whose blocks are given as JSON, and its partner.
struct Bench {
  explicit Bench(const std::string& blocks, Duration delay = {}) {
    const auto json = nlohmann::json::parse(R"({"blocks": [)" + blocks + "]}");
    const Result<P2pParameters> parameters = parse_p2p_parameters(json, memory.model());
    EXPECT_TRUE(parameters) << (parameters ? "" : parameters.error().message);
    client = std::make_unique<P2pClient>(
        memory, *parameters, 1, std::make_unique<test::TestDriver>(),
        P2pClient::Timing{time_out, delay, character}, [this] { client->scan(); });
    client->set_active(true);
  }

  void set(std::string_view name, std::string_view hex) {
    const Status status = plc::set_by_name(memory, name, hex);
    ASSERT_TRUE(status) << status.error().message;
    client->scan();
  }
  void pulse(std::string_view name) {
    set(name, "00");
    set(name, "01");
  }
  std::string get(std::string_view name) { return *plc::get_by_name(memory, name, 0); }

  /// Time passes until the client sends; "" when it does not until `until`. Then `now` is when it
  /// began.
  std::string sent(Time until) {
    for (;;) {
      const auto wake = client->wake_at();
      if (!wake || *wake > until) {
        now = std::max(now, until);
        return "";
      }
      now = std::max(now, *wake);
      if (const Bytes bytes = client->advance(now); !bytes.empty()) return to_text(bytes);
    }
  }
  std::string sent() { return sent(now); }
  void reply(const std::string& text, Duration after = 50ms) {
    EXPECT_EQ(sent(now + after), "");
    const Burst burst{to_bytes(text), now, character};
    client->receive(burst);
    now = burst.end();
  }
  /// "NDR ERR STATUS services errors" of a block.
  std::string result(unsigned block) {
    const P2pResultFlags flags = p2p_result_flags(memory.model(), 1, block);
    std::string text;
    for (const plc::DeviceAddress& address :
         {flags.ndr, flags.err, flags.status, flags.services, flags.errors})
      text += hex_number(memory.read(address), address.type == 'X' ? 1 : 2) + ' ';
    text.pop_back();
    return text;
  }

  plc::PlcMemory memory{*plc::find_plc_model("xbc-h")};
  std::unique_ptr<P2pClient> client;
  Time now{};
};

std::string block(const std::string& flag, const std::string& more = "") {
  return R"({"flag": ")" + flag + R"(", "read": "%MW0", "save": "%DW1")" + more + "}";
}

TEST(P2pClient, AsksOnTheRisingEdge) {
  Bench b(block("%MX0"));
  EXPECT_EQ(b.client->wake_at(), std::nullopt);
  b.set("%MX0", "01");
  EXPECT_EQ(b.sent(), "ask 0");
  b.reply("ok");
  EXPECT_EQ(b.get("%DW1"), "0001");
  EXPECT_EQ(b.result(0), "1 0 00 01 00");
  b.set("%MX0", "01");  // still on
  EXPECT_EQ(b.sent(10s), "");
  b.set("%MX0", "00");
  EXPECT_EQ(b.sent(20s), "");
  b.set("%MX0", "01");
  EXPECT_EQ(b.sent(), "ask 0");
  EXPECT_EQ(b.client->counters().services, 1u);
}

TEST(P2pClient, EdgesOfABusyOrWantedBlockAreLost) {
  Bench b(block("%MX0") + "," + block("%MX1"));
  b.pulse("%MX0");
  b.pulse("%MX1");
  EXPECT_EQ(b.sent(), "ask 0");
  b.pulse("%MX0");  // under way
  b.pulse("%MX1");  // wanted
  b.reply("ok");
  EXPECT_EQ(b.sent(), "ask 1");
  b.reply("ok");
  EXPECT_EQ(b.sent(10s), "");
  EXPECT_EQ(b.result(0), "1 0 00 01 00");
  EXPECT_EQ(b.result(1), "1 0 00 01 00");
}

TEST(P2pClient, RoundsInBlockOrder) {
  Bench b(block("%MX0") + "," + block("%MX1") + "," + block("%MX2"));
  b.pulse("%MX2");
  b.pulse("%MX1");
  EXPECT_EQ(b.sent(), "ask 1");  // by number, not by age
  b.pulse("%MX0");               // for the next round, so that block 2 comes to its turn
  b.reply("ok");
  EXPECT_EQ(b.sent(), "ask 2");
  b.pulse("%MX1");
  b.reply("ok");
  EXPECT_EQ(b.sent(), "ask 0");
  b.reply("ok");
  EXPECT_EQ(b.sent(), "ask 1");
}

TEST(P2pClient, ClocksRiseAfterEachWholePeriod) {
  for (const auto& [flag, period] : {std::pair{"F90", 20ms}, {"F92", 200ms}, {"F93", 1000ms}}) {
    Bench b(block(flag));
    for (int i = 1; i <= 3; ++i) {
      EXPECT_EQ(b.sent(i * period), "ask 0");
      EXPECT_EQ(b.now, i * period) << flag;
      b.reply("ok", 1ms);
    }
  }
}

TEST(P2pClient, ClocksCountFromPowerOn) {
  Bench b(block("F92"));
  EXPECT_EQ(b.client->advance(30ms), Bytes{});  // switched on
  EXPECT_EQ(b.client->wake_at(), 230ms);
  b.client->power_cycle();
  b.client->advance(300ms);
  EXPECT_EQ(b.client->wake_at(), 500ms);
}

TEST(P2pClient, ALateLookDoesNotMoveTheClock) {
  Bench b(block("F90"));
  b.client->advance(0ms);
  EXPECT_EQ(to_text(b.client->advance(65ms)), "ask 0");  // for 20, 40 and 60 ms
  b.now = 65ms;
  b.reply("ok", 1ms);
  EXPECT_EQ(b.sent(1s), "ask 0");
  EXPECT_EQ(b.now, 80ms);
}

TEST(P2pClient, EdgesOfAClockAreLostWhileBusy) {
  Bench b(block("F90"));
  EXPECT_EQ(b.sent(20ms), "ask 0");
  b.reply("ok", 30ms);  // ends at 52 ms
  EXPECT_EQ(b.sent(1s), "ask 0");
  EXPECT_EQ(b.now, 60ms);
}

TEST(P2pClient, TimesOutAfterTheLastByteSent) {
  Bench b(block("%MX0"));
  b.set("%MX0", "01");
  EXPECT_EQ(b.sent(), "ask 0");
  const Time deadline = 5 * character + time_out;
  EXPECT_EQ(b.client->wake_at(), deadline);
  b.client->advance(deadline - 1ns);
  EXPECT_EQ(b.result(0), "0 0 00 00 00");
  b.client->advance(deadline);
  EXPECT_EQ(b.result(0), "0 1 0A 00 01");
  EXPECT_EQ(b.client->counters().status, 5u);  // Cnet EN 11.1.4
  EXPECT_EQ(b.client->counters().errors, 1u);
  b.now = deadline;
  b.reply("ok");  // too late
  EXPECT_EQ(b.get("%DW1"), "0000");
  EXPECT_EQ(b.result(0), "0 1 0A 00 01");
  EXPECT_EQ(b.sent(10s), "");  // no retry
}

TEST(P2pClient, TheLastResultHolds) {
  Bench b(block("%MX0"));
  b.pulse("%MX0");
  b.sent();
  b.reply("error 0F");
  EXPECT_EQ(b.result(0), "0 1 0F 00 01");
  EXPECT_EQ(b.get("%DW1"), "0000");
  b.pulse("%MX0");
  b.sent();
  b.reply("ok");
  EXPECT_EQ(b.result(0), "1 0 00 01 01");
  b.pulse("%MX0");
  b.sent();
  b.reply("error 04");
  EXPECT_EQ(b.result(0), "0 1 04 01 02");
  EXPECT_EQ(b.client->counters().status, 4u);
}

TEST(P2pClient, CountsAreDwordsThatWrap) {
  Bench b(block("%MX0"));
  b.set("%LD257", "FFFFFFFF");
  b.set("%LD258", "0000FFFF");
  b.pulse("%MX0");
  b.sent();
  b.reply("ok");
  EXPECT_EQ(b.get("%LD257"), "00000000");
  b.pulse("%MX0");
  b.sent();
  b.reply("error 0F");
  EXPECT_EQ(b.get("%LD258"), "00010000");
}

TEST(P2pClient, BrokenFrames) {
  const auto status_of = [](const std::string& broken) {
    Bench b(block("%MX0"));
    b.pulse("%MX0");
    b.sent();
    b.reply(broken);
    if (b.result(0) == "0 0 00 00 00") b.sent(10s);
    return b.result(0);
  };
  EXPECT_EQ(status_of("broken 02"), "0 1 02 00 01");
  EXPECT_EQ(status_of("broken 03"), "0 1 03 00 01");
  EXPECT_EQ(status_of("broken 0B"), "0 1 0B 00 01");
  EXPECT_EQ(status_of("broken 0C"), "0 1 03 00 01");  // a wrong CRC or LRC
  EXPECT_EQ(status_of("broken 0D"), "0 1 0D 00 01");
  EXPECT_EQ(status_of("broken 01"), "0 1 01 00 01");  // at the time-out
  EXPECT_EQ(status_of("of another block"), "0 1 0A 00 01");
}

TEST(P2pClient, NoiseBeforeTheReplyIsPassedOver) {
  Bench b(block("%MX0"));
  b.pulse("%MX0");
  b.sent();
  b.reply("broken 01");
  b.reply("ok");
  EXPECT_EQ(b.result(0), "1 0 00 01 00");
  b.pulse("%MX0");
  b.sent();
  b.sent(10s);  // silence
  EXPECT_EQ(b.result(0), "0 1 0A 01 01");
}

TEST(P2pClient, WhatCannotBeSent) {
  Bench b(block("%MX0", R"(, "station": 255)") + "," + block("%MX0"));
  b.pulse("%MX0");
  EXPECT_EQ(b.sent(), "ask 1");
  EXPECT_EQ(b.result(0), "0 1 07 00 01");
  EXPECT_EQ(b.client->counters().status, 0xFFFEu);
}

TEST(P2pClient, SilentUnlessActive) {
  Bench b(block("%MX0") + "," + block("F92"));
  b.client->set_active(false);
  b.set("%MX0", "01");
  EXPECT_EQ(b.sent(1s), "");
  b.client->set_active(true);
  EXPECT_EQ(b.sent(1100ms), "");  // both rose before
  EXPECT_EQ(b.sent(1200ms), "ask 1");
  b.client->set_active(false);  // given up
  b.reply("ok");
  EXPECT_EQ(b.result(1), "0 0 00 00 00");
  EXPECT_EQ(b.sent(10s), "");
}

TEST(P2pClient, PowerCycleForgetsTheTransaction) {
  Bench b(block("%MX0"));
  b.pulse("%MX0");
  b.sent();
  b.client->power_cycle();
  EXPECT_EQ(b.client->wake_at(), std::nullopt);
  b.reply("ok");
  EXPECT_EQ(b.result(0), "0 0 00 00 00");
  EXPECT_EQ(b.client->counters().services, 0u);
  b.set("%MX0", "01");  // on all the time
  EXPECT_EQ(b.sent(), "");
}

TEST(P2pClient, SavedValuesAndResultsMayBeFlags) {
  Bench b(R"({"flag": "%MX0", "type": "bit", "read": "%MX5", "save": "%MX1"})" +
          ("," + block("%MX1")) + "," + block("%LX5180"));
  b.pulse("%MX0");
  EXPECT_EQ(b.sent(), "ask 0");
  b.reply("ok");
  EXPECT_EQ(b.sent(), "ask 1");
  b.reply("ok");
  EXPECT_EQ(b.sent(), "ask 2");  // NDR of block 1
}

TEST(P2pClient, DelayIsSilenceBeforeARequest) {
  Bench b(block("%MX0") + "," + block("%MX0"), 30ms);
  b.now = 1s;
  b.client->advance(b.now);
  b.pulse("%MX0");
  EXPECT_EQ(b.sent(), "ask 0");  // the line has been silent for long
  b.reply("ok");
  const Time end = b.now;
  EXPECT_EQ(b.sent(end + 29ms), "");
  EXPECT_EQ(b.sent(end + 1s), "ask 1");
  EXPECT_EQ(b.now, end + 30ms);
}

TEST(P2pClient, AUserFrameIsDoneWhenItIsSent) {
  Bench b(
      R"({"function": "send", "flag": "%MX0", "frame": "A.B"}, {"function": "send", "flag": "%MX0", "frame": "A.C"})");
  b.pulse("%MX0");
  EXPECT_EQ(b.sent(), "send A.B");
  EXPECT_EQ(b.result(0), "0 0 00 00 00");
  EXPECT_EQ(b.sent(1s), "send A.C");
  EXPECT_EQ(b.now, 8 * character);  // "send A.B" is out
  EXPECT_EQ(b.result(0), "1 0 00 01 00");
}

TEST(P2pClient, ReceiveIsAlwaysArmed) {
  Bench b(
      R"({"function": "receive", "frame": "A.B", "save": "%MW5"}, {"function": "receive", "frame": "A.C"}, )" +
      block("%MX0"));
  b.reply("got A.B");
  b.reply("got A.B");
  EXPECT_EQ(b.result(0), "1 0 00 02 00");
  EXPECT_EQ(b.get("%MW5"), "0001");
  EXPECT_EQ(b.result(1), "0 0 00 00 00");
  b.pulse("%MX0");
  b.sent();
  b.reply("got A.C");  // while a reply is due
  EXPECT_EQ(b.result(1), "1 0 00 01 00");
  b.reply("ok", 1ms);
  EXPECT_EQ(b.result(2), "1 0 00 01 00");
  b.client->set_active(false);
  b.reply("got A.B");
  EXPECT_EQ(b.result(0), "1 0 00 02 00");
}

TEST(P2pClient, AllThirtyTwoBlocks) {
  std::string blocks;
  for (int i = 0; i < 32; ++i) blocks += (i > 0 ? "," : "") + block("%MX0");
  Bench b(blocks);
  b.pulse("%MX0");
  for (int i = 0; i < 32; ++i) {
    EXPECT_EQ(b.sent(), "ask " + std::to_string(i));
    b.reply("ok");
  }
  EXPECT_EQ(b.sent(10s), "");
  EXPECT_EQ(b.result(31), "1 0 00 01 00");
}

}  // namespace
}  // namespace fieldproof::p2p
