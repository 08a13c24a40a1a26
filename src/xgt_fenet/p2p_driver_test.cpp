#include "src/xgt_fenet/p2p_driver.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "src/net/network.hpp"
#include "src/p2p/p2p_plc.hpp"
#include "src/xgt_fenet/server.hpp"

namespace fieldproof::xgt_fenet {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

Result<std::unique_ptr<plc::Plc>> make(json block, const std::string& model = "xbc-h",
                                       const std::string& transport = "tcp") {
  block.update({{"flag", "%MX0"}});
  const json config{{"role", "client"},
                    {"p2p", {{"transport", transport}, {"blocks", json::array({block})}}}};
  Result<std::unique_ptr<plc::Plc>> plc = plc::make_plc(model, config);
  if (!plc) return plc;
  const Status added = p2p::add_network_clients(
      **plc, config, {{"xgt-fenet", {.tcp = tcp_port, .udp = udp_port}, [] {
                         return std::make_unique<FenetP2pDriver>();
                       }}});
  if (!added) return added.error();
  return plc;
}

/// "54 00 ' '": hex bytes, and text in quotes.
Bytes bytes(std::string_view text) {
  Bytes all;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t quote = std::min(text.find('\'', at), text.size());
    const Bytes plain = from_hex(text.substr(at, quote - at)).value();
    all.insert(all.end(), plain.begin(), plain.end());
    if (quote == text.size()) break;
    const std::size_t end = text.find('\'', quote + 1);
    for (const char c : text.substr(quote + 1, end - quote - 1))
      all.push_back(static_cast<Byte>(c));
    at = end + 1;
  }
  return all;
}

/// A client that asks its one block at each edge, and a bench that hears it.
class Bench {
 public:
  explicit Bench(const json& block, const std::string& model = "xbc-h",
                 const std::string& transport = "tcp") {
    Result<std::unique_ptr<plc::Plc>> made = make(block, model, transport);
    if (!made) throw std::runtime_error(made.error().message);
    plc = std::move(*made);
    network.attach(*plc->network());
  }

  Bytes frame() {
    EXPECT_TRUE(plc->set("%MX0", "00") && plc->set("%MX0", "01"));
    for (;;) {
      const Burst burst = network.receive(network.now());
      link = burst.link;
      if (burst.event == LinkEvent::data || burst.event == LinkEvent::datagram) return burst.bytes;
    }
  }
  /// The body of a request; its header is right.
  Bytes request() {
    const Bytes all = frame();
    const auto header = read_header(all);
    if (!header) return {};
    EXPECT_EQ(header->company, lsis_xgt);
    EXPECT_EQ(header->plc_info, 0);
    EXPECT_EQ(header->source, from_client);
    EXPECT_EQ(header->position, 0);
    EXPECT_EQ(all.size(), header->frame_size());
    EXPECT_EQ(header->check, header_check(all));
    invoke = header->invoke;
    return {all.begin() + header_size, all.end()};
  }
  Header header() const { return {.plc_info = 0x107, .source = from_server, .invoke = invoke}; }
  void reply(std::string_view body) { send(encode_frame(header(), bytes(body))); }
  void send(ByteView all) { ASSERT_TRUE(network.send(link, all)); }
  std::string get(std::string_view name, std::size_t digits = 4) { return *plc->get(name, digits); }
  /// NDR and ERR, STATUS.
  std::string result() { return get("%LW512") + ' ' + get("%LW513"); }

  std::unique_ptr<plc::Plc> plc;
  net::SimulatedNetwork network;
  LinkId link = 0;
  std::uint16_t invoke = 0;
};

const json read_word{{"read", "%MW100"}, {"save", "%MW200"}};

json with(const json& block, const json& changes) {
  json made = block;
  made.update(changes);
  return made;
}

TEST(FenetP2pDriver, CountsItsRequests) {
  Bench bench(read_word);
  // FEnet EN tables 5-3, 5-6; CPU B0: XGB (MK).
  EXPECT_EQ(to_text(bench.frame()), to_text(bytes("'LSIS-XGT' 00 00 00 00 B0 33 01 00 10 00 00 4F"
                                                  "54 00 02 00 00 00 01 00 06 00 '%MW100'")));
  bench.invoke = 1;
  bench.reply("55 00 02 00 00 00 00 00 01 00 02 00 34 12");
  EXPECT_EQ(bench.get("%MW200"), "1234");
  EXPECT_EQ(bench.result(), "0001 0000");
  for (unsigned number = 2; number < 300; ++number) {
    (void)bench.request();
    ASSERT_EQ(bench.invoke, number);
    bench.reply("55 00 02 00 00 00 00 00 01 00 02 00 34 12");
  }
}

TEST(FenetP2pDriver, SaysWhichCpuItIs) {
  Bench bench(read_word, "xec-h");
  EXPECT_EQ(bench.frame()[12], 0xB4);
}

