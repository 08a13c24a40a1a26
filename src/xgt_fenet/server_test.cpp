#include "src/xgt_fenet/server.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "src/net/network.hpp"
#include "src/xgt_fenet/plc.hpp"

namespace fieldproof::xgt_fenet {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Fenet : public testing::Test {
 protected:
  void make(const json& config, std::string_view model = "xbc-h",
            const net::Conditions& conditions = {}) {
    Result<std::unique_ptr<plc::EmulatedDevice>> made = make_plc(model, config);
    ASSERT_TRUE(made) << made.error().message;
    plc_ = std::move(*made);
    network_.emplace(conditions);
    network_->attach(*plc_->network());
  }
  plc::EmulatedDevice& plc() {
    if (!plc_) make(json::object());
    return *plc_;
  }
  net::SimulatedNetwork& network() {
    (void)plc();
    return *network_;
  }
  LinkId open() { return network().open(Transport::tcp, tcp_port); }

  /// A request with invoke id 0001; the body in hex and quoted text: "54 00 '%MW0'".
  static Bytes frame(std::string_view body, Header header = {.cpu_info = 0xA0, .invoke = 1}) {
    Bytes bytes;
    for (bool quoted = false; !body.empty();) {
      const std::size_t end = std::min(body.find('\''), body.size());
      const std::string_view piece = body.substr(0, end);
      const Bytes part = quoted ? to_bytes(piece) : *from_hex(piece);
      bytes.insert(bytes.end(), part.begin(), part.end());
      quoted = !quoted;
      body.remove_prefix(std::min(end + 1, body.size()));
    }
    return encode_frame(header, bytes);
  }

  void send(LinkId link, const Bytes& bytes) { ASSERT_TRUE(network().send(link, bytes)); }

  /// What comes next, whole: hex, "FIN", "RST"; "" until then.
  std::string heard(Duration within = 1s) {
    const Burst burst = network().receive(network().now() + within);
    from_ = burst.link;
    switch (burst.event) {
      case LinkEvent::closed: return "FIN";
      case LinkEvent::reset: return "RST";
      default: return to_hex(burst.bytes);
    }
  }
  /// The body of the reply.
  std::string ask(const Bytes& request) {
    if (!link_) link_ = open();
    send(*link_, request);
    const std::string reply = heard();
    return reply.size() > 60 ? reply.substr(60) : reply;
  }
  std::string ask(std::string_view body) { return ask(frame(body)); }
  /// The code of a refusal, or the whole body.
  std::string code(std::string_view body) {
    const std::string reply = ask(body);
    return reply.size() == 29 && reply.substr(18, 5) == "FF FF" ? reply.substr(24) : reply;
  }

  LinkId from_{};  // the link of what was heard last

