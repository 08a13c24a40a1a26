#include "src/p2p/keywords.hpp"

#include <gtest/gtest.h>

namespace fieldproof {
namespace {

/// "address words" or "none"
std::string found(std::string_view keyword, std::string_view model = "xbc-h") {
  const PlcModel& plc = *find_plc_model(model);
  const auto known = find_p2p_keyword(plc, keyword);
  return known ? device_name(plc, known->address) + ' ' + std::to_string(known->words) : "none";
}

TEST(P2pKeyword, FlagsOfAppendix21) {
  EXPECT_EQ(found("_P2P1_NDR00"), "%LX5120 0");
  EXPECT_EQ(found("_P2P1_ERR01"), "%LX5181 0");
  EXPECT_EQ(found("_P2P2_STATUS00"), "%LW705 1");
  EXPECT_EQ(found("_P2P3_SVCCNT00"), "%LD449 2");
  EXPECT_EQ(found("_P2P3_ERRCNT31"), "%LD543 2");
  EXPECT_EQ(found("_P2P2_NDR00", "xec-h"), "%LX11264 0");
}

TEST(P2pKeyword, RegistersOfAppendix22) {
  EXPECT_EQ(found("_P1B00SN"), "%NW0 1");
  EXPECT_EQ(found("_P1B00RD1"), "%NW1 4");
  EXPECT_EQ(found("_P1B00RS4"), "%NW20 1");
  EXPECT_EQ(found("_P1B00WD4"), "%NW36 4");
  EXPECT_EQ(found("_P1B00WS4", "xec-h"), "%NW48 1");
  EXPECT_EQ(found("_P1B00RD2", "xec-h"), "%NW7 5");
  EXPECT_EQ(found("_P3B31WS4"), "%NW3935 1");
}

TEST(P2pKeyword, Others) {
  for (const char* keyword : {"", "_P", "_P2P", "_P2P1", "_P2P1_", "_P2P1_00", "_P2P0_NDR00", "_P2P4_NDR00", "_P2P1_NDR32", "_P2P1_NDR0", "_P2P1_NDRxx",
                              "_P1B00", "_P1B00RD5", "_P1B00RD0", "_P1B00XD1", "_P1B00RX1", "_P1B32SN", "_P1C00SN", "P1B00SN"})
    EXPECT_EQ(found(keyword), "none") << keyword;
}

}  // namespace
}  // namespace fieldproof
