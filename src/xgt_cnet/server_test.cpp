#include "src/xgt_cnet/server.hpp"

#include <gtest/gtest.h>

#include <random>

#include "src/xgt_cnet/test_frames.hpp"

namespace fieldproof::xgt_cnet {
namespace {

using test::character;
using test::enq;
using test::gap;
using test::shown;
using test::operator+;

/// A server of one model; each request goes out after a second of silence.
struct ServerBench {
  explicit ServerBench(std::string_view model = "xbc-h", unsigned station = 1, Duration delay = {})
      : memory(*plc::find_plc_model(model)), server(memory, station, gap, delay) {}

  /// The reply to raw bytes, as text.
  std::string send(const Bytes& bytes) {
    now += 1s;
    server.receive({bytes, now, character});
    now += character * static_cast<int>(bytes.size());
    return shown(server.advance(now));
  }
  std::string ask(std::string_view body) { return send(enq(body)); }

  void set(std::string_view address, std::string_view hex) {
    const Status status = plc::set_by_name(memory, address, hex);
    ASSERT_TRUE(status) << status.error().message;
  }
  std::string get(std::string_view address, std::size_t digits = 0) {
    const Result<std::string> value = plc::get_by_name(memory, address, digits);
    return value ? *value : value.error().message;
  }

