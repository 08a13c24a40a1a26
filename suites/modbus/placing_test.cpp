#include "suites/modbus/placing.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace fieldproof::modbus_suite {
namespace {

using nlohmann::json;
using testing::HasSubstr;

Bases bases(const json& config) { return *declared_bases("xbc-h", config); }
Bytes request(std::string_view message) { return rtu_framing().wrap(*from_hex(message)); }

std::string where(const json& config, std::string_view address, std::string_view hex,
                  const std::vector<Bytes>& requests) {
  const auto found = placed(rtu_framing(), bases(config), address, hex, requests);
  return found ? found->address + " = " + found->hex : found.error().message;
}

const Bytes write_coil = request("01 05 00 13 FF 00"), read_coils = request("01 01 00 13 00 01"),
            write_register = request("01 06 00 64 12 34"),
            write_same_word = request("01 06 00 01 12 34");

TEST(Placing, ByDefaultEverythingIsWhereTheVectorHasIt) {
  EXPECT_EQ(where(json::object(), "%MW1", "0008", {write_coil}), "%MW1 = 0008");
}

TEST(Placing, MemoryMovesWithTheBaseOfTheTableThatIsAsked) {
  const json bits_in_p{{"bit_write_base", "P0"}};
  EXPECT_EQ(where(bits_in_p, "%MW1", "0008", {write_coil}), "%PB2 = 0800")
      << "words of P are for reading alone";
  EXPECT_EQ(where(bits_in_p, "%MX00013", "01", {write_coil, read_coils}), "%PX00013 = 01");
  EXPECT_EQ(where(bits_in_p, "%MW100", "1234", {write_register}), "%MW100 = 1234");
  EXPECT_EQ(where(bits_in_p, "%DW100", "1234", {write_register}), "%DW100 = 1234")
      << "out of reach";
}

/// The dialog as 6.1.3 shows it: bits from M0000, words from D0000.
TEST(Placing, WordsMayBeginElsewhere) {
  EXPECT_EQ(where({{"word_write_base", "D0000"}}, "%MW100", "1234", {write_register}),
            "%DW100 = 1234");
  EXPECT_EQ(where({{"word_write_base", "D0010"}}, "%MW100", "1234", {write_register}),
            "%DW110 = 1234");
  EXPECT_EQ(where({{"word_write_base", "D1000"}}, "%MW1", "1234", {write_same_word}),
            "%DW1001 = 1234")
      << "in as many digits as it takes";
  EXPECT_THAT(where({{"word_write_base", "M1023"}}, "%MW1", "1234", {write_same_word}),
              HasSubstr("no such place behind the declared word_write_base"));
}

TEST(Placing, WhatTwoTablesHoldMustStayTogether) {
  EXPECT_THAT(where({{"bit_write_base", "P0"}}, "%MW1", "0008", {write_coil, write_same_word}),
              HasSubstr("reaches %MW1 by two tables, which the declared bases put apart"));
  EXPECT_EQ(where({{"bit_write_base", "P0"}, {"word_write_base", "P0"}}, "%MW1", "0008",
                  {write_coil, write_same_word}),
            "%PW1 = 0008");
  EXPECT_EQ(where({{"bit_write_base", "P0"}}, "%MW100", "1234", {write_coil, write_register}),
            "%MW100 = 1234")
      << "only the register is there";
  EXPECT_THAT(where({{"bit_write_base", "P3"}}, "%MW1", "0008", {write_coil}),
              HasSubstr("no such place behind the declared bit_write_base"));
}

TEST(Placing, WhereTablesAreSeparateBitsAreReachedByBits) {
  const json separate{{"tables", "separate"}};
  EXPECT_EQ(where(separate, "%MW1", "1234", {write_coil}), "%MB2 = 3412");
  EXPECT_EQ(where(separate, "%MW100", "1234", {write_register}), "%MW100 = 1234");
  EXPECT_THAT(where(separate, "%MW1", "1234", {write_coil, write_same_word}),
              HasSubstr("by bits and by words; the profile declares separate tables"));
  EXPECT_THAT(where(separate, "%MX00013", "01", {write_register}),
              HasSubstr("needs %MX00013 to be read and written by both"));
}

TEST(Placing, WhereTablesAreSeparateNothingSetsInputs) {
  const json separate{{"tables", "separate"}, {"bit_read_base", "M0"}, {"word_read_base", "M0"}};
  const Bytes read_inputs = request("01 02 00 13 00 01"),
              read_input_register = request("01 04 00 64 00 01");
  EXPECT_THAT(where(separate, "%PX00013", "01", {read_inputs}),
              HasSubstr("read as inputs, and no function code writes them"));
  EXPECT_THAT(where(separate, "%PW100", "1234", {read_input_register}),
              HasSubstr("read as input registers, and no function code writes them"));
}

TEST(Placing, TheEndOfATableStaysWhereItIs) {
  const Bases declared = bases({{"word_write_base", "D0"}});
  const auto tied = [&](std::string_view message) {
    return tied_to_default(rtu_framing(), declared, {request(message)});
  };
  EXPECT_EQ(tied("01 03 00 64 00 01"), "");
  EXPECT_THAT(tied("01 03 04 00 00 01"), HasSubstr("is about the end of a table, 1024"));
  EXPECT_THAT(tied("01 10 03 FF 00 02 04 12 34 56 78"), HasSubstr("with the default word_write"));
  EXPECT_EQ(tied("01 01 03 E8 00 01"), "") << "another table";
  EXPECT_EQ(tied_to_default(rtu_framing(), default_bases(), {request("01 03 04 00 00 01")}), "");
}

}  // namespace
}  // namespace fieldproof::modbus_suite
