#include "src/xnet/plc.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <set>

#include "src/modbus/test_frames.hpp"
#include "src/net/network.hpp"

namespace fieldproof::xnet {
namespace {

using modbus::ModbusMode;
using modbus::test::hex;
using nlohmann::json;
using ::testing::HasSubstr;

TEST(Areas, NamesAreLettersAndANumber) {
  const auto number = [](std::string_view name) {
    const auto component = find_component(name);
    return component ? static_cast<int>(component->number) : -1;
  };
  EXPECT_EQ(number("D100"), 100);
  EXPECT_EQ(number("HD0"), 0);
  EXPECT_EQ(number("hscd39"), 39);
  EXPECT_EQ(number("X17"), 15);  // octal
  EXPECT_EQ(number("Y77"), 63);
  for (const std::string_view wrong :
       {"", "D", "100", "D70000", "X8", "X100", "ZZ1", "D-1", "D1.0", "HSCD40", "%D1"})
    EXPECT_EQ(number(wrong), -1) << wrong;
  EXPECT_EQ(to_string(*find_component("x17")), "X17");
  EXPECT_EQ(to_string(*find_component("hd05")), "HD5");
}

TEST(Areas, AsModbusShowsThem) {
  const auto at = [](bool bits, std::uint32_t address) {
    const auto component = component_at(bits, address);
    return component ? to_string(*component) : "";
  };
  EXPECT_EQ(at(false, 0x0000), "D0");
  EXPECT_EQ(at(false, 0x4FFF), "D20479");
  EXPECT_EQ(at(false, 0x5000), "");
  EXPECT_EQ(at(false, 0x7005), "SD5");
  EXPECT_EQ(at(false, 0xA080), "HD0");
  EXPECT_EQ(at(false, 0xB87F), "HD6143");
  EXPECT_EQ(at(false, 0xB880), "HSD0");
  EXPECT_EQ(at(true, 0x0000), "M0");
  EXPECT_EQ(at(true, 0x5000), "X0");
  EXPECT_EQ(at(true, 0x500F), "X17");
  EXPECT_EQ(at(true, 0x6008), "Y10");
  EXPECT_EQ(at(true, 0xC100), "HM0");
  EXPECT_EQ(at(true, 0xFFFF), "");
}

TEST(Areas, DoNotOverlap) {
  for (const Area& one : areas()) {
    EXPECT_LE(one.shown, one.size) << one.name;
    for (const Area& other : areas()) {
      if (one.name == other.name || one.bits != other.bits || one.modbus > other.modbus) continue;
      EXPECT_LE(one.modbus + one.shown, other.modbus) << one.name << ' ' << other.name;
    }
  }
}

TEST(XnetMemory, TheBackDoor) {
  Memory memory;
  ASSERT_TRUE(memory.set("D69998", "12345ABC"));
  EXPECT_EQ(*memory.get("D69999", 0), "5ABC");
  EXPECT_EQ(*memory.get("D69998", 8), "12345ABC");
  ASSERT_TRUE(memory.set("X17", "0101"));
  EXPECT_EQ(*memory.get("X16", 8), "00010100");
  EXPECT_EQ(*memory.get("Y17", 0), "00");
  EXPECT_THAT(memory.set("D69999", "12345ABC").error().message, HasSubstr("D ends at D69999"));
  EXPECT_THAT(memory.set("D0", "123").error().message, HasSubstr("give 4 digits for each"));
  EXPECT_THAT(memory.set("M0", "02").error().message, HasSubstr("a bit is 00 or 01"));
  EXPECT_THAT(memory.set("D0", "12G4").error().message, HasSubstr("'G' is not a hex digit"));
  EXPECT_THAT(memory.set("D0", "").error().message, HasSubstr("there is no value"));
  EXPECT_THAT(memory.get("X8", 0).error().message, HasSubstr("cannot get X8"));
}

class Xinje : public testing::Test {
 protected:
  explicit Xinje(const json& config = json::object()) {
    Result<std::unique_ptr<plc::EmulatedDevice>> made = make_xinje_plc(ModbusMode::tcp, config);
    if (!made) throw std::runtime_error(made.error().message);
    plc = std::move(*made);
    network.attach(*plc->network());
    link = network.open(Transport::tcp, 502);
  }
  /// The PDU of the reply.
  std::string ask(std::string_view pdu) {
    const Bytes body = hex(pdu);
    Bytes frame = hex("00 01 00 00" + hex_number(body.size() + 1, 4) + "01");
    frame.insert(frame.end(), body.begin(), body.end());
    EXPECT_TRUE(network.send(link, frame));
    const Burst reply = network.receive(network.now() + 1s);
    return reply.bytes.size() < 7 ? "" : to_hex(ByteView(reply.bytes).subspan(7));
  }
  std::unique_ptr<plc::EmulatedDevice> plc;
  net::SimulatedNetwork network;
  LinkId link = 0;
};

TEST_F(Xinje, ServesItsMemory) {
  ASSERT_TRUE(plc->set("D10", "12345ABC"));
  ASSERT_TRUE(plc->set("X17", "01"));
  EXPECT_EQ(ask("03 00 0A 00 02"), "03 04 12 34 5A BC");
  EXPECT_EQ(ask("04 00 0A 00 02"), "04 04 12 34 5A BC");
  EXPECT_EQ(ask("01 50 0F 00 02"), "01 01 01");
  EXPECT_EQ(ask("02 50 08 00 08"), "02 01 80");
  EXPECT_EQ(ask("06 A0 80 5A BC"), "06 A0 80 5A BC");
  EXPECT_EQ(*plc->get("HD0", 0), "5ABC");
  EXPECT_EQ(ask("0F 60 08 00 03 01 05"), "0F 60 08 00 03");
  EXPECT_EQ(*plc->get("Y10", 6), "010001");
}

TEST_F(Xinje, AnAccessLiesInsideOneArea) {
  EXPECT_EQ(ask("03 B8 7F 00 02"), "83 02");
  EXPECT_EQ(ask("03 B8 7F 00 01"), "03 02 00 00");
  EXPECT_EQ(ask("01 50 3F 00 02"), "81 02");
  EXPECT_EQ(ask("03 5F FF 00 01"), "83 02");
}

TEST_F(Xinje, TheFifthConnectionIsReset) {
  for (int i = 0; i < 4; ++i) network.open(Transport::tcp, 502);
  const Burst fifth = network.receive(1s);
  EXPECT_EQ(fifth.event, LinkEvent::reset);
  EXPECT_EQ(fifth.link, 5u);
}

TEST_F(Xinje, NoWaitingTimeIsPrinted) {
  const Burst burst = network.receive(24h);
  EXPECT_EQ(burst.event, LinkEvent::data);
  EXPECT_TRUE(burst.bytes.empty());
}

TEST(XinjeRtu, ServesTheSameMemoryOnItsLine) {
  const auto made = make_xinje_plc(ModbusMode::rtu, {{"station", 1}});
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ((*made)->network(), nullptr);
  line::Device& line = *(*made)->line();
  line.receive({modbus::test::rtu("01 06 00 0A 5A BC"), 0ms, 1ms});
  EXPECT_EQ(line.advance(*line.wake_at()), modbus::test::rtu("01 06 00 0A 5A BC"));
  EXPECT_EQ(*(*made)->get("D10", 0), "5ABC");
}

TEST(MakeXinje, ErrorsNameTheKey) {
  const auto error = [](const json& config) {
    const auto plc = make_xinje_plc(ModbusMode::tcp, config);
    return plc ? "" : plc.error().message;
  };
  EXPECT_THAT(error({{"role", "client"}}), HasSubstr("no Modbus TCP client"));
  EXPECT_THAT(error({{"bit_read_base", "M0"}}), HasSubstr("there is no key 'bit_read_base'"));
  EXPECT_THAT(error({{"connections", 9}}), HasSubstr("connections is 9"));
  EXPECT_THAT(error({{"mode", "pause"}}), HasSubstr("mode is 'pause'"));
}

}  // namespace
}  // namespace fieldproof::xnet
