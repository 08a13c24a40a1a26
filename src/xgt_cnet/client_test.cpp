#include "src/xgt_cnet/client.hpp"

#include <gtest/gtest.h>

#include "src/xgt_cnet/test_frames.hpp"

namespace fieldproof {
namespace {

using test::ack;
using test::enq;
using test::nak;
using test::operator+;

constexpr Duration character = 1ms;
constexpr Duration gap = 4ms;
constexpr Duration time_out = 200ms;

DeviceAddress address(std::string_view name) { return parse_address(*find_plc_model("xbc-h"), name).address; }

struct Bench {
  explicit Bench(std::vector<P2pBlock> blocks = {{address("%MX0"), "%MW100", address("%MW200"), 2, 1}}, bool running = true)
      : client(memory, std::move(blocks), {gap, time_out, character}, running) {}

  void set(std::string_view name, std::string_view hex) {
    const Status status = set_by_name(memory, name, hex);
    ASSERT_TRUE(status) << status.error().message;
    client.scan();
  }
  std::string get(std::string_view name, std::size_t digits = 0) { return *get_by_name(memory, name, digits); }
  /// What goes out at once, if anything.
  Bytes sent() {
    const auto wake = client.wake_at();
    return wake && *wake <= now ? client.advance(now) : Bytes{};
  }
  void reply(const Bytes& bytes) {
    now += 50ms;
    client.receive({bytes, now, character});
    now += character * static_cast<int>(bytes.size());
  }
  /// "NDR ERR STATUS services errors" of a block.
  std::string result(unsigned block) {
    const std::string word = std::to_string(512 + 6 * block), dword = std::to_string((512 + 6 * block) / 2 + 1);
    const std::string errors = std::to_string((512 + 6 * block) / 2 + 2);
    return get("%LX" + word + "0") + ' ' + get("%LX" + word + "1") + ' ' + get("%LW" + std::to_string(513 + 6 * block)) + ' ' +
           get("%LD" + dword) + ' ' + get("%LD" + errors);
  }

