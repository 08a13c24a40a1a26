#include "src/udata/port.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "src/line/line.hpp"

namespace fieldproof::udata {
namespace {

using nlohmann::json;

constexpr const char* mk = R"j([
  {"instruction": "SNDUDATA", "request": "%MX00100", "slot": 1, "channel": 2, "data": "%DW100", "size": "%DW90", "info": "%DW200"},
  {"instruction": "RCVUDATA", "request": "%MX00101", "slot": 1, "channel": 2, "data": "%DW300", "size": "%DW91", "info": "%DW210"},
  {"instruction": "SENDDTR", "request": "%MX00102", "slot": 1, "channel": 2, "value": "%DW92", "info": "%DW220"},
  {"instruction": "SENDRTS", "request": "%MX00103", "slot": 1, "channel": 2, "value": 1, "info": "%DW230"},
  {"instruction": "SNDUDATA", "request": "%MX00104", "slot": 3, "channel": 2, "data": "%DW100", "size": 1, "info": "%DW240"}
])j";

/// A port at the other end of a simulated line.
class Port {
 public:
  explicit Port(json config = json::object(), const char* instructions = mk,
                std::string_view model = "xbc-h") {
    config["instructions"] = json::parse(instructions);
    auto made = make_udata_port(model, config);
    if (!made) throw std::runtime_error(made.error().message);
    device_ = std::move(*made);
    line_.attach(*device_->line(), {});
  }

  void set(std::string_view address, std::string_view hex) {
    ASSERT_TRUE(device_->set(address, hex));
  }
  std::string get(std::string_view address, std::size_t digits = 0) const {
    return *device_->get(address, digits);
  }
  void act(std::string_view action) { ASSERT_TRUE(device_->act(action)); }
  /// A rising edge of M10 bit `bit`.
  void request(unsigned bit) {
    const std::string address = "%MX0010" + std::to_string(bit);
    set(address, "00");
    set(address, "01");
  }
  void send(std::string_view text) { line_.transmit(to_bytes(text)); }
  std::string hear(Duration patience = 100ms) {
    const Time until = line_.now() + patience;
    Bytes heard;
    for (Burst burst = line_.receive(until); !burst.bytes.empty(); burst = line_.receive(until))
      heard.insert(heard.end(), burst.bytes.begin(), burst.bytes.end());
    return to_text(heard);
  }

 private:
  line::SimulatedLine line_{line::LineSettings{}};
  std::unique_ptr<plc::EmulatedDevice> device_;
};

TEST(UdataPort, SendsOnTheRisingEdgeAlone) {
  Port port;
  port.set("%DW90", "0004");
  port.set("%DW100", "42414443");
  EXPECT_EQ(port.get("%DW200"), "0000");
  port.set("%MX00100", "01");
  EXPECT_EQ(port.hear(), "ABCD");
  EXPECT_EQ(port.get("%DW200", 16), "0001000000000000");
  port.set("%MX00100", "01");
  port.set("%MX00100", "00");
  EXPECT_EQ(port.hear(), "");
  port.set("%MX00100", "01");
  EXPECT_EQ(port.hear(), "ABCD");
}

TEST(UdataPort, SendsNothingWhereItFails) {
  Port port;
  port.request(0);
  EXPECT_EQ(port.hear(), "");
  EXPECT_EQ(port.get("%DW200"), "0004");
  EXPECT_EQ(port.get("@services"), "0000");
}

TEST(UdataPort, SetsF110WhereNoModuleIs) {
  Port port;
  port.request(4);
  EXPECT_EQ(port.get("%DW240"), "0002");
  EXPECT_EQ(port.get("%FX0110"), "01");
  port.request(1);  // finds the module, and no data: no such error
  EXPECT_EQ(port.get("%FX0110"), "00");
}

TEST(UdataPort, HandsOverOneDatumARequest) {
  Port port;
  port.send("OK");
  port.hear();
  port.send("$006");
  port.hear();
  port.request(1);
  EXPECT_EQ(port.get("%DB600", 8), "4F4B0000");
  EXPECT_EQ(port.get("%DW91"), "0002");
  EXPECT_EQ(port.get("%DW210"), "0001");
  port.request(1);
  EXPECT_EQ(port.get("%DB600", 8), "24303036");
  EXPECT_EQ(port.get("%DW91"), "0004");
  port.request(1);
  EXPECT_EQ(port.get("%DW210"), "0004");
  EXPECT_EQ(port.get("%DB600", 8), "24303036");
}

TEST(UdataPort, ADatumIsNoneBeforeTheLineIsSilent) {
  Port port;
  port.send("O");
  port.hear(1ms);  // a gap below 3.5 characters
  port.send("K");
  port.request(1);
  EXPECT_EQ(port.get("%DW210"), "0004");
  port.hear();
  port.request(1);
  EXPECT_EQ(port.get("%DB600", 4), "4F4B");
}

TEST(UdataPort, TheInterCharacterTimeEndsADatum) {
  Port port(json{{"inter_character_ms", 50}});
  port.send("O");
  port.hear(40ms);
  port.send("K");
  port.hear(60ms);
  port.request(1);
  EXPECT_EQ(port.get("%DW91"), "0002");
}