TEST(FenetP2pDriver, ReadsEachTypeLowByteFirst) {
  const auto read = [](const json& block, std::string_view asked, std::string_view answer) {
    Bench bench(block);
    EXPECT_EQ(to_text(bench.request()), to_text(bytes(asked)));
    bench.reply(answer);
    EXPECT_EQ(bench.result(), "0001 0000");
    return bench.get("%MW199", 16);
  };
  EXPECT_EQ(
      read({{"type", "bit"}, {"read", "%MX1003"}, {"save", "%MX2010"}},
           "54 00 00 00 00 00 01 00 07 00 '%MX1003'", "55 00 00 00 00 00 00 00 01 00 01 00 01"),
      "0000000000010000");
  EXPECT_EQ(
      read({{"type", "byte"}, {"read", "%MB200"}, {"save", "%MB401"}},
           "54 00 01 00 00 00 01 00 06 00 '%MB200'", "55 00 01 00 00 00 00 00 01 00 01 00 5A"),
      "00005A0000000000");
  EXPECT_EQ(read({{"type", "dword"}, {"read", "%MD50"}, {"save", "%MD100"}},
                 "54 00 03 00 00 00 01 00 05 00 '%MD50'",
                 "55 00 03 00 00 00 00 00 01 00 04 00 78 56 34 12"),
            "0000567812340000");
  EXPECT_EQ(read({{"type", "lword"}, {"read", "%ML00025"}, {"save", "%ML50"}},
                 "54 00 04 00 00 00 01 00 05 00 '%ML25'",
                 "55 00 04 00 00 00 00 00 01 00 08 00 01 02 03 04 05 06 07 08"),
            "0000020104030605");
  EXPECT_EQ(read({{"read", {"%MW100", "%DW7"}}, {"save", {"%MW201", "%MW200"}}},
                 "54 00 02 00 00 00 02 00 06 00 '%MW100' 04 00 '%DW7'",
                 "55 00 02 00 00 00 00 00 02 00 02 00 BC 5A 02 00 93 18"),
            "000018935ABC0000");
}

TEST(FenetP2pDriver, ARunIsAskedForByBytes) {
  Bench bench(with(read_word, {{"command", "continuous"}, {"size", 3}}));
  EXPECT_EQ(to_text(bench.request()),
            to_text(bytes("54 00 14 00 00 00 01 00 06 00 '%MB200' 06 00")));
  bench.reply("55 00 14 00 00 00 00 00 01 00 06 00 BC 5A 93 18 01 7E");
  EXPECT_EQ(bench.get("%MW200", 12), "5ABC18937E01");
}

TEST(FenetP2pDriver, WritesNamesFirstThenData) {
  Bench bench(
      json{{"function", "write"}, {"read", {"%MW10", "%MW11"}}, {"save", {"%DW1", "%KW2"}}});
  ASSERT_TRUE(bench.plc->set("%MW10", "12345678"));
  EXPECT_EQ(to_text(bench.request()),
            to_text(bytes("58 00 02 00 00 00 02 00 04 00 '%DW1' 04 00 '%KW2'"
                          "02 00 34 12 02 00 78 56")));
  bench.reply("59 00 02 00 00 00 00 00 02 00");
  EXPECT_EQ(bench.result(), "0001 0000");

  Bench run(json{{"function", "write"},
                 {"type", "dword"},
                 {"read", "%MD5"},
                 {"save", "%DD4"},
                 {"command", "continuous"},
                 {"size", 1}});
  ASSERT_TRUE(run.plc->set("%MW10", "12345678"));
  EXPECT_EQ(to_text(run.request()),
            to_text(bytes("58 00 14 00 00 00 01 00 05 00 '%DB16' 04 00 34 12 78 56")));
  run.reply("59 00 14 00 00 00 00 00 01 00");
  EXPECT_EQ(run.result(), "0001 0000");
}

TEST(FenetP2pDriver, ARefusalGivesItsCode) {
  const auto refused = [](std::string_view code) {
    Bench bench(read_word);
    (void)bench.request();
    bench.reply("55 00 02 00 00 00 FF FF " + std::string(code));
    return bench.result();
  };
  EXPECT_EQ(refused("04 00"), "0002 0004");
  EXPECT_EQ(refused("34 12"), "0002 1234");
  EXPECT_EQ(refused("00 00"), "0002 000F") << "an error all the same";
  EXPECT_EQ(refused("04 00 00"), "0002 000B");
}

/// What is no reply to the request does not end the wait.
TEST(FenetP2pDriver, AReplyIsTakenByItsInvokeId) {
  Bench bench(read_word);
  (void)bench.request();
  const Bytes body = bytes("55 00 02 00 00 00 00 00 01 00 02 00 CD 6B");
  Header other = bench.header();
  other.invoke = 0x0100;
  bench.send(encode_frame(other, body));
  other = bench.header();
  other.company = lgis_glofa;
  bench.send(encode_frame(other, body));
  other = bench.header();
  other.source = from_client;
  bench.send(encode_frame(other, body));
  EXPECT_EQ(bench.result(), "0000 0000");
  EXPECT_EQ(bench.get("%MW200"), "0000");
  bench.reply("55 00 02 00 00 00 00 00 01 00 02 00 34 12");
  EXPECT_EQ(bench.get("%MW200"), "1234");
}