  plc::PlcMemory memory;
  XgtServer server;
  Time now{};
};

std::string repeated(std::string_view text, int times) {
  std::string all;
  while (times-- > 0) all += text;
  return all;
}

// --- The manual's examples, byte for byte (Cnet EN 7.1.5) ---

std::string exchange(unsigned station,
                     const std::vector<std::pair<std::string, std::string>>& memory,
                     std::string_view request) {
  ServerBench bench("xbc-h", station);
  for (const auto& [address, hex] : memory) bench.set(address, hex);
  const Bytes bytes = *from_hex(request);
  bench.server.receive({bytes, 0ms, character});
  return to_hex(bench.server.advance(character * static_cast<int>(bytes.size())));
}

TEST(XgtServerManual, ReadOfTwoWords) {
  EXPECT_EQ(
      exchange(1, {{"%MW20", "1234"}, {"%PW1", "5678"}},
               "05 30 31 72 53 53 30 32 30 36 25 4D 57 30 32 30 30 36 25 50 57 30 30 31 04 36 38"),
      "06 30 31 72 53 53 30 32 30 32 31 32 33 34 30 32 35 36 37 38 03 34 43");
}

TEST(XgtServerManual, ReadOfOneWord) {
  EXPECT_EQ(exchange(0x20, {{"%MW100", "A9F3"}},
                     "05 32 30 72 53 53 30 31 30 36 25 4D 57 31 30 30 04 41 34"),
            "06 32 30 72 53 53 30 31 30 32 41 39 46 33 03 33 39");
}

TEST(XgtServerManual, ContinuousRead) {
  EXPECT_EQ(exchange(0x0A, {{"%MW0", "12345678"}},
                     "05 30 41 72 53 42 30 36 25 4D 57 30 30 30 30 32 04 41 32"),
            "06 30 41 72 53 42 30 31 30 34 31 32 33 34 35 36 37 38 03 45 41");
}

TEST(XgtServerManual, Writes) {
  EXPECT_EQ(
      exchange(0x20, {}, "05 32 30 77 53 53 30 31 30 36 25 4D 57 31 30 30 30 30 45 32 04 38 30"),
      "06 32 30 77 53 53 03 38 38");
  EXPECT_EQ(exchange(1, {}, "05 30 31 57 53 53 30 31 30 36 25 4D 57 32 33 30 30 30 46 46 04"),
            "06 30 31 57 53 53 03");
  EXPECT_EQ(
      exchange(0x10, {},
               "05 31 30 77 53 42 30 36 25 4D 57 31 30 30 30 32 31 31 31 31 32 32 32 32 04 32 34"),
      "06 31 30 77 53 42 03 37 36");
  EXPECT_EQ(exchange(1, {}, "05 30 31 77 53 42 30 36 25 44 57 30 30 30 30 31 41 41 31 35 04 37 35"),
            "06 30 31 77 53 42 03 37 36");
}

TEST(XgtServerManual, RegistrationAndExecution) {
  ServerBench bench;
  const auto wire = [&bench](std::string_view hex) {
    const Bytes bytes = *from_hex(hex);
    bench.now += 1s;
    bench.server.receive({bytes, bench.now, character});
    bench.now += 1s;
    return to_hex(bench.server.advance(bench.now));
  };
  EXPECT_EQ(wire("05 30 31 78 30 31 52 53 53 30 31 30 36 25 4D 57 30 30 30 04 35 42"),
            "06 30 31 78 30 31 03 34 33");
  bench.set("%MW0", "2342");
  EXPECT_EQ(wire("05 30 31 79 30 31 04 34 34"),
            "06 30 31 79 30 31 30 31 30 32 32 33 34 32 03 44 32");
}

TEST(XgtServerManual, RefusalOfAnArea) {
  EXPECT_EQ(exchange(0x20, {}, "05 32 30 72 53 53 30 31 30 36 25 5A 57 31 30 30 04 42 31"),
            "15 32 30 72 53 53 31 31 33 32 03 35 39");
}

// --- Services ---

TEST(XgtServer, ReadsEveryType) {
  ServerBench b;
  b.set("%MW100", "123456789ABCDEF0");
  EXPECT_EQ(b.ask("01RSS0107%MX1002"), "ACK 01RSS010101");
  EXPECT_EQ(b.ask("01RSS0107%MX1003"), "ACK 01RSS010100");
  EXPECT_EQ(b.ask("01RSS0106%MB201"), "ACK 01RSS010112");
  EXPECT_EQ(b.ask("01RSS0106%MW100"), "ACK 01RSS01021234");
  EXPECT_EQ(b.ask("01RSS0105%MD50"), "ACK 01RSS010456781234");
  EXPECT_EQ(b.ask("01RSS0105%ML25"), "ACK 01RSS0108DEF09ABC56781234");
  EXPECT_EQ(b.ask("01RSB06%MB20004"), "ACK 01RSB010434127856");
  EXPECT_EQ(b.ask("01RSB06%MW10002"), "ACK 01RSB010412345678");
  EXPECT_EQ(b.ask("01RSB05%MD5002"), "ACK 01RSB010856781234DEF09ABC");
  EXPECT_EQ(b.ask("01RSB05%ML2501"), "ACK 01RSB0108DEF09ABC56781234");
}

TEST(XgtServer, WritesEveryType) {
  ServerBench b;
  EXPECT_EQ(b.ask("01WSS0108%MX0010A01"), "ACK 01WSS");
  EXPECT_EQ(b.get("%MW10"), "0400");
  EXPECT_EQ(b.ask("01WSS0105%MB205A"), "ACK 01WSS");
  EXPECT_EQ(b.get("%MW10"), "045A");
  EXPECT_EQ(b.ask("01WSS0105%MW101234"), "ACK 01WSS");
  EXPECT_EQ(b.get("%MW10"), "1234");
  EXPECT_EQ(b.ask("01WSS0105%MD10"
                  "CAFEBABE"),
            "ACK 01WSS");
  EXPECT_EQ(b.get("%MW20", 8), "BABECAFE");
  EXPECT_EQ(b.ask("01WSS0105%ML100123456789ABCDEF"), "ACK 01WSS");
  EXPECT_EQ(b.get("%MW40", 16), "CDEF89AB45670123");
  EXPECT_EQ(b.ask("01WSB06%MB10003A1B2C3"), "ACK 01WSB");
  EXPECT_EQ(b.get("%MW50", 8), "B2A100C3");
  EXPECT_EQ(b.ask("01WSB05%MD60021234567889ABCDEF"), "ACK 01WSB");
  EXPECT_EQ(b.get("%MW120", 16), "56781234CDEF89AB");
  EXPECT_EQ(b.ask("01WSB06%MW13002"
                  "1a2B3c4D"),
            "ACK 01WSB");
  EXPECT_EQ(b.get("%MW129", 16), "00001A2B3C4D0000");
}

TEST(XgtServer, WriteIsAllOrNothing) {
  ServerBench b;
  EXPECT_EQ(b.ask("01WSS0205%MW10111105%MW1122223"), "NAK 01WSS1234");
  EXPECT_EQ(b.ask("01WSS0205%MW10111107%MW10242222"), "NAK 01WSS7132");
  EXPECT_EQ(b.ask("01WSS0205%MW10111105%MW1122G2"), "NAK 01WSS1432");
  EXPECT_EQ(b.ask("01WSS0205%MX100105%MX1102"), "NAK 01WSS0011");
  EXPECT_EQ(b.get("%MW10"), "0000");
  EXPECT_EQ(b.get("%MW1"), "0000");
}

TEST(XgtServer, LimitsOfBlocksAndNames) {
  ServerBench b;
  b.set("%MW0", "1234");
  EXPECT_EQ(b.ask("01rSS10" + repeated("04%MW0", 16)), "ACK 01rSS10" + repeated("021234", 16));
  EXPECT_EQ(b.ask("01rSS11" + repeated("04%MW0", 17)), "NAK 01rSS0003");
  EXPECT_EQ(b.ask("01rSS0110%MW0000000000000"), "ACK 01rSS01021234");
  EXPECT_EQ(b.ask("01rSS0111%MW00000000000000"), "NAK 01rSS0004");
  EXPECT_EQ(b.ask("01rSS0100"), "NAK 01rSS0004");
  EXPECT_EQ(b.ask("01rSB10%MW000000000000001"), "ACK 01rSB01021234");
  EXPECT_EQ(b.ask("01rSB11%MW0000000000000001"), "NAK 01rSB0004");
  EXPECT_EQ(b.ask("01rSS10" + repeated("10%ML0000000000000", 16)),
            "ACK 01rSS10" + repeated("080000000000001234", 16));
}

TEST(XgtServer, LimitsOfRuns) {
  ServerBench b;
  b.set("%MW59", "5A5B");
  const auto data_size = [&](std::string_view body) { return b.ask(body).size(); };
  const std::size_t whole = std::string("ACK 01RSB0178").size() + 240;
  EXPECT_EQ(data_size("01RSB04%MW03C"), whole);
  EXPECT_EQ(data_size("01RSB04%MB078"), whole);
  EXPECT_EQ(data_size("01RSB04%MD01E"), whole);
  EXPECT_EQ(data_size("01RSB04%ML00F"), whole);
  EXPECT_EQ(b.ask("01RSB04%MW03C").substr(0, 13), "ACK 01RSB0178");
  EXPECT_EQ(b.ask("01RSB04%MW03C").substr(whole - 4), "5A5B");
  EXPECT_EQ(b.ask("01RSB04%MW03D"), "NAK 01RSB1232");
  EXPECT_EQ(b.ask("01RSB04%MB079"), "NAK 01RSB1232");
  EXPECT_EQ(b.ask("01RSB04%MD01F"), "NAK 01RSB1232");
  EXPECT_EQ(b.ask("01RSB04%ML010"), "NAK 01RSB1232");
  EXPECT_EQ(b.ask("01wSB04%MW03C" + repeated("A55A", 60)),
            "ACK 01wSB");  // 260 bytes: longer than the stated 256
  EXPECT_EQ(b.get("%MW59"), "A55A");
  EXPECT_EQ(b.get("%MW60"), "0000");
  EXPECT_EQ(b.ask("01wSB04%MW03D" + repeated("A55A", 61)), "NAK 01wSB1232");
  EXPECT_EQ(b.ask("01wSB04%MB078" + repeated("12", 120)), "ACK 01wSB");
  EXPECT_EQ(b.ask("01wSB04%MB079" + repeated("12", 121)), "NAK 01wSB1232");
}

TEST(XgtServer, AllStations) {
  for (unsigned station = 0; station < 256; ++station) {
    ServerBench b("xbc-h", station);
    const std::string st = hex_number(station, 2), other = hex_number((station + 1) & 0xFF, 2);
    EXPECT_EQ(b.ask(st + "wSS0104%MW01234"), "ACK " + st + "wSS");
    EXPECT_EQ(b.ask(other + "wSS0104%MW05678"), "");
    EXPECT_EQ(b.get("%MW0"), "1234");
    EXPECT_EQ(b.server.counters().status, plc::service_status::station);
  }
}

TEST(XgtServer, LetterCase) {
  ServerBench b("xbc-h", 0x1F);
  b.set("%MW100", "ABCD");
  EXPECT_EQ(b.ask("1Frss0106%mw100"), "ACK 1Frss0102ABCD");
  EXPECT_EQ(b.ask("1fRsB06%Mw10001"),
            "ACK 1FRsB0102ABCD");  // the station in the reply is its own, in upper case
  EXPECT_EQ(b.ask("1FX0arss0106%mw100"), "ACK 1FX0A");
  EXPECT_EQ(b.ask("1Fy0A"), "ACK 1Fy0A0102ABCD");
  EXPECT_EQ(b.ask("1Fwss0106%mw100abcd"), "ACK 1Fwss");
}

// --- Errors of Appendix 3.1 ---

struct Refused {
  const char* body;
  const char* code;
};

TEST(XgtServerErrors, EveryCode) {
  const Refused cases[] = {
      {"01rSS1105%MW10", "0003"},
      {"01rSS0111%MW00000000000010", "0004"},
      {"01rSS0105%MK10", "0007"},
      {"01rSS0106%DX100", "0007"},
      {"01rSB05%MX1001", "0007"},
      {"01wSB05%MX100100", "0007"},
      {"01rSS0105$MW10", "0011"},
      {"01rSS0105MW010", "0011"},
      {"01rSS0105MW0", "0011"},
      {"01rSS0105%MW^&", "0011"},
      {"01rSS0105%MWM", "0011"},
      {"01rSS0104%MWM", "0011"},
      {"01rSB05%MW10%4", "0011"},
      {"01rSB05%MW1000", "0011"},
      {"01wSS0105%MX1011", "0011"},
      {"01wSS0105%MX1002", "0011"},
      {"01rSS0005%MW10", "0011"},
      {"01rSS0205%MW10", "0011"},
      {"01rSS0105%IW10", "1132"},
      {"01rSS0105%^W10", "1132"},
      {"01wSS0105%FW101234", "1132"},
      {"01wSS0105%NW101234", "1132"},
      {"01wSB05%FW10011234", "1132"},
      {"01wSS0105%FX1001", "1132"},
      {"01rSS0101%", "1132"},
      {"01rSS0102%M", "0007"},
      {"01rSS0103%MW", "0011"},
      {"01wSB05%MW1040AA5512", "1232"},
      {"01rSS0105%MW10000", "1234"},
      {"01rSB05%MW10020", "1234"},
      {"01wSB05%MW100112345", "1234"},
      {"01rSS0205%MW1005%MB10", "1332"},
      {"01rSS0207%MX000005%MW10", "1332"},
      {"01wSS0105%MW10AA%5", "1432"},
      {"01wSB05%MW1001AA%5", "1432"},
      {"01rSS0108%MWFFFFF", "7132"},
      {"01rSS0106%MW00A", "7132"},
      {"01rSS0107%MW1024", "7132"},
      {"01rSB07%MW102302", "7132"},
      {"01wSB07%MW10230211112222", "7132"},
  };
  for (const Refused& c : cases) {
    ServerBench b;
    const std::string body = c.body;
    EXPECT_EQ(b.ask(body), "NAK " + body.substr(0, 5) + c.code) << body;
    std::string upper = body;
    upper[2] = static_cast<char>(upper[2] - 'a' + 'A');
    EXPECT_EQ(b.ask(upper), "NAK " + upper.substr(0, 5) + c.code) << upper;
    EXPECT_EQ(b.get("%MW10"), "0000") << body;
    EXPECT_EQ(b.server.counters().services, 2u) << body;
    EXPECT_EQ(b.server.counters().errors, 0u) << body;
  }
}

/// Two faults in one request, each pair one step of the order of checks.
TEST(XgtServerErrors, OrderOfChecks) {
  const Refused cases[] = {
      {"01RSS1111%MW00000000000000", "0003"},     // block count before name length
      {"01RSS0111$MW00000000000000", "0004"},     // name length before %
      {"01RSS0105$ZW10", "0011"},                 // % before area
      {"01RSS0105%ZK10", "1132"},                 // area before type
      {"01RSS0205%MK1005%MW10", "0007"},          // type before equal types
      {"01RSS0205%MW1005%MB^^", "1332"},          // equal types before form
      {"01RSB05%MW^^3D", "0011"},                 // form before count
      {"01RSB07%MW10233D", "1232"},               // count before range
      {"01WSS0107%MW1024XXXX", "7132"},           // range before data digits
      {"01WSS0207%MX10000G07%MX100102", "1432"},  // data digits before bit value
      {"01WSS0107%MX1000021", "0011"},            // bit value before surplus
      {"01RSS0207%MW102404%ZW0", "1132"},  // each check goes over all blocks before the next one
  };
  for (const Refused& c : cases) {
    ServerBench b;
    EXPECT_EQ(b.ask(c.body), std::string("NAK ") + std::string(c.body).substr(0, 5) + c.code)
        << c.body;
  }
}

TEST(XgtServerErrors, FAndNCanBeReadAndMonitored) {
  ServerBench b;
  b.set("%FW10", "1234");
  b.set("%NW10", "5678");
  EXPECT_EQ(b.ask("01RSS0205%FW1005%NW10"), "ACK 01RSS02021234025678");
  EXPECT_EQ(b.ask("01X00RSS0205%FW1005%NW10"), "ACK 01X00");
  EXPECT_EQ(b.ask("01Y00"), "ACK 01Y0002021234025678");
}

TEST(XgtServerErrors, LastAndFirstInvalidOfEveryAreaInEveryModel) {
  for (const plc::PlcModel& model : plc::plc_models()) {
    ServerBench b(model.name);
    for (const plc::DeviceArea& area : model.areas) {
      for (const char type : {'B', 'W', 'D', 'L'}) {
        const std::uint32_t elements = area.words * 2 / plc::type_bytes(type);
        const auto named = [&](std::uint32_t index) {
          const std::string name = std::string{'%', area.letter, type} + std::to_string(index);
          return hex_number(name.size(), 2) + name;
        };
        const std::string value(2 * plc::type_bytes(type), '7');
        EXPECT_EQ(b.ask("01RSS01" + named(elements - 1)).substr(0, 9), "ACK 01RSS")
            << model.name << named(elements - 1);
        EXPECT_EQ(b.ask("01RSS01" + named(elements)), "NAK 01RSS7132")
            << model.name << named(elements);
        EXPECT_EQ(b.ask("01RSB" + named(elements - 1) + "02"), "NAK 01RSB7132")
            << model.name << named(elements - 1);
        EXPECT_EQ(b.ask("01WSS01" + named(elements - 1) + value),
                  area.write ? "ACK 01WSS" : "NAK 01WSS1132")
            << model.name << area.letter;
      }
    }
  }
}

// --- Monitor ---

TEST(XgtServerMonitor, SixteenRegistrationsReplacedAndExecuted) {
  ServerBench b;
  for (unsigned i = 0; i < 16; ++i) {
    const std::string number = hex_number(i, 2);
    b.set("%MW" + std::to_string(i), hex_number(0x1000 + i, 4));
    EXPECT_EQ(b.ask("01x" + number + "RSS0105%MW" + (i < 10 ? "0" : "") + std::to_string(i)),
              "ACK 01x" + number);
  }
  for (unsigned i = 0; i < 16; ++i) {
    const std::string number = hex_number(i, 2);
    EXPECT_EQ(b.ask("01y" + number), "ACK 01y" + number + "0102" + hex_number(0x1000 + i, 4));
  }
  EXPECT_EQ(b.ask("01x03RSB04%MW0021"), "NAK 01x031234");
  EXPECT_EQ(b.ask("01y03"), "ACK 01y0301021003");  // a refused X leaves the earlier registration
  EXPECT_EQ(b.ask("01x03RSB04%MW102"), "ACK 01x03");
  EXPECT_EQ(b.ask("01y03"), "ACK 01y030410011002");  // SB: byte count and data, no block count
}

TEST(XgtServerMonitor, ReadsTheValueOfTheMoment) {
  ServerBench b;
  EXPECT_EQ(b.ask("01X09RSS0204%MB104%PB1"), "ACK 01X09");
  b.set("%MW0", "1200");
  b.set("%PW0", "3400");
  EXPECT_EQ(b.ask("01Y09"), "ACK 01Y090201120134");
  b.set("%PW0", "5600");
  EXPECT_EQ(b.ask("01Y09"), "ACK 01Y090201120156");
}

TEST(XgtServerMonitor, Refusals) {
  const Refused cases[] = {
      {"01x10RSS0104%MW0", "0290"},
      {"01xFFRSS0104%MW0", "0290"},
      {"01x0GRSS0104%MW0", "0290"},
      {"01x10RSS1104%MW0", "0290"},
      {"01x00WSS0104%MW0", "0011"},
      {"01x00", "0011"},
      {"01x00RSD0104%MW0", "0011"},
      {"01x00RSS1104%MW0", "0003"},
      {"01x00RSS0104%ZW0", "1132"},
      {"01x00RSB04%MX001", "0007"},
      {"01x00RSB04%MW03D", "1232"},
      {"01x00RSS0107%MW1024", "7132"},
      {"01x00RSS0104%MW00", "1234"},
      {"01x00RSB07%MW102302", "7132"},
      {"01y10", "0190"},
      {"01yFF", "0190"},
      {"01y0G", "0190"},
      {"01y00", "0090"},
      {"01y0000", "0090"},
      {"01y10"
       "00",
       "0190"},
  };
  for (const Refused& c : cases) {
    ServerBench b;
    const std::string body = c.body;
    EXPECT_EQ(b.ask(body), "NAK " + body.substr(0, 5) + c.code) << body;
    EXPECT_EQ(b.ask("01y00"), "NAK 01y000090") << body;
  }
}

TEST(XgtServerMonitor, SurplusAndNumbersCutShort) {
  ServerBench b;
  EXPECT_EQ(b.ask("01x00RSS0104%MW0"), "ACK 01x00");
  EXPECT_EQ(b.ask("01y0000"), "NAK 01y001234");
  EXPECT_EQ(b.ask("01x"), "NAK 01x000290");
  EXPECT_EQ(b.ask("01y0"), "NAK 01y000190");
  EXPECT_EQ(b.ask("01xffRSS0104%MW0"), "NAK 01xFF0290");
  EXPECT_EQ(b.ask("01Y\x03"
                  "2"),
            "NAK 01Y020190");  // a control character in the reply would break its form
}

TEST(XgtServerMonitor, RegistrationsAreVolatile) {
  ServerBench b;
  b.ask("01x00RSS0104%MW0");
  b.set("%MW0", "1234");
  b.server.power_cycle();
  EXPECT_EQ(b.ask("01y00"), "NAK 01y000090");
  EXPECT_EQ(b.get("%MW0"), "1234");
}

TEST(XgtServerMonitor, RegistrationOfBitsContactsAndDottedNames) {
  ServerBench b("xec-h");
  b.set("%IW0.1.0", "0002");
  EXPECT_EQ(b.ask("01x00RSS0208%IX0.1.104%QX0"), "ACK 01x00");
  EXPECT_EQ(b.ask("01y00"), "ACK 01y000201010100");
  EXPECT_EQ(b.ask("01x01RSB08%IW0.1.002"), "ACK 01x01");
  EXPECT_EQ(b.ask("01y01"), "ACK 01y010400020000");
}

// --- Silence and status by service ---

TEST(XgtServerStatus, SilenceIsCounted) {
  ServerBench b;
  Bytes wrong_bcc = enq("01rSS0104%MW0");
  wrong_bcc.back() ^= 1;
  const auto expect = [&b](std::uint16_t status, std::uint32_t errors, std::uint32_t services) {
    EXPECT_EQ(b.server.counters().status, status);
    EXPECT_EQ(b.server.counters().errors, errors);
    EXPECT_EQ(b.server.counters().services, services);
  };
  EXPECT_EQ(b.send(wrong_bcc), "");
  expect(3, 1, 0);
  EXPECT_EQ(b.ask("01RSS0104%MW0"), "ACK 01RSS01020000");
  expect(0, 1, 1);
  EXPECT_EQ(b.ask("02rSS0104%MW0"), "");
  expect(9, 2, 1);
  EXPECT_EQ(b.ask("G1RSS0104%MW0"), "");
  expect(9, 3, 1);
  EXPECT_EQ(b.send(to_bytes("01RSS0104%MW0\x04")), "");
  expect(1, 4, 1);
  EXPECT_EQ(b.ask("01QSS0104%MW0"), "");
  expect(1, 5, 1);
  EXPECT_EQ(b.ask("01RSD0104%MW0"), "");
  expect(1, 6, 1);
  EXPECT_EQ(b.ask("01R"), "");
  expect(1, 7, 1);
  EXPECT_EQ(b.send(to_bytes("\x05"
                            "01RSS0104%MW0")),
            "");
  expect(1, 7, 1);  // it may still go on
  ASSERT_TRUE(b.server.wake_at());
  EXPECT_TRUE(b.server.advance(*b.server.wake_at()).empty());
  expect(2, 8, 1);
  EXPECT_EQ(b.send(to_bytes("\x05\x04")), "");
  expect(9, 9, 1);
  b.server.power_cycle();
  expect(0, 0, 0);
}

TEST(XgtServerStatus, WrongBccOfAnotherStationIsABccError) {
  ServerBench b;
  Bytes bytes = enq("02rSS0104%MW0");
  bytes.back() ^= 1;
  EXPECT_EQ(b.send(bytes), "");
  EXPECT_EQ(b.server.counters().status, plc::service_status::bcc);
}

TEST(XgtServerStatus, BccAfterAnUpperCaseCommandIsNoPartOfTheFrame) {
  ServerBench b;
  EXPECT_EQ(b.send(enq("01RSS0104%MW0") + to_bytes("20")), "ACK 01RSS01020000");
  EXPECT_EQ(b.server.counters().status, plc::service_status::head);
}

// --- Time ---

TEST(XgtServerTime, ReplyGoesOutAtTheEndOfTheRequest) {
  ServerBench b;
  const Bytes request = enq("01RSS0104%MW0");
  b.server.receive({request + to_bytes("\r\n"), 10ms, character});
  EXPECT_EQ(b.server.wake_at(), 10ms + character * static_cast<int>(request.size()));
}

TEST(XgtServerTime, DelayIsAddedToTheEndOfTheRequest) {
  ServerBench b("xbc-h", 1, 50ms);
  const Bytes request = enq("01RSS0104%MW0");
  b.server.receive({request, 10ms, character});
  const Time due = 10ms + character * static_cast<int>(request.size()) + 50ms;
  EXPECT_EQ(b.server.wake_at(), due);
  EXPECT_TRUE(b.server.advance(due - 1ns).empty());
  EXPECT_EQ(shown(b.server.advance(due)), "ACK 01RSS01020000");
  EXPECT_EQ(b.server.wake_at(), std::nullopt);
}

TEST(XgtServerTime, TwoRequestsBackToBackAreBothAnsweredInOrder) {
  ServerBench b;
  b.set("%MW0", "12345678");
  b.server.receive({enq("01rSS0104%MW0") + enq("01RSS0104%MW1"), 0ms, character});
  EXPECT_EQ(shown(b.server.advance(1s)), "ACK 01rSS01021234");
  ASSERT_TRUE(b.server.wake_at());
  EXPECT_EQ(shown(b.server.advance(1s)), "ACK 01RSS01025678");
  EXPECT_EQ(b.server.wake_at(), std::nullopt);
}

TEST(XgtServerTime, NoWireTime) {
  ServerBench b;
  b.server.receive({enq("01rSS0104%MW0"), 5ms, 0ms});
  EXPECT_EQ(b.server.wake_at(), 5ms);
  EXPECT_EQ(shown(b.server.advance(5ms)), "ACK 01rSS01020000");
}

TEST(XgtServerFuzz, RandomBytesAlwaysLeaveAServerThatAnswers) {
  std::mt19937 random(2014);
  constexpr std::string_view likely =
      "\x05\x05\x04\x04"
      "0101rRwWxXyYSSSBRSSRSB%MWXBDL0123456789ABCDEF.";
  ServerBench b("xec-h");
  for (int i = 0; i < 50'000; ++i) {
    Bytes bytes(random() % 60);
    for (Byte& byte : bytes)
      byte = random() % 16 == 0 ? static_cast<Byte>(random())
                                : static_cast<Byte>(likely[random() % likely.size()]);
    if (random() % 2)
      bytes = to_bytes(
                  "\x05"
                  "01") +
              bytes + to_bytes("\x04");
    b.now += random() % 2 ? Duration(1ms) : Duration(1s);
    b.server.receive({bytes, b.now, character});
    b.now += character * static_cast<int>(bytes.size());
    while (b.server.wake_at() && *b.server.wake_at() <= b.now) b.server.advance(b.now);
    if (i % 100 != 0) continue;
    ASSERT_EQ(b.ask("01RSS0104%FW0"), "ACK 01RSS01020000") << i;
  }
  EXPECT_GT(b.server.counters().services, 1000u);
}

/// Like the fuzz loop, but of requests that are nearly right: one byte of a good frame is changed.
TEST(XgtServerFuzz, NearlyRightRequestsAreAnsweredInOneForm) {
  std::mt19937 random(7);
  const std::string bodies[] = {"01RSS0206%MW02006%PW001",
                                "01WSS0205%MX100105%MX1100",
                                "01RSB06%MW00010",
                                "01WSB06%DW00002AA15BB26",
                                "01X01RSS0106%MW000",
                                "01X02RSB06%MB00010",
                                "01Y01",
                                "01Y02"};
  ServerBench b;
  int answered = 0;
  for (int i = 0; i < 50'000; ++i) {
    std::string body = bodies[random() % std::size(bodies)];
    body[random() % body.size()] = static_cast<char>(random());
    if (body.find_first_of("\x04\x05") != std::string::npos) continue;
    const std::string reply = b.ask(body);
    if (reply.empty()) continue;
    ++answered;
    ASSERT_TRUE(reply.starts_with("ACK 01") || reply.starts_with("NAK 01")) << reply;
    ASSERT_EQ(reply[6], body[2]) << reply;
  }
  EXPECT_GT(answered, 10'000);
}

}  // namespace
}  // namespace fieldproof::xgt_cnet
