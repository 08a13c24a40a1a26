#include "src/xgt_cnet/p2p_driver.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "src/line/line.hpp"
#include "src/p2p/p2p_plc.hpp"
#include "src/xgt_cnet/plc.hpp"
#include "src/xgt_cnet/test_frames.hpp"

namespace fieldproof::xgt_cnet {
namespace {

using nlohmann::json;
using test::ack;
using test::enq;
using test::nak;
using test::operator+;
using ::testing::HasSubstr;

Result<std::unique_ptr<plc::Plc>> make(const json& block, const std::string& model = "xbc-h") {
  const json config{{"p2p", {{"blocks", json::array({block})}}}};
  return p2p::make_p2p_plc(model, config, [](const plc::PortConfig& port) {
    return std::make_unique<XgtP2pDriver>(port.gap());
  });
}

json block(const json& changes = json::object()) {
  json made{{"flag", "%MX0"}, {"read", "%MW100"}, {"save", "%MW200"}, {"station", 2}};
  made.update(changes);
  return made;
}

std::string error_of_block(const json& changes) {
  const Result<std::unique_ptr<plc::Plc>> plc = make(block(changes));
  return plc ? "" : plc.error().message;
}

/// A client with one block, and its partner.
struct ClientBench {
  explicit ClientBench(const json& changes = json::object(), const std::string& model = "xbc-h") {
    Result<std::unique_ptr<plc::Plc>> made = make(block(changes), model);
    EXPECT_TRUE(made) << (made ? "" : made.error().message);
    if (made) plc = std::move(*made);
  }
  void set(std::string_view name, std::string_view hex) {
    const Status status = plc->set(name, hex);
    ASSERT_TRUE(status) << status.error().message;
  }
  std::string get(std::string_view name, std::size_t digits = 0) { return *plc->get(name, digits); }
  Bytes request() {
    set("%MX0", "00");
    set("%MX0", "01");
    return plc->line()->wake_at() == now ? plc->line()->advance(now) : Bytes{};
  }
  void reply(const Bytes& bytes) {
    plc->line()->receive({bytes, now + 10ms, 1ms});
    now += 10ms + 1ms * bytes.size();
  }
  /// "NDR ERR STATUS services errors"
  std::string result() {
    return get("%LX5120") + ' ' + get("%LX5121") + ' ' + get("%LW513") + ' ' + get("%LD257") + ' ' +
           get("%LD258");
  }
  /// Time passes until the block has ended.
  std::string result_in_the_end() {
    while (get("%LW512") == "0000" && plc->line()->wake_at())
      plc->line()->advance(*plc->line()->wake_at());
    return result();
  }

