#include "src/modbus/frame.hpp"

#include <gtest/gtest.h>

#include "src/modbus/test_frames.hpp"
#include "src/plc/counters.hpp"

namespace fieldproof::modbus {
namespace {

using test::hex;
using test::operator+;

/// As published in introductions to Modbus: request and reply of each function code.
constexpr const char* published_rtu[] = {
    "01 03 00 00 00 0A C5 CD",
    "11 01 00 13 00 25 0E 84",
    "11 01 05 CD 6B B2 0E 1B 45 E6",
    "11 02 00 C4 00 16 BA A9",
    "11 02 03 AC DB 35 20 18",
    "11 03 00 6B 00 03 76 87",
    "11 03 06 AE 41 56 52 43 40 49 AD",
    "11 04 00 08 00 01 B2 98",
    "11 04 02 00 0A F8 F4",
    "11 05 00 AC FF 00 4E 8B",
    "11 06 00 01 00 03 9A 9B",
    "11 0F 00 13 00 0A 02 CD 01 BF 0B",
    "11 0F 00 13 00 0A 26 99",
    "11 10 00 01 00 02 04 00 0A 01 02 C6 F0",
    "11 10 00 01 00 02 12 98",
    "0A 81 02 B0 53",
};

TEST(RtuFrame, PublishedFrames) {
  for (const char* text : published_rtu) {
    const Bytes frame = hex(text);
    const ModbusFrame decoded = decode_modbus_frame(ModbusMode::rtu, frame);
    EXPECT_EQ(decoded.fault, plc::service_status::normal) << text;
    EXPECT_EQ(decoded.station, frame[0]) << text;
    EXPECT_EQ(to_hex(encode_modbus_frame(ModbusMode::rtu, decoded.station, decoded.pdu)), text);
  }
}

TEST(RtuFrame, EachFlippedBitIsAWrongCheck) {
  const Bytes frame = hex("11 03 00 6B 00 03 76 87");
  for (std::size_t bit = 0; bit < 8 * frame.size(); ++bit) {
    Bytes spoiled = frame;
    spoiled[bit / 8] = static_cast<Byte>(spoiled[bit / 8] ^ 1 << bit % 8);
    EXPECT_EQ(decode_modbus_frame(ModbusMode::rtu, spoiled).fault, plc::service_status::not_modbus)
        << bit;
  }
}

TEST(RtuFrame, LowByteOfTheCrcComesFirst) {
  EXPECT_EQ(decode_modbus_frame(ModbusMode::rtu, hex("11 03 00 6B 00 03 87 76")).fault,
            plc::service_status::not_modbus);
}

TEST(RtuFrame, ShortestIsStationFunctionAndCheck) {
  EXPECT_EQ(decode_modbus_frame(ModbusMode::rtu, hex("02 07 41 12")).pdu, hex("07"));
  for (const char* text : {"", "02", "02 07", "02 07 41", "FF FF",
                           "01 7E 80"}) {  // FF FF: CRC of nothing; 7E 80: of 01
    EXPECT_EQ(decode_modbus_frame(ModbusMode::rtu, hex(text)).fault,
              plc::service_status::not_modbus)
        << text;
  }
}

std::uint16_t ascii_fault(std::string_view text) {
  return decode_modbus_frame(ModbusMode::ascii, to_bytes(text)).fault;
}

TEST(AsciiFrame, PublishedFrame) {
  EXPECT_EQ(to_text(encode_modbus_frame(ModbusMode::ascii, 0x11, hex("03 00 6B 00 03"))),
            ":1103006B00037E\r\n");
  EXPECT_EQ(to_text(encode_modbus_frame(ModbusMode::ascii, 0x11, hex("03 06 AE 41 56 52 43 40"))),
            ":110306AE4156524340CC\r\n");
  const ModbusFrame decoded =
      decode_modbus_frame(ModbusMode::ascii, to_bytes(":1103006B00037E\r\n"));
  EXPECT_EQ(decoded.fault, plc::service_status::normal);
  EXPECT_EQ(decoded.station, 0x11);
  EXPECT_EQ(decoded.pdu, hex("03 00 6B 00 03"));
}

TEST(AsciiFrame, HexInEitherCase) {
  EXPECT_EQ(decode_modbus_frame(ModbusMode::ascii, to_bytes(":1103006b00037e\r\n")).pdu,
            hex("03 00 6B 00 03"));
}

TEST(AsciiFrame, Faults) {
  EXPECT_EQ(ascii_fault(":1103006B00037F\r\n"), plc::service_status::not_modbus);  // LRC
  EXPECT_EQ(ascii_fault(":1103006B00037\r\n"), plc::service_status::not_hex);      // odd
  EXPECT_EQ(ascii_fault(":1103006B0003G7E\r\n"), plc::service_status::not_hex);
  EXPECT_EQ(ascii_fault(":11 3006B00037E\r\n"), plc::service_status::not_hex);
  EXPECT_EQ(ascii_fault(":1103 006B00037E\r\n"), plc::service_status::not_hex);
  EXPECT_EQ(ascii_fault(":1103006B00037E\n"), plc::service_status::not_modbus);
  EXPECT_EQ(ascii_fault(":1103006B00037E\r"), plc::service_status::not_modbus);
  EXPECT_EQ(ascii_fault("1103006B00037E\r\n"), plc::service_status::not_modbus);
}

TEST(AsciiFrame, ShortestIsStationFunctionAndCheck) {
  EXPECT_EQ(ascii_fault(":1107E8\r\n"), plc::service_status::normal);
  for (const char* text : {"", ":", ":\r", ":\r\n", ":00\r\n", ":11EF\r\n"}) {
    EXPECT_EQ(ascii_fault(text), plc::service_status::not_modbus) << text;
  }
}

TEST(ModbusFrames, LongestHoldsALongestPdu) {
  const Bytes pdu(modbus_max_pdu, 0x5A);
  EXPECT_EQ(encode_modbus_frame(ModbusMode::rtu, 1, pdu).size(), 256u);
  EXPECT_EQ(encode_modbus_frame(ModbusMode::ascii, 1, pdu).size(), 513u);
}

}  // namespace
}  // namespace fieldproof::modbus