  PlcMemory memory{*find_plc_model("xbc-h")};
  XgtClient client;
  Time now{};
};

TEST(XgtClient, AsksOnTheRisingEdgeAndSavesTheReply) {
  Bench b;
  EXPECT_EQ(b.sent(), Bytes{});
  b.set("%MX0", "01");
  EXPECT_EQ(b.sent(), enq("02rSS0106%MW100"));
  b.reply(ack("02rSS0102A9F3"));
  EXPECT_EQ(b.get("%MW200"), "A9F3");
  EXPECT_EQ(b.result(0), "01 00 0000 00000001 00000000");
  EXPECT_EQ(b.sent(), Bytes{});
  EXPECT_EQ(b.client.wake_at(), std::nullopt);
  b.set("%MX0", "01");  // still on
  EXPECT_EQ(b.sent(), Bytes{});
  b.set("%MX0", "00");
  EXPECT_EQ(b.sent(), Bytes{});
  b.set("%MX0", "01");
  EXPECT_EQ(b.sent(), enq("02rSS0106%MW100"));
}

// 000 11.2.4: 'ENQ 01rSS0104%MW0 EOT 40'
TEST(XgtClient, CaptureOfTheManual) {
  Bench b({{address("%MX0"), "%MW0", address("%MW200"), 1, 1}});
  b.set("%MX0", "01");
  EXPECT_EQ(to_hex(b.sent()), "05 30 31 72 53 53 30 31 30 34 25 4D 57 30 04 34 30");
}

TEST(XgtClient, SeveralValuesGoAsOneRun) {
  Bench b({{address("%MX0"), "%MD50", address("%DD10"), 0x1F, 2}});
  b.set("%MX0", "01");
  EXPECT_EQ(b.sent(), enq("1FrSB05%MD5002"));
  b.reply(ack("1FrSB010812345678CAFEBABE"));
  EXPECT_EQ(b.get("%DD10", 16), "12345678CAFEBABE");
}

TEST(XgtClient, OneTransactionAtATime) {
  Bench b({{address("%MX0"), "%MW0", address("%MW200"), 2, 1}, {address("%MX1"), "%MW1", address("%MW201"), 3, 1}});
  b.set("%MX1", "01");
  b.set("%MX0", "01");
  EXPECT_EQ(b.sent(), enq("02rSS0104%MW0"));  // by number of the block
  EXPECT_EQ(b.sent(), Bytes{});
  b.reply(ack("02rSS01021111"));
  EXPECT_EQ(b.sent(), enq("03rSS0104%MW1"));
  b.reply(ack("03rSS01022222"));
  EXPECT_EQ(b.get("%MW200", 8), "11112222");
  EXPECT_EQ(b.result(1), "01 00 0000 00000001 00000000");
  EXPECT_EQ(b.client.counters().services, 2u);
}

TEST(XgtClient, TimesOutAfterTheLastByteSent) {
  Bench b;
  b.set("%MX0", "01");
  const Bytes request = b.sent();
  const Time deadline = character * static_cast<int>(request.size()) + time_out;
  EXPECT_EQ(b.client.wake_at(), deadline);
  b.client.advance(deadline - 1ns);
  EXPECT_EQ(b.result(0), "00 00 0000 00000000 00000000");
  b.client.advance(deadline);
  EXPECT_EQ(b.result(0), "00 01 000A 00000000 00000001");
  b.now = deadline;
  b.reply(ack("02rSS0102A9F3"));  // too late
  EXPECT_EQ(b.get("%MW200"), "0000");
  EXPECT_EQ(b.result(0), "00 01 000A 00000000 00000001");
}

struct BadReply {
  Bytes bytes;
  const char* status;  // Appendix 3.3
};

TEST(XgtClient, RepliesThatAreNotAccepted) {
  Bytes wrong_bcc = ack("02rSS0102A9F3");
  wrong_bcc.back() ^= 1;
  const BadReply cases[] = {
      {nak("02rSS7132"), "000F"},         {wrong_bcc, "0003"},
      {ack("03rSS0102A9F3"), "0004"},     {ack("G2rSS0102A9F3"), "0004"},
      {ack("02RSS0102A9F3"), "0005"},     {ack("02rSB0102A9F3"), "0005"},
      {ack("02wSS"), "0005"},             {ack("02rSS0101A9"), "000B"},
      {ack("02rSS0202A9F302A9F3"), "000B"}, {ack("02rSS0102A9F300"), "000B"},
      {ack("02rSS0102A9"), "000B"},       {ack("02rSS"), "000B"},
      {ack("02rSS0102A9G3"), "000D"},
  };
  for (const BadReply& c : cases) {
    Bench b;
    b.set("%MX0", "01");
    b.sent();
    b.reply(c.bytes);
    EXPECT_EQ(b.result(0), std::string("00 01 ") + c.status + " 00000000 00000001") << to_hex(c.bytes);
    EXPECT_EQ(b.get("%MW200"), "0000") << to_hex(c.bytes);
  }
}

TEST(XgtClient, ReplyWithoutTail) {
  Bench b;
  b.set("%MX0", "01");
  b.sent();
  b.reply(to_bytes("\x06" "02rSS0102"));
  const auto wake = b.client.wake_at();
  ASSERT_TRUE(wake);
  b.client.advance(*wake);
  EXPECT_EQ(b.result(0), "00 01 0002 00000000 00000001");
}

TEST(XgtClient, NoiseBeforeTheReplyIsPassedOver) {
  Bench b;
  b.set("%MX0", "01");
  b.sent();
  b.reply(to_bytes("??") + ack("02rSS0102A9F3"));
  EXPECT_EQ(b.get("%MW200"), "A9F3");
}

TEST(XgtClient, NoiseAloneHasNoHead) {
  Bench b;
  b.set("%MX0", "01");
  b.sent();
  b.reply(to_bytes("02rSS0102A9F3"));
  ASSERT_TRUE(b.client.wake_at());
  b.client.advance(*b.client.wake_at());
  EXPECT_EQ(b.result(0), "00 01 0001 00000000 00000001");
}

TEST(XgtClient, SuccessClearsTheError) {
  Bench b;
  b.set("%MX0", "01");
  b.sent();
  b.reply(nak("02rSS7132"));
  b.set("%MX0", "00");
  b.set("%MX0", "01");
  b.sent();
  b.reply(ack("02rSS0102A9F3"));
  EXPECT_EQ(b.result(0), "01 00 0000 00000001 00000001");
}

TEST(XgtClient, SilentInStop) {
  Bench b({{address("%MX0"), "%MW0", address("%MW200"), 2, 1}}, false);
  b.set("%MX0", "01");
  EXPECT_EQ(b.sent(), Bytes{});
  b.client.set_running(true);
  EXPECT_EQ(b.sent(), Bytes{});  // it rose in STOP
  b.set("%MX0", "00");
  b.set("%MX0", "01");
  EXPECT_EQ(b.sent(), enq("02rSS0104%MW0"));
  b.client.set_running(false);
  b.reply(ack("02rSS0102A9F3"));
  EXPECT_EQ(b.get("%MW200"), "0000");
  EXPECT_EQ(b.client.wake_at(), std::nullopt);
}

TEST(XgtClient, PowerCycleForgetsTheTransaction) {
  Bench b;
  b.set("%MX0", "01");
  b.sent();
  b.client.power_cycle();
  EXPECT_EQ(b.client.wake_at(), std::nullopt);
  b.reply(ack("02rSS0102A9F3"));
  EXPECT_EQ(b.get("%MW200"), "0000");
  EXPECT_EQ(b.get("%MX0"), "01");
}

TEST(XgtClient, SavedValuesMayBeFlags) {
  Bench b({{address("%MX0"), "%MX5", address("%MX1"), 2, 1}, {address("%MX1"), "%MW1", address("%MW201"), 3, 1}});
  b.set("%MX0", "01");
  EXPECT_EQ(b.sent(), enq("02rSS0104%MX5"));
  b.reply(ack("02rSS010101"));
  EXPECT_EQ(b.sent(), enq("03rSS0104%MW1"));
}

TEST(UnpaddedName, DropsLeadingZeros) {
  EXPECT_EQ(unpadded_name("%MW00100"), "%MW100");
  EXPECT_EQ(unpadded_name("%MW000"), "%MW0");
  EXPECT_EQ(unpadded_name("%MW0"), "%MW0");
  EXPECT_EQ(unpadded_name("%MX0000A"), "%MXA");
  EXPECT_EQ(unpadded_name("%IW00.0.0"), "%IW00.0.0");
  EXPECT_EQ(unpadded_name("%M"), "%M");
}

}  // namespace
}  // namespace fieldproof