 private:
  std::unique_ptr<plc::EmulatedDevice> plc_;
  std::optional<net::SimulatedNetwork> network_;
  std::optional<LinkId> link_;
};

// FEnet EN 5.2.6, tables 5-6 to 5-9; the check of table 5-6 is an erratum (3C), and what is the
// PLC's own differs: CPU info B0, position 01, PLC info of an XGB in RUN.
TEST_F(Fenet, AnswersThePrintedExamples) {
  const LinkId link = open();
  send(link, *from_hex("4C 53 49 53 2D 58 47 54 00 00 00 00 A0 33 00 00 0E 00 00 3C"
                       "54 00 02 00 00 00 01 00 04 00 25 4D 57 30"));
  EXPECT_EQ(heard(),
            "4C 53 49 53 2D 58 47 54 00 00 07 01 B0 11 00 00 0E 00 01 33 "
            "55 00 02 00 00 00 00 00 01 00 02 00 00 00");
  send(link, *from_hex("4C 53 49 53 2D 58 47 54 00 00 00 00 A0 33 00 01 10 00 00 3F"
                       "54 00 14 00 00 00 01 00 04 00 25 4D 42 30 02 00"));
  EXPECT_EQ(heard(),
            "4C 53 49 53 2D 58 47 54 00 00 07 01 B0 11 00 01 0E 00 01 34 "
            "55 00 14 00 00 00 00 00 01 00 02 00 00 00");
}

TEST_F(Fenet, HeadersOfRepliesTellModelModeAndPlace) {
  const auto header = [&](std::string_view model, const json& config) {
    make(config, model);
    const LinkId link = open();
    send(link, frame("54 00 02 00 00 00 01 00 04 00 '%MW0'",
                     {.company = lgis_glofa, .invoke = 0xFEDC, .position = 0x77}));
    return heard().substr(0, 59);
  };
  EXPECT_EQ(header("xbm-s", {{"mode", "stop"}, {"base", 2}, {"slot", 5}}),
            "4C 47 49 53 2D 47 4C 4F 46 41 07 02 B0 11 DC FE 0E 00 25 9C");
  EXPECT_EQ(header("xec-h", {{"error", true}}),
            "4C 47 49 53 2D 47 4C 4F 46 41 87 04 B4 11 DC FE 0E 00 01 FE");
}

TEST_F(Fenet, ReadsAndWritesEachType) {
  ASSERT_TRUE(plc().set("%MW100", "123456789ABCDEF0"));
  EXPECT_EQ(ask("54 00 00 00 00 00 01 00 08 00 '%MX00102'"),
            "55 00 00 00 00 00 00 00 01 00 01 00 00");
  EXPECT_EQ(ask("54 00 00 00 00 00 01 00 07 00 '%MX1002'"),
            "55 00 00 00 00 00 00 00 01 00 01 00 01");
  EXPECT_EQ(ask("54 00 01 00 00 00 01 00 06 00 '%MB201'"),
            "55 00 01 00 00 00 00 00 01 00 01 00 12");
  EXPECT_EQ(ask("54 00 02 00 00 00 02 00 06 00 '%MW100' 06 00 '%mw101'"),
            "55 00 02 00 00 00 00 00 02 00 02 00 34 12 02 00 78 56");
  EXPECT_EQ(ask("54 00 03 00 00 00 01 00 05 00 '%MD50'"),
            "55 00 03 00 00 00 00 00 01 00 04 00 34 12 78 56");
  EXPECT_EQ(ask("54 00 04 00 00 00 01 00 05 00 '%ML25'"),
            "55 00 04 00 00 00 00 00 01 00 08 00 34 12 78 56 BC 9A F0 DE");
  EXPECT_EQ(ask("58 00 02 00 00 00 02 00 06 00 '%DW200' 06 00 '%DW201' 02 00 CD AB 02 00 02 01"),
            "59 00 02 00 00 00 00 00 02 00");
  EXPECT_EQ(*plc().get("%DW200", 8), "ABCD0102");
  EXPECT_EQ(ask("58 00 00 00 00 00 01 00 07 00 '%DX2000' 01 00 00"),
            "59 00 00 00 00 00 00 00 01 00");
  EXPECT_EQ(*plc().get("%DW200", 4), "ABCC") << "D takes bits, too";
  EXPECT_EQ(ask("58 00 00 00 00 00 01 00 07 00 '%DX2001' 01 00 FE"),
            "59 00 00 00 00 00 00 00 01 00");
  EXPECT_EQ(*plc().get("%DW200", 4), "ABCC") << "bit 0 of the value counts";
}

TEST_F(Fenet, ReadsAndWritesRunsOfBytes) {
  EXPECT_EQ(ask("58 00 14 00 00 00 01 00 06 00 '%MB201' 03 00 01 02 03"),
            "59 00 14 00 00 00 00 00 01 00");
  EXPECT_EQ(*plc().get("%MW100", 8), "01000302");
  EXPECT_EQ(ask("54 00 14 00 00 00 01 00 06 00 '%MB200' 04 00"),
            "55 00 14 00 00 00 00 00 01 00 04 00 00 01 02 03");
  const auto read = [&](std::string_view count) {
    return ask("54 00 14 00 00 00 01 00 04 00 '%MB0' " + std::string(count)).substr(30, 5);
  };
  EXPECT_EQ(read("00 02"), "00 02") << "512 bytes";
}

TEST_F(Fenet, RefusesWithTheCodeOfTheFirstFault) {
  EXPECT_EQ(code("52 00 02 00 00 00 01 00 04 00 '%MW0'"), "78 00");
  EXPECT_EQ(code("54 00 05 00 00 00 01 00 04 00 '%MW0'"), "24 00");
  EXPECT_EQ(code("54 00 02 00 00 00 00 00"), "01 00");
  EXPECT_EQ(code("54 00 02 00 00 00 11 00 04 00 '%MW0'"), "01 00");
  EXPECT_EQ(code("54 00 14 00 00 00 02 00 04 00 '%MB0' 01 00"), "01 00");
  EXPECT_EQ(code("54 00 02 00 00 00 01 00 03 00 '%MW'"), "11 00");
  EXPECT_EQ(code("54 00 02 00 00 00 01 00 11 00 '%MW00000000000000'"), "11 00");
  EXPECT_EQ(code("54 00 02 00 00 00 01 00 04 00 'MW10'"), "11 00");
  EXPECT_EQ(code("54 00 02 00 00 00 01 00 04 00 '%MW?'"), "11 00");
  EXPECT_EQ(code("54 00 02 00 00 00 01 00 04 00 '%AW0'"), "03 00");
  EXPECT_EQ(code("54 00 02 00 00 00 01 00 04 00 '%1W0'"), "10 00");
  EXPECT_EQ(code("54 00 02 00 00 00 01 00 04 00 '%MB0'"), "02 00");
  EXPECT_EQ(code("54 00 02 00 00 00 01 00 04 00 '%MZ0'"), "02 00");
  EXPECT_EQ(code("54 00 14 00 00 00 01 00 04 00 '%MW0' 02 00"), "12 00");
  EXPECT_EQ(code("54 00 02 00 00 00 01 00 08 00 '%MW99999'"), "04 00");
  EXPECT_EQ(code("58 00 02 00 00 00 01 00 04 00 '%FW0' 02 00 01 00"), "03 00");
  EXPECT_EQ(code("54 00 14 00 00 00 01 00 04 00 '%MB0' 00 00"), "05 00");
  EXPECT_EQ(code("54 00 14 00 00 00 01 00 04 00 '%MB0' 01 02"), "05 00");
  EXPECT_EQ(code("58 00 02 00 00 00 01 00 04 00 '%MW0' 01 00 01"), "05 00");
  EXPECT_EQ(code("54 00 02 00 00 00 01 00 04 00 '%MW0' 00"), "76 00");
  EXPECT_EQ(ask("52 00 02 00 00 00 01 00 04 00 '%MW0'"), "53 00 02 00 00 00 FF FF 78 00");
}

TEST_F(Fenet, ABodyThatIsCutIsRefused) {
  const Bytes whole = frame("58 00 02 00 00 00 01 00 04 00 '%MW0' 02 00 34 12");
  for (std::size_t size = 0; size < whole.size() - header_size; ++size) {
    const Bytes body(whole.begin() + header_size,
                     whole.begin() + static_cast<std::ptrdiff_t>(header_size + size));
    EXPECT_EQ(ask(encode_frame({.invoke = 1}, body)).substr(18), "FF FF 76 00") << size;
  }
  EXPECT_EQ(*plc().get("%MW0", 4), "0000");
  EXPECT_EQ(ask(""), "01 00 00 00 00 00 FF FF 76 00");
  EXPECT_EQ(ask("54"), "55 00 00 00 00 00 FF FF 76 00");
  EXPECT_EQ(ask("54 00 02"), "55 00 02 00 00 00 FF FF 76 00");
}

TEST_F(Fenet, AWriteIsAllOrNothing) {
  EXPECT_EQ(code("58 00 02 00 00 00 02 00 04 00 '%MW0' 04 00 '%FW0' 02 00 01 00 02 00 01 00"),
            "03 00");
  EXPECT_EQ(code("58 00 02 00 00 00 02 00 04 00 '%MW0' 04 00 '%MW1' 02 00 01 00 01 00 01"),
            "05 00");
  EXPECT_EQ(*plc().get("%MW0", 4), "0000");
}

TEST_F(Fenet, LooksAtTheCheckAsItIsSet) {
  const auto codes = [&](const char* policy) {
    make({{"header_check", policy}});
    std::string all;
    for (const int off : {0, 1, -1}) {
      const LinkId link = open();
      Bytes request = frame("54 00 02 00 00 00 01 00 04 00 '%MW0'");
      request[19] = off < 0 ? Byte{0} : static_cast<Byte>(request[19] + off);
      send(link, request);
      const std::string reply = heard();
      all += reply.substr(78, 5) == "FF FF" ? reply.substr(84, 2) + ' ' : "ok ";
    }
    return all;
  };
  EXPECT_EQ(codes("ignore"), "ok ok ok ");
  EXPECT_EQ(codes("zero_or_valid"), "ok 77 ok ");
  EXPECT_EQ(codes("strict"), "ok 77 77 ");
}

TEST_F(Fenet, AForeignCompanyIsRefusedInOurName) {
  Header header{.invoke = 0x1234};
  header.company.fill('A');
  EXPECT_EQ(ask(frame("54 00 02 00 00 00 01 00 04 00 '%MW0'", header)),
            "55 00 02 00 00 00 FF FF 75 00");
  send(open(), frame("", header));
  EXPECT_EQ(heard().substr(0, 48), "4C 53 49 53 2D 58 47 54 00 00 07 01 B0 11 34 12 ");
}

TEST_F(Fenet, AFrameMayComeInAnyPieces) {
  const Bytes request = frame("54 00 02 00 00 00 01 00 04 00 '%MW0'");
  const LinkId link = open();
  for (const Byte b : request) {
    EXPECT_EQ(heard(2s), "");
    send(link, Bytes{b});
  }
  EXPECT_NE(heard(), "");
  Bytes two = request;
  two.insert(two.end(), request.begin(), request.end());
  send(link, two);
  EXPECT_NE(heard(), "");
  EXPECT_NE(heard(), "");
  EXPECT_EQ(heard(), "");
}

TEST_F(Fenet, ADatagramIsOneFrame) {
  const LinkId link = network().open(Transport::udp, udp_port);
  const auto code_of = [&](Bytes datagram) {
    send(link, datagram);
    const std::string reply = heard();
    return reply.size() < 86 ? reply : reply.substr(78, 5) == "FF FF" ? reply.substr(84, 2) : "ok";
  };
  const Bytes request = frame("54 00 02 00 00 00 01 00 04 00 '%MW0'");
  Bytes longer = request, shorter = request;
  longer.push_back(0);
  shorter.pop_back();
  EXPECT_EQ(code_of(request), "ok");
  EXPECT_EQ(code_of(longer), "76");
  EXPECT_EQ(code_of(shorter), "76");
  EXPECT_EQ(code_of(Bytes(19, 0x4C)), "");
  EXPECT_EQ(*plc().get("@services", 0) + *plc().get("@errors", 0), "00030001");
}

TEST_F(Fenet, AnswersClosingByResetAndTheFifthAtOnce) {
  std::vector<LinkId> links;
  for (int i = 0; i < 4; ++i) links.push_back(open());
  EXPECT_EQ(heard(), "");
  const LinkId fifth = open();
  EXPECT_EQ(heard(), "RST");
  EXPECT_EQ(from_, fifth);
  ASSERT_TRUE(network().close(links[1], Closing::fin));
  EXPECT_EQ(heard(), "RST");
  EXPECT_EQ(from_, links[1]);
  send(open(), frame("54 00 02 00 00 00 01 00 04 00 '%MW0'"));
  EXPECT_NE(heard(), "RST");
}

TEST_F(Fenet, EachRequestRestartsTheWaitingTime) {
  make({{"waiting_time", 2}});
  const LinkId link = open();
  for (int i = 0; i < 3; ++i) {
    send(link, frame("54 00 02 00 00 00 01 00 04 00 '%MW0'"));
    EXPECT_NE(heard(1s), "RST");
    EXPECT_EQ(heard(1900ms), "");
  }
  EXPECT_EQ(heard(101ms), "RST");
}

TEST_F(Fenet, TheHostTableKeepsOthersOut) {
  make({{"host_table", {"203.0.113.7"}}});
  open();
  EXPECT_EQ(heard(), "RST");
  LinkId link = network().open(Transport::udp, udp_port);
  send(link, frame("54 00 02 00 00 00 01 00 04 00 '%MW0'"));
  EXPECT_EQ(heard(), "");
  make({{"host_table", {"203.0.113.7", "127.0.0.1"}}});
  link = open();
  send(link, frame("54 00 02 00 00 00 01 00 04 00 '%MW0'"));
  EXPECT_GT(heard().size(), 60u) << "the bench of the simulation is at 127.0.0.1";
}

TEST_F(Fenet, HasOneDriver) {
  EXPECT_TRUE(plc().network()->listens(Transport::tcp, 2004));
  EXPECT_TRUE(plc().network()->listens(Transport::udp, 2005));
  EXPECT_FALSE(plc().network()->listens(Transport::tcp, 502));
  EXPECT_FALSE(plc().network()->listens(Transport::tcp, 2005));
}

TEST_F(Fenet, APowerCycleForgetsConnections) {
  const LinkId link = open();
  EXPECT_EQ(heard(), "");
  ASSERT_TRUE(plc().act("power_cycle"));
  send(link, frame("54 00 02 00 00 00 01 00 04 00 '%MW0'"));
  EXPECT_EQ(heard(), "RST");
}

TEST(FenetConfig, ErrorsNameTheKey) {
  const auto message = [](const json& config) {
    const auto made = make_plc("xbc-h", config);
    return made ? std::string("made") : made.error().message;
  };
  EXPECT_THAT(message({{"header_check", "strikt"}}), HasSubstr("did you mean 'strict'"));
  EXPECT_THAT(message({{"connections", 5}}), HasSubstr("connections"));
  EXPECT_THAT(message({{"connections", 0}}), HasSubstr("give 1 to 4"));
  EXPECT_THAT(message({{"waiting_time", 1}}), HasSubstr("2 to 255"));
  EXPECT_THAT(message({{"waiting_time", 256}}), HasSubstr("waiting_time"));
  EXPECT_THAT(message({{"slot", 16}}), HasSubstr("slot is 16, which is not a number from 1 to 15"));
  EXPECT_THAT(message({{"slot", 0}}), HasSubstr("slot"));
  EXPECT_THAT(message({{"base", 16}}), HasSubstr("base"));
  EXPECT_THAT(message({{"conections", 4}}), HasSubstr("conections"));
  EXPECT_THAT(message({{"role", "client"}}), HasSubstr("role"));
  EXPECT_THAT(message({{"host_table", {"192.0.2.256"}}}), HasSubstr("192.0.2.256"));
  EXPECT_THAT(message({{"host_table", {"192.0.2"}}}), HasSubstr("no IPv4 address"));
  EXPECT_THAT(message({{"host_table", {"192.0.2.1.5"}}}), HasSubstr("no IPv4 address"));
  EXPECT_THAT(message({{"host_table", "192.0.2.1"}}), HasSubstr("no array"));
  EXPECT_THAT(message({{"host_table", json(17, "192.0.2.1")}}), HasSubstr("at most 16"));
  EXPECT_EQ(message({{"host_table", json(16, "192.0.2.1")}}), "made");
}

}  // namespace
}  // namespace fieldproof::xgt_fenet