  std::unique_ptr<plc::Plc> plc;
  Time now{};
};

const std::string normal = "01 00 0000 00000001 00000000";
std::string ended(std::string_view status) {
  return "00 01 " + std::string(status) + " 00000000 00000001";
}

// Cnet EN 11.2.4: 'ENQ 01rSS0104%MW0 EOT 40'
TEST(XgtP2pDriver, CaptureOfTheManual) {
  ClientBench b(json{{"read", "%MW0"}, {"station", 1}});
  EXPECT_EQ(to_hex(b.request()), "05 30 31 72 53 53 30 31 30 34 25 4D 57 30 04 34 30");
}

TEST(XgtP2pDriver, ReadsASingleVariable) {
  ClientBench b(json{{"read", "%MW00100"}});
  EXPECT_EQ(b.request(), enq("02rSS0106%MW100"));
  b.reply(ack("02rSS0102A9F3"));
  EXPECT_EQ(b.get("%MW200"), "A9F3");
  EXPECT_EQ(b.result(), normal);
}

TEST(XgtP2pDriver, ReadsFourVariablesAtOnce) {
  ClientBench b(json{{"type", "dword"},
                     {"read", {"%MD1", "%DD2", "%LD3", "%KD4"}},
                     {"save", {"%DD10", "%DD0", "%MD5", "%DD11"}}});
  EXPECT_EQ(b.request(), enq("02rSS0404%MD104%DD204%LD304%KD4"));
  b.reply(
      ack("02rSS04"
          "0411111111"
          "0422222222"
          "0433333333"
          "0444444444"));
  EXPECT_EQ(b.get("%DD10", 16), "1111111144444444");
  EXPECT_EQ(b.get("%DD0"), "22222222");
  EXPECT_EQ(b.get("%MD5"), "33333333");
}

TEST(XgtP2pDriver, ReadsBits) {
  ClientBench b(
      json{{"type", "bit"}, {"read", {"%MX0010A", "%MX0"}}, {"save", {"%MX20F", "%MX210"}}});
  EXPECT_EQ(b.request(), enq("02rSS0206%MX10A04%MX0"));
  b.reply(ack("02rSS0201010100"));
  EXPECT_EQ(b.get("%MW20", 8), "80000000");
}

TEST(XgtP2pDriver, ReadsARun) {
  ClientBench b(json{{"command", "continuous"},
                     {"type", "dword"},
                     {"size", 2},
                     {"read", "%MD50"},
                     {"save", "%DD10"},
                     {"station", 0x1F}});
  EXPECT_EQ(b.request(), enq("1FrSB05%MD5002"));
  b.reply(ack("1FrSB010812345678CAFEBABE"));
  EXPECT_EQ(b.get("%DD10", 16), "12345678CAFEBABE");
}

TEST(XgtP2pDriver, ARunOfOneIsARun) {
  ClientBench b(json{{"command", "continuous"}});
  EXPECT_EQ(b.request(), enq("02rSB06%MW10001"));
}

TEST(XgtP2pDriver, WritesSingleVariables) {
  ClientBench b(
      json{{"function", "write"}, {"read", {"%MW100", "%FW1"}}, {"save", {"%MW0000", "%DW5"}}});
  b.set("%MW100", "00E2");
  b.set("%FW1", "ABCD");
  EXPECT_EQ(b.request(), enq("02wSS0204%MW000E204%DW5ABCD"));
  b.reply(ack("02wSS"));
  EXPECT_EQ(b.result(), normal);
}

// Cnet EN 6.2.4: 10 bytes from M125 on are written from P20 on
TEST(XgtP2pDriver, WritesARun) {
  ClientBench b(json{{"function", "write"},
                     {"command", "continuous"},
                     {"type", "byte"},
                     {"size", 10},
                     {"read", "%MB250"},
                     {"save", "%PB40"}});
  b.set("%MB250", "0102030405060708090A");
  EXPECT_EQ(b.request(), enq("02wSB05%PB400A0102030405060708090A"));
  b.reply(ack("02wSB"));
  EXPECT_EQ(b.result(), normal);
}

TEST(XgtP2pDriver, WritesABit) {
  ClientBench b(json{{"function", "write"}, {"type", "bit"}, {"read", "%MX1"}, {"save", "%PX3"}});
  b.set("%MX1", "01");
  EXPECT_EQ(b.request(), enq("02wSS0104%PX301"));
}

TEST(XgtP2pDriver, NamesOfAnIecPlc) {
  ClientBench b(json{{"read", "%IW0.0.3"}, {"flag", "%MX0"}}, "xec-h");
  EXPECT_EQ(b.request(), enq("02rSS0108%IW0.0.3"));
}

struct BadReply {
  Bytes bytes;
  const char* status;  // Appendix 3.3
};

TEST(XgtP2pDriver, RepliesThatAreNotAccepted) {
  Bytes wrong_bcc = ack("02rSS0102A9F3");
  wrong_bcc.back() ^= 1;
  const BadReply cases[] = {
      {to_bytes("02rSS0102A9F3"), "0001"},
      {to_bytes("\x06"
                "02rSS0102"),
       "0002"},
      {wrong_bcc, "0003"},
      {ack("03rSS0102A9F3"), "0004"},
      {ack("G2rSS0102A9F3"), "0004"},
      {ack("02RSS0102A9F3"), "0005"},
      {ack("02rSB0102A9F3"), "0005"},
      {ack("02wSS"), "0005"},
      {ack("02rXX0102A9F3"), "0005"},
      {ack("02rSS0101A9"), "000B"},
      {ack("02rSS0202A9F302A9F3"), "000B"},
      {ack("02rSS0102A9F300"), "000B"},
      {ack("02rSS0102A9"), "000B"},
      {ack("02rSS0104A9F3A9F3"), "000B"},
      {ack("02rSS"), "000B"},
      {ack("02rSS0102A9G3"), "000D"},
      {nak("02rSS7132"), "000F"},
      {Bytes{}, "000A"},
  };
  for (const BadReply& c : cases) {
    ClientBench b;
    b.request();
    b.reply(c.bytes);
    EXPECT_EQ(b.result_in_the_end(), ended(c.status)) << to_hex(c.bytes);
    EXPECT_EQ(b.get("%MW200"), "0000") << to_hex(c.bytes);
  }
}

TEST(XgtP2pDriver, RepliesToAWrite) {
  for (const BadReply& c : {BadReply{ack("02wSS00"), "000B"},
                            {ack("02wSB"), "0005"},
                            {ack("02rSS"), "0005"},
                            {nak("02wSS1132"), "000F"}}) {
    ClientBench b(json{{"function", "write"}});
    b.request();
    b.reply(c.bytes);
    EXPECT_EQ(b.result(), ended(c.status)) << to_hex(c.bytes);
  }
}

TEST(XgtP2pDriver, ValuesBeyondTheSaveArea) {
  const auto status = [](const char* save) {
    ClientBench b(json{{"save", save}});
    b.request();
    b.reply(ack("02rSS0104A9F3A9F3"));
    return b.get("%LW513");
  };
  EXPECT_EQ(status("%MW1023"), "000E");
  EXPECT_EQ(status("%MW1022"), "000B");
}

TEST(XgtP2pDriver, NoiseBeforeTheReplyIsPassedOver) {
  ClientBench b;
  b.request();
  b.reply(to_bytes("??") + ack("02rSS0102A9F3"));
  EXPECT_EQ(b.get("%MW200"), "A9F3");
}

/// A longest run fills the limit of every type, and one more is refused.
TEST(XgtP2pDriver, ARunHasAtMost120Bytes) {
  for (const auto& [type, letter, most] :
       {std::tuple{"byte", "B", 120}, {"word", "W", 60}, {"dword", "D", 30}, {"lword", "L", 15}}) {
    const auto error = [&, t = type, l = std::string(letter)](int size) {
      return error_of_block({{"command", "continuous"},
                             {"type", t},
                             {"size", size},
                             {"read", "%M" + l + "0"},
                             {"save", "%D" + l + "0"}});
    };
    EXPECT_EQ(error(most), "");
    EXPECT_THAT(error(most + 1), HasSubstr("P2P block 0: size is " + std::to_string(most + 1) +
                                           "; a run has at most 120 bytes"));
  }
}

TEST(XgtP2pDriver, WhatIsRefused) {
  EXPECT_EQ(error_of_block({{"read", "MW100"}}),
            "cannot set up P2P block 0: read 'MW100' is no device name of the partner; give one "
            "such as %MW100");
  for (const char* name : {"%MW", "%MW10g", "%MZ100", "%MW00000000000001", ""})
    EXPECT_THAT(error_of_block({{"read", name}}), HasSubstr("no device name")) << name;
  EXPECT_EQ(error_of_block({{"read", "%MW0000000000001"}}), "");  // 16 characters
  EXPECT_THAT(error_of_block({{"read", "%MD100"}}),
              HasSubstr("read '%MD100' is not of the block's type; its type letter is W"));
  EXPECT_THAT(error_of_block({{"function", "write"}, {"save", "%MD1"}}),
              HasSubstr("save '%MD1' is not of the block's type"));
  EXPECT_THAT(error_of_block(
                  {{"command", "continuous"}, {"type", "bit"}, {"read", "%MX0"}, {"save", "%MX1"}}),
              HasSubstr("use command single"));
}

TEST(XgtP2pDriver, TalksToAServer) {
  const line::LineSettings line{.baud = 38400, .data_bits = 7, .parity = 'E'};
  const auto server = make_plc({.model = "xbm-s", .station = 2, .line = line});
  ASSERT_TRUE(server);
  const json config = json::parse(R"({"line": "38400-7E1", "p2p": {"blocks": [
    {"flag": "F92", "read": ["%MW100", "%DW5"], "save": ["%MW200", "%MW300"], "station": 2},
    {"flag": "F92", "function": "write", "command": "continuous", "size": 60, "read": "%DW0", "save": "%DW100", "station": 2},
    {"flag": "F93", "read": "%MW256", "save": "%MW201", "station": 2}]}})");
  const auto client = p2p::make_p2p_plc("xbc-h", config, [](const plc::PortConfig& port) {
    return std::make_unique<XgtP2pDriver>(port.gap());
  });
  ASSERT_TRUE(client) << client.error().message;
  line::SimulatedLine wire(line);
  wire.attach(*(*client)->line(), line);
  wire.attach(*(*server)->line(), line);
  ASSERT_TRUE((*server)->set("%MW100", "CAFE"));
  ASSERT_TRUE((*server)->set("%DW5", "F00D"));
  ASSERT_TRUE((*client)->set("%DW59", "1234"));
  while (wire.now() < 2100ms) wire.receive(2100ms);
  EXPECT_EQ(*(*client)->get("%MW200", 0), "CAFE");
  EXPECT_EQ(*(*client)->get("%MW300", 0), "F00D");
  EXPECT_EQ(*(*server)->get("%DW159", 0), "1234");
  EXPECT_EQ(*(*client)->get("%LD257", 0), "0000000A");  // every 200 ms
  EXPECT_EQ(*(*client)->get("%LD260", 0), "0000000A");
  EXPECT_EQ(*(*client)->get("%LW525", 0), "000F");  // beyond the area of the partner
  EXPECT_EQ(*(*client)->get("%LD264", 0), "00000002");
}

}  // namespace
}  // namespace fieldproof::xgt_cnet