TEST(FenetP2pDriver, AReplyOfAnotherFormIsAnErrorAndSavesNothing) {
  const auto ended = [](std::string_view body) {
    Bench bench(read_word);
    (void)bench.request();
    bench.reply(body);
    EXPECT_EQ(bench.get("%MW200", 8), "00000000") << body;
    return bench.result();
  };
  EXPECT_EQ(ended("59 00 02 00 00 00 00 00 01 00 02 00 CD 6B"), "0002 0005");
  EXPECT_EQ(ended("55 00 03 00 00 00 00 00 01 00 02 00 CD 6B"), "0002 0005");
  for (const char* wrong :
       {"", "55 00 02 00 00 00 00 00", "55 00 02 00 00 00 00 00 00 00",
        "55 00 02 00 00 00 00 00 02 00 02 00 CD 6B 02 00 EF 7A",
        "55 00 02 00 00 00 00 00 01 00 01 00 CD", "55 00 02 00 00 00 00 00 01 00 03 00 CD 6B",
        "55 00 02 00 00 00 00 00 01 00 02 00 CD 6B 00",
        "55 00 02 00 00 00 00 00 01 00 04 00 CD 6B EF 7A"})
    EXPECT_EQ(ended(wrong), "0002 000B") << wrong;

  Bench last(with(read_word, {{"save", "%MW1023"}}));
  (void)last.request();
  last.reply("55 00 02 00 00 00 00 00 01 00 04 00 CD 6B EF 7A");
  EXPECT_EQ(last.result(), "0002 000E") << "beyond the end of the save area";

  Bench write(json{{"function", "write"}, {"read", "%MW10"}, {"save", "%DW1"}});
  (void)write.request();
  write.reply("59 00 02 00 00 00 00 00 02 00");
  EXPECT_EQ(write.result(), "0002 000B");
}

/// A reply cut anywhere, and what was left of it when the connection went.
TEST(FenetP2pDriver, AStreamIsFollowedAcrossSegments) {
  Bench bench(read_word);
  (void)bench.request();
  const Bytes reply =
      encode_frame(bench.header(), bytes("55 00 02 00 00 00 00 00 01 00 02 00 34 12"));
  for (const Byte one : reply) bench.send(Bytes{one});
  EXPECT_EQ(bench.get("%MW200"), "1234");
  (void)bench.request();
  bench.send(ByteView(reply).first(25));
  ASSERT_TRUE(bench.network.close(bench.link, Closing::rst));
  EXPECT_EQ(bench.result(), "0002 0007");
  (void)bench.request();
  bench.reply("55 00 02 00 00 00 00 00 01 00 02 00 78 56");
  EXPECT_EQ(bench.get("%MW200"), "5678");
}

TEST(FenetP2pDriver, ADatagramIsOneFrame) {
  const Bytes body = bytes("55 00 02 00 00 00 00 00 01 00 02 00 34 12");
  Bench bench(read_word, "xbc-h", "udp");
  (void)bench.request();
  Bytes longer = encode_frame(bench.header(), body);
  longer.push_back(0);
  bench.send(longer);
  EXPECT_EQ(bench.result(), "0002 000B");
  (void)bench.request();
  bench.send(bytes("'LSIS-XGT'"));
  EXPECT_EQ(bench.result(), "0002 000B") << "still waiting";
  bench.send(encode_frame(bench.header(), body));
  EXPECT_EQ(bench.result(), "0001 0000");
}

TEST(FenetP2pDriver, RefusesWhatCannotBeAsked) {
  const auto error = [](const json& changes) {
    const auto plc = make(with(read_word, changes));
    return plc ? "" : plc.error().message;
  };
  const json run{{"command", "continuous"}, {"size", 256}};
  EXPECT_EQ(error(run), "");
  EXPECT_THAT(error(with(run, {{"size", 257}})), HasSubstr("at most 512 bytes: 256 elements"));
  EXPECT_THAT(
      error({{"command", "continuous"}, {"type", "bit"}, {"read", "%MX0"}, {"save", "%MX16"}}),
      HasSubstr("bits are not read"));
  EXPECT_THAT(error(with(run, {{"read", "%IW0.0.0"}})), HasSubstr("no decimal number"));
  EXPECT_THAT(error(with(run, {{"read", "%MW00A"}})), HasSubstr("no decimal number"));
  EXPECT_THAT(error({{"read", "%MB100"}}), HasSubstr("its type letter is W"));
}

}  // namespace
}  // namespace fieldproof::xgt_fenet
