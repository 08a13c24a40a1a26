#include "src/p2p/partner_name.hpp"

#include <gmock/gmock.h>

namespace fieldproof::p2p {
namespace {

using ::testing::HasSubstr;

std::string refused(std::string name, char type = 'W') {
  P2pBlock block;
  block.type = type;
  block.variables.push_back({std::move(name), {}});
  const Status status = check_partner_names(block, 16);
  return status ? "" : status.error().message;
}

TEST(PartnerName, IsOfTheBlocksType) {
  EXPECT_EQ(refused("%MW100"), "");
  EXPECT_EQ(refused("%MX0010A", 'X'), "");
  EXPECT_EQ(refused("%IW0.0.0"), "");
  EXPECT_THAT(refused("%MW100", 'B'), HasSubstr("its type letter is B"));
  for (const char* name : {"%MW", "MW100", "%MZ100", "%MWG", "%MW00000000000100"})
    EXPECT_THAT(refused(name), HasSubstr("no device name")) << name;
}

TEST(UnpaddedName, DropsLeadingZeros) {
  EXPECT_EQ(unpadded_name("%MW00100"), "%MW100");
  EXPECT_EQ(unpadded_name("%MW000"), "%MW0");
  EXPECT_EQ(unpadded_name("%MW0"), "%MW0");
  EXPECT_EQ(unpadded_name("%MX0000A"), "%MXA");
  EXPECT_EQ(unpadded_name("%IW00.0.0"), "%IW00.0.0");
  EXPECT_EQ(unpadded_name("%M"), "%M");
}

}  // namespace
}  // namespace fieldproof::p2p
