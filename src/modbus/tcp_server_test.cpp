#include "src/modbus/tcp_server.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "src/modbus/modbus_plc.hpp"
#include "src/modbus/test_frames.hpp"
#include "src/net/network.hpp"

namespace fieldproof::modbus {
namespace {

using nlohmann::json;
using test::hex;
using test::operator+;
using ::testing::HasSubstr;

class TcpServer : public testing::Test {
 protected:
  void make(const json& config, const net::Conditions& conditions = {}) {
    Result<std::unique_ptr<plc::EmulatedDevice>> made =
        make_modbus_plc(ModbusMode::tcp, "xbc-h", config);
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
  LinkId open() { return network().open(Transport::tcp, 502); }
  void send(LinkId link, const Bytes& bytes) { ASSERT_TRUE(network().send(link, bytes)); }
  void send(LinkId link, std::string_view bytes) { send(link, hex(bytes)); }

  /// What comes next: "1: 00 01 ...", "1: FIN", "1: RST"; "" until then.
  std::string heard(Duration within = 1s) {
    const Burst burst = network().receive(network().now() + within);
    const std::string link = std::to_string(burst.link) + ": ";
    switch (burst.event) {
      case LinkEvent::closed: return link + "FIN";
      case LinkEvent::reset: return link + "RST";
      default: return burst.bytes.empty() ? "" : link + to_hex(burst.bytes);
    }
  }
  std::string ask(LinkId link, std::string_view bytes) {
    send(link, bytes);
    return heard();
  }
  std::string counters() {
    return *plc().get("@services", 0) + ' ' + *plc().get("@errors", 0) + ' ' +
           *plc().get("@status", 0);
  }

 private:
  std::unique_ptr<plc::EmulatedDevice> plc_;
  std::optional<net::SimulatedNetwork> network_;
};

// The PDUs are those of FEnet EN 5.3.5, tables 5-23, 5-27, 5-35, 5-39 and 5-43.
TEST_F(TcpServer, AnswersThePrintedExamples) {
  ASSERT_TRUE(plc().set("%MW107", "022B00000064"));
  ASSERT_TRUE(plc().set("%PW8", "000A"));
  const LinkId link = open();
  EXPECT_EQ(ask(link, "00 01 00 00 00 06 01 03 00 6B 00 03"),
            "1: 00 01 00 00 00 09 01 03 06 02 2B 00 00 00 64");
  EXPECT_EQ(ask(link, "00 02 00 00 00 06 01 04 00 08 00 01"),
            "1: 00 02 00 00 00 05 01 04 02 00 0A");
  EXPECT_EQ(ask(link, "00 03 00 00 00 09 01 0F 00 13 00 0A 02 CD 01"),
            "1: 00 03 00 00 00 06 01 0F 00 13 00 0A");
  EXPECT_EQ(ask(link, "00 04 00 00 00 06 01 06 00 01 00 03"),
            "1: 00 04 00 00 00 06 01 06 00 01 00 03");
  EXPECT_EQ(ask(link, "00 05 00 00 00 0B 01 10 00 01 00 02 04 00 0A 01 02"),
            "1: 00 05 00 00 00 06 01 10 00 01 00 02");
  EXPECT_EQ(*plc().get("%MW1", 8), "000A0102");
  EXPECT_EQ(counters(), "0005 0000 00");
}

TEST_F(TcpServer, CopiesTransactionAndUnit) {
  const LinkId link = open();
  for (const std::string_view unit : {"00", "01", "11", "FF"})
    EXPECT_EQ(ask(link, "FE DC 00 00 00 06" + std::string(unit) + "03 00 00 00 01"),
              "1: FE DC 00 00 00 05 " + std::string(unit) + " 03 02 00 00");
}

TEST_F(TcpServer, RepliesAtTheMomentOfTheRequest) {
  make(json::object(), {.delay = 3ms});
  const LinkId link = open();
  send(link, "00 01 00 00 00 06 01 03 00 00 00 01");
  EXPECT_EQ(network().receive(1s).start, 6ms);
}

TEST_F(TcpServer, WritesUpTo123Words) {
  const LinkId link = open();
  const auto write = [&](unsigned words) {
    const Bytes pdu = hex("10 00 00" + hex_number(words, 4) + hex_number(2 * words, 2)) +
                      Bytes(std::size_t{2} * words, 0x11);
    send(link, hex("00 01 00 00" + hex_number(pdu.size() + 1, 4) + "01") + pdu);
    return heard();
  };
  EXPECT_EQ(write(123), "1: 00 01 00 00 00 06 01 10 00 00 00 7B");
  EXPECT_EQ(*plc().get("%MW122", 8), "11110000");
  EXPECT_EQ(write(124), "1: 00 01 00 00 00 03 01 90 03");
}

TEST_F(TcpServer, RequestsThatComeTogetherAreAnsweredInOrder) {
  const LinkId link = open();
  send(link, "00 07 00 00 00 06 01 06 00 00 12 34 00 08 00 00 00 06 01 03 00 00 00 01");
  EXPECT_EQ(heard(), "1: 00 07 00 00 00 06 01 06 00 00 12 34");
  EXPECT_EQ(heard(), "1: 00 08 00 00 00 05 01 03 02 12 34");
}

TEST_F(TcpServer, ARequestMayComeInAnyPiecesAtAnyTime) {
  const Bytes request = hex("00 01 00 00 00 06 01 03 00 00 00 01");
  const LinkId link = open();
  for (const Byte b : request) {
    EXPECT_EQ(heard(5s), "");
    send(link, Bytes{b});
  }
  EXPECT_EQ(heard(), "1: 00 01 00 00 00 05 01 03 02 00 00");
}

TEST_F(TcpServer, AnswersWhateverTheNetworkMakesOfTheSegments) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    make(json::object(), {.seed = seed, .delay = 1ms, .jitter = 10ms, .cut = 0.3, .join = 0.7});
    const LinkId a = open(), b = open();
    std::map<LinkId, Bytes> got;
    for (unsigned i = 0; i < 20; ++i)
      for (const LinkId link : {a, b})
        send(link, "00" + hex_number(i, 2) + "00 00 00 06 01 06 00 00" + hex_number(link, 4));
    for (;;) {
      const Burst burst = network().receive(network().now() + 1s);
      if (burst.bytes.empty()) break;
      got[burst.link].insert(got[burst.link].end(), burst.bytes.begin(), burst.bytes.end());
    }
    for (const LinkId link : {a, b}) {
      Bytes expected;
      for (unsigned i = 0; i < 20; ++i)
        expected = expected +
                   hex("00" + hex_number(i, 2) + "00 00 00 06 01 06 00 00" + hex_number(link, 4));
      EXPECT_EQ(got[link], expected) << seed;
    }
  }
}

TEST_F(TcpServer, AnotherProtocolDrawsNoAnswerAndTheStreamGoesOn) {
  const LinkId link = open();
  send(link, "00 01 00 01 00 06 01 06 00 00 12 34");
  EXPECT_EQ(heard(), "");
  EXPECT_EQ(counters(), "0000 0001 0C");
  EXPECT_EQ(ask(link, "00 02 00 00 00 06 01 03 00 00 00 01"),
            "1: 00 02 00 00 00 05 01 03 02 00 00");
}

TEST_F(TcpServer, ALengthThatThePduContradictsIsException03) {
  const LinkId link = open();
  EXPECT_EQ(ask(link, "00 01 00 00 00 07 01 03 00 00 00 01 00"), "1: 00 01 00 00 00 03 01 83 03");
  EXPECT_EQ(ask(link, "00 01 00 00 00 05 01 03 00 00 00"), "1: 00 01 00 00 00 03 01 83 03");
  EXPECT_EQ(ask(link, "00 01 00 00 00 02 01 03"), "1: 00 01 00 00 00 03 01 83 03");
  send(link, hex("00 01 00 00 00 FE 01 03") + Bytes(252, 0));
  EXPECT_EQ(heard(), "1: 00 01 00 00 00 03 01 83 03");
  send(link, hex("00 01 00 00 01 04 01 03") + Bytes(258, 0));
  EXPECT_EQ(heard(), "1: 00 01 00 00 00 03 01 83 03");
}

TEST_F(TcpServer, ALengthThatNoFrameHasEndsTheConnection) {
  for (const std::string_view length : {"00 00", "00 01", "01 05", "FF FF"}) {
    make(json::object());
    const LinkId link = open(), other = open();
    EXPECT_EQ(ask(link, "00 01 00 00" + std::string(length)), "1: RST") << length;
    EXPECT_EQ(ask(other, "00 02 00 00 00 06 01 03 00 00 00 01"),
              "2: 00 02 00 00 00 05 01 03 02 00 00");
  }
}

TEST_F(TcpServer, TheFifthConnectionIsResetAndTheOthersDoNotNotice) {
  std::vector<LinkId> links;
  for (int i = 0; i < 4; ++i) links.push_back(open());
  EXPECT_EQ(heard(), "");
  open();
  EXPECT_EQ(heard(), "5: RST");
  for (const LinkId link : links)
    EXPECT_EQ(ask(link, "00 02 00 00 00 06 01 03 00 00 00 01"),
              std::to_string(link) + ": 00 02 00 00 00 05 01 03 02 00 00");
}

TEST_F(TcpServer, TheNumberOfConnectionsIsASetting) {
  make({{"connections", 1}});
  open();
  open();
  EXPECT_EQ(heard(), "2: RST");
}

TEST_F(TcpServer, AClientThatClosesGetsRstAndFreesItsConnection) {
  make({{"connections", 1}});
  const LinkId link = open();
  send(link, "00 01 00 00 00 06 01 06 00 00 12");  // and no more
  ASSERT_TRUE(network().close(link, Closing::fin));
  EXPECT_EQ(heard(), "1: RST");
  EXPECT_EQ(*plc().get("%MW0", 0), "0000");
  EXPECT_EQ(ask(open(), "00 02 00 00 00 06 01 03 00 00 00 01"),
            "2: 00 02 00 00 00 05 01 03 02 00 00");
}

TEST_F(TcpServer, AClientThatClosesBehindItsRequestIsAnswered) {
  make(json::object(), {.delay = 1ms});
  const LinkId link = open();
  send(link, "00 01 00 00 00 06 01 03 00 00 00 01");
  ASSERT_TRUE(network().close(link, Closing::fin));
  EXPECT_EQ(heard(), "1: 00 01 00 00 00 05 01 03 02 00 00");
  EXPECT_EQ(heard(), "1: RST");
}

TEST_F(TcpServer, ResetFreesTheConnection) {
  make({{"connections", 1}});
  ASSERT_TRUE(network().close(open(), Closing::rst));
  EXPECT_EQ(ask(open(), "00 02 00 00 00 06 01 03 00 00 00 01"),
            "2: 00 02 00 00 00 05 01 03 02 00 00");
}

TEST_F(TcpServer, AVanishedClientKeepsItsConnectionForTheWaitingTime) {
  make({{"connections", 1}, {"waiting_time", 10}});
  const LinkId first = open();
  EXPECT_EQ(ask(first, "00 02 00 00 00 06 01 03 00 00 00 01"),
            "1: 00 02 00 00 00 05 01 03 02 00 00");
  ASSERT_TRUE(network().close(first, Closing::vanish));
  (void)network().receive(9999ms);
  open();
  EXPECT_EQ(heard(0s), "2: RST");
  (void)network().receive(10s);
  EXPECT_EQ(ask(open(), "00 02 00 00 00 06 01 03 00 00 00 01"),
            "3: 00 02 00 00 00 05 01 03 02 00 00");
}

TEST_F(TcpServer, EachRequestRestartsTheWaitingTime) {
  const LinkId link = open();
  (void)network().receive(60s);
  send(link, "00 02 00 00 00 06 01 03 00 00 00 01");
  (void)heard();
  send(link, "00 02 00 00");  // no request
  EXPECT_EQ(network().receive(160s - 1ns).event, LinkEvent::data);
  EXPECT_EQ(heard(1ns), "1: RST");
  EXPECT_EQ(network().now(), 160s);
}

TEST_F(TcpServer, APowerCycleForgetsConnections) {
  const LinkId link = open();
  (void)ask(link, "00 02 00 00 00 06 01 06 00 00 12 34");
  ASSERT_TRUE(plc().act("power_cycle"));
  EXPECT_EQ(counters(), "0000 0000 00");
  EXPECT_EQ(ask(link, "00 02 00 00 00 06 01 03 00 00 00 01"), "1: RST");
  EXPECT_EQ(ask(open(), "00 02 00 00 00 06 01 03 00 00 00 01"),
            "2: 00 02 00 00 00 05 01 03 02 12 34");
}

TEST_F(TcpServer, AnswersInStop) {
  make({{"mode", "stop"}});
  EXPECT_EQ(ask(open(), "00 02 00 00 00 06 01 03 00 00 00 01"),
            "1: 00 02 00 00 00 05 01 03 02 00 00");
}

TEST_F(TcpServer, UsesTheBases) {
  make({{"word_write_base", "D10"}});
  ASSERT_TRUE(plc().set("%DW11", "5ABC"));
  EXPECT_EQ(ask(open(), "00 02 00 00 00 06 01 03 00 01 00 01"),
            "1: 00 02 00 00 00 05 01 03 02 5A BC");
}

TEST(TcpServerConfig, ErrorsNameTheKey) {
  const auto error = [](const json& config) {
    const auto plc = make_modbus_plc(ModbusMode::tcp, "xbc-h", config);
    return plc ? "" : plc.error().message;
  };
  EXPECT_THAT(error({{"connections", 5}}), HasSubstr("connections is 5, which is not a number"));
  EXPECT_THAT(error({{"connections", 0}}), HasSubstr("connections is 0; give 1 to 4"));
  EXPECT_THAT(error({{"waiting_time", 1}}), HasSubstr("waiting_time is 1; give 2 to 255 seconds"));
  EXPECT_THAT(error({{"line", "9600"}}), HasSubstr("there is no key 'line'"));
  EXPECT_THAT(error({{"role", "client"}}), HasSubstr("role client"));
  EXPECT_THAT(error({{"bit_read_base", "Z0"}}), HasSubstr("bit_read_base"));
}

}  // namespace
}  // namespace fieldproof::modbus
