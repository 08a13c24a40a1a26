#include "src/modbus/checks.hpp"

#include <gtest/gtest.h>

#include "src/modbus/test_frames.hpp"

namespace fieldproof::modbus {
namespace {

using test::hex;

// The check value of CRC-16/MODBUS in the catalogues of CRCs.
TEST(ModbusCrc, CatalogueValue) { EXPECT_EQ(modbus_crc(to_bytes("123456789")), 0x4B37); }

// Station 02, function 07: the worked example of 'MODBUS over Serial Line' V1.02, appendix B.
TEST(ModbusCrc, SerialLineGuide) { EXPECT_EQ(modbus_crc(hex("02 07")), 0x1241); }

TEST(ModbusCrc, OfNothingIsTheStartValue) { EXPECT_EQ(modbus_crc({}), 0xFFFF); }

TEST(ModbusCrc, BehindItsOwnBytesIsZero) { EXPECT_EQ(modbus_crc(hex("01 04 02 FF FF B8 80")), 0); }

TEST(ModbusLrc, TwosComplementOfTheSum) {
  EXPECT_EQ(modbus_lrc(hex("11 03 00 6B 00 03")), 0x7E);
  EXPECT_EQ(modbus_lrc(hex("FF 01")), 0x00);
  EXPECT_EQ(modbus_lrc(hex("80")), 0x80);
}

}  // namespace
}  // namespace fieldproof::modbus