TEST(UdataPort, ADatumIsAtMost1024Bytes) {
  Port port;
  port.send(std::string(1025, 'x'));
  port.hear();
  port.request(1);
  EXPECT_EQ(port.get("%DW91"), "0400");
  port.request(1);
  EXPECT_EQ(port.get("%DW91"), "0001");
}

TEST(UdataPort, WhatNobodyTakesIsLostAtLast) {
  Port port;
  for (int i = 0; i < 17; ++i) {
    port.send(std::string(1, static_cast<char>('a' + i)));
    port.hear(10ms);
  }
  EXPECT_EQ(port.get("@errors"), "0001");
  for (int i = 0; i < 16; ++i) port.request(1);
  EXPECT_EQ(port.get("%DB600"), "70");  // 'p', the sixteenth
  port.request(1);
  EXPECT_EQ(port.get("%DW210"), "0004");
}

TEST(UdataPort, MovesTheControlLines) {
  Port port;
  EXPECT_EQ(port.get("@dtr") + port.get("@rts"), "0000");
  port.set("%DW92", "0001");
  port.request(2);
  EXPECT_EQ(port.get("@dtr") + port.get("@rts"), "0100");
  port.request(3);
  port.set("%DW92", "0000");
  port.request(2);
  EXPECT_EQ(port.get("@dtr") + port.get("@rts"), "0001");
  port.set("%DW92", "0002");
  port.request(2);
  EXPECT_EQ(port.get("%DW220"), "0004");
  port.act("power_cycle");
  EXPECT_EQ(port.get("@rts"), "00");
}

TEST(UdataPort, AHungModuleIsGivenOneSecond) {
  Port port(json{{"module_hangs", true}});
  port.set("%DW90", "0004");
  port.hear(3s);
  port.request(0);
  port.hear(999ms);
  EXPECT_EQ(port.get("%DW200"), "0000");
  EXPECT_EQ(port.hear(2ms), "");
  EXPECT_EQ(port.get("%DW200"), "0006");
  port.request(1);
  EXPECT_EQ(port.get("%DW210"), "0004") << "reception has no time-out";
}

TEST(UdataPort, RestsInStop) {
  Port port(json{{"mode", "stop"}});
  port.set("%DW90", "0001");
  port.request(0);
  port.send("lost");
  port.hear();
  port.act("run");
  EXPECT_EQ(port.hear(), "") << "no edge while it was in STOP";
  port.request(1);
  EXPECT_EQ(port.get("%DW210"), "0004");
  port.request(0);
  EXPECT_EQ(port.hear().size(), 1u);
}

TEST(UdataPort, WithoutLinkNothingIsReceived) {
  Port port(json{{"link", false}});
  port.send("OK");
  port.hear();
  port.request(1);
  EXPECT_EQ(port.get("%DW210"), "0005");
  EXPECT_EQ(port.get("@services"), "0000");
}

TEST(UdataPort, VersionsOfBuiltInChannelsDoNotMatter) {
  constexpr const char* sending =
      R"j([{"instruction": "SNDUDATA", "request": "%MX00100", "slot": 0, "channel": 1, "data": "%DW100", "size": 1, "info": "%DW200"}])j";
  Port built_in(json{{"module", "built-in"}, {"version", "1.0"}}, sending);
  built_in.request(0);
  EXPECT_EQ(built_in.get("%DW200"), "0001");
  for (const auto& [version, status] : {std::pair{"1.3", "0007"},
                                        {"V1.39", "0007"},
                                        {"1.4", "0001"},
                                        {"V1.40", "0001"},
                                        {"2.0", "0001"}}) {
    Port port(json{{"version", version}});
    port.set("%DW90", "0001");
    port.request(0);
    EXPECT_EQ(port.get("%DW200"), status) << version;
  }
}

constexpr const char* iec = R"j([
  {"instruction": "SEND_UDATA", "request": "%MX0", "slot": 1, "channel": 2, "data": "%MB200", "size": 3, "done": "%MX1", "status": "%MW20"},
  {"instruction": "RCV_UDATA", "request": "%MX1", "base": 0, "slot": 1, "channel": 2, "data": "%MB2000", "size": "%MW22", "done": "%MX2", "status": "%MW21"},
  {"instruction": "SEND_DTR", "request": "%MX3", "slot": 9, "channel": 2, "value": 1, "done": "%MX4", "status": "%MW23"}
])j";

TEST(UdataPort, IecHasDoneAndStat) {
  Port port(json::object(), iec, "xec-h");
  port.set("%MB200", "414243");
  port.set("%MX3", "01");
  EXPECT_EQ(port.get("%MW23") + port.get("%MX4"), "000200");
  EXPECT_EQ(port.get("%FX176"), "00") << "F110 is a flag of MK";
  port.send("OK");
  port.hear();
  port.set("%MX0", "01");
  EXPECT_EQ(port.hear(), "ABC");
  EXPECT_EQ(port.get("%MW20") + port.get("%MX1"), "000101");
  EXPECT_EQ(port.get("%MW21") + port.get("%MX2"), "000101") << "DONE of one is REQ of the next";
  EXPECT_EQ(port.get("%MB2000", 4) + port.get("%MW22"), "4F4B0002");
}

}  // namespace
}  // namespace fieldproof::udata
