#include "src/modbus/bases.hpp"

#include <gmock/gmock.h>

namespace fieldproof::modbus {
namespace {

using ::testing::HasSubstr;

const plc::PlcModel& model(std::string_view name) { return *plc::find_plc_model(name); }

/// A base as a device name: area, element index and size of its table.
struct Placed {
  char area;
  std::uint32_t index, size;
  bool operator==(const Placed&) const = default;
  friend void PrintTo(const Placed& p, std::ostream* out) {
    *out << p.area << ' ' << p.index << " size " << p.size;
  }
};

Result<ModbusTables> tables(std::string_view name, ModbusBase base, const std::string& text) {
  ModbusBases bases = default_modbus_bases(model(name));
  bases[static_cast<std::size_t>(base)] = text;
  return place_modbus_tables(model(name), bases);
}

Placed placed(std::string_view name, ModbusBase base, const std::string& text) {
  const Result<ModbusTables> all = tables(name, base, text);
  if (!all) {
    ADD_FAILURE() << all.error().message;
    return {};
  }
  const ModbusTable& table = (*all)[base];
  return {model(name).areas[table.first.area].letter, table.first.index, table.size};
}

std::string error_of(std::string_view name, ModbusBase base, const std::string& text) {
  const Result<ModbusTables> all = tables(name, base, text);
  return all ? "" : all.error().message;
}

constexpr auto bit_read = ModbusBase::bit_read, bit_write = ModbusBase::bit_write,
               word_read = ModbusBase::word_read, word_write = ModbusBase::word_write;

TEST(ModbusBases, Defaults) {
  EXPECT_EQ(default_modbus_bases(model("xbc-h")), (ModbusBases{"P0", "M0", "P0", "M0"}));
  EXPECT_EQ(default_modbus_bases(model("xbm-s")), (ModbusBases{"P0", "M0", "P0", "M0"}));
  EXPECT_EQ(default_modbus_bases(model("xec-h")), (ModbusBases{"I0", "M0", "I0", "M0"}));
  for (const plc::PlcModel& m : plc::plc_models())
    EXPECT_TRUE(place_modbus_tables(m, default_modbus_bases(m))) << m.name;
}

// Figure 6.1.2 (Cnet EN), and Cnet KO 11.3.1: 'P00110: bit 0 of word P11'.
TEST(ModbusBases, AsInTheDialog) {
  EXPECT_EQ(placed("xbc-h", bit_read, "P0000"), (Placed{'P', 0, 9999}));
  EXPECT_EQ(placed("xbc-h", bit_write, "P0100"), (Placed{'P', 10 * 16, 9999}));
  EXPECT_EQ(placed("xbc-h", word_read, "P020"), (Placed{'P', 20, 1024 - 20}));
  EXPECT_EQ(placed("xbc-h", word_write, "P030"), (Placed{'P', 30, 1024 - 30}));
  EXPECT_EQ(placed("xbc-h", bit_read, "P00110"), (Placed{'P', 11 * 16, 9999}));
  EXPECT_EQ(placed("xbc-h", bit_read, "M0001A"), (Placed{'M', 26, 9999}));
  EXPECT_EQ(placed("xbc-h", word_write, "D00000"), (Placed{'D', 0, 9999}));
}

TEST(ModbusBases, PercentAndTypeMayBeThere) {
  for (const char* text : {"M0010", "%M0010", "MX0010", "%MX0010", "m0010", "%mx0010"}) {
    EXPECT_EQ(placed("xbc-h", bit_write, text), (Placed{'M', 16, 9999})) << text;
  }
  for (const char* text : {"M0010", "%MW0010", "mw10"}) {
    EXPECT_EQ(placed("xbc-h", word_write, text), (Placed{'M', 10, 1014})) << text;
  }
}

TEST(ModbusBases, XecIsFlatOrDotted) {
  EXPECT_EQ(placed("xec-h", bit_read, "%IX5"), (Placed{'I', 5, 9999}));
  EXPECT_EQ(placed("xec-h", bit_read, "IX0.0.5"), (Placed{'I', 5, 9999}));
  EXPECT_EQ(placed("xec-h", bit_write, "%MX160"), (Placed{'M', 160, 9999}));
  EXPECT_EQ(placed("xec-h", bit_read, "Q16000"), (Placed{'Q', 16000, 384}));
  EXPECT_EQ(placed("xec-h", word_read, "%IW0.1.0"), (Placed{'I', 4, 1020}));
  EXPECT_EQ(placed("xec-h", word_write, "WW100"), (Placed{'W', 100, 9999}));  // the area called W
}

TEST(ModbusBases, TableEndsAt9998OrWithItsArea) {
  EXPECT_EQ(placed("xbm-s", bit_read, "P0"), (Placed{'P', 0, 128 * 16}));
  EXPECT_EQ(placed("xbm-s", bit_write, "M255F"), (Placed{'M', 4095, 1}));
  EXPECT_EQ(placed("xbm-s", word_write, "D5119"), (Placed{'D', 5119, 1}));
  EXPECT_EQ(placed("xbc-h", word_write, "D241"), (Placed{'D', 241, 9999}));
  EXPECT_EQ(placed("xbc-h", word_write, "D242"), (Placed{'D', 242, 9998}));
  EXPECT_EQ(placed("xbc-h", bit_read, "P03990"), (Placed{'P', 399 * 16, 9999}));
  EXPECT_EQ(placed("xbc-h", bit_read, "P04000"), (Placed{'P', 6400, 9984}));
  EXPECT_EQ(placed("xbc-h", bit_read, "T100"), (Placed{'T', 100, 924}));  // contacts
}

TEST(ModbusBases, ErrorsNameTheBase) {
  EXPECT_EQ(error_of("xbc-h", bit_read, "Z0"),
            "cannot place bit_read_base 'Z0' on xbc-h: the model has no such area; give a bit "
            "address such as M0010");
  EXPECT_EQ(error_of("xbm-s", word_write, "M256"),
            "cannot place word_write_base 'M256' on xbm-s: it is beyond the area; give a word "
            "address such as M001");
  EXPECT_THAT(error_of("xbm-s", bit_write, "M2560"), HasSubstr("bit_write_base 'M2560'"));
  EXPECT_THAT(error_of("xbc-h", word_read, "PX10"), HasSubstr("not a number"));
  EXPECT_THAT(error_of("xbc-h", bit_read, "PW10"), HasSubstr("not a number"));
  EXPECT_THAT(error_of("xbc-h", bit_read, "D0"),
              HasSubstr("the type is not one that the area has"));
  EXPECT_THAT(error_of("xec-h", bit_read, "P0"), HasSubstr("no such area"));
  EXPECT_THAT(error_of("xbc-h", word_read, "I0"), HasSubstr("no such area"));
  for (const char* text : {"", "%", "P", "PX", "100", "P-1", "P1 "})
    EXPECT_NE(error_of("xbc-h", bit_read, text), "") << text;
}

}  // namespace
}  // namespace fieldproof::modbus
